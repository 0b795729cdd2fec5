"""What a worker of a cluster does with a job: hands it to a process of its own, and the answer back.

So a job that hangs or crashes costs a process and never the cluster's worker, and a worker with several
threads has a process for each of them. Processes stay for the next job of the same setup.
"""

import threading

from .. import __version__
from .messages import Codec, ProcessLost
from .pool import MOST_LOSSES
from .remote import RemoteWorker

__all__ = ["do_job", "installed_version"]

_idle: list[tuple[bytes, RemoteWorker[object, object]]] = []
_guard = threading.Lock()


def installed_version() -> str:
    """The version that the cluster's worker has."""
    return __version__


def do_job(setup: bytes, message: bytes, limit_s: float | None) -> bytes:
    """Does a job in a process.

    Args:
        setup: pickled; what the process makes its worker from.
        message: the job, encoded.
        limit_s: how long it may take.

    Returns:
        The process's answer, encoded.

    Raises:
        ProcessLost: every process that began it died.
        TimeOver: it took too long.
        WorkFailed: no worker could be made from the setup.
    """
    worker = _taken(setup)
    try:
        for _ in range(MOST_LOSSES):
            try:
                return worker.exchange(message, limit_s)
            except ProcessLost:
                continue
        raise ProcessLost
    finally:
        with _guard:
            _idle.append((setup, worker))


def _taken(setup: bytes) -> RemoteWorker[object, object]:
    """A worker of this setup; those of others, whose work is over, are ended."""
    with _guard:
        same = [worker for known, worker in _idle if known == setup]
        others = [worker for known, worker in _idle if known != setup]
        _idle[:] = [(setup, worker) for worker in same[1:]]
    for worker in others:
        worker.close()
    return same[0] if same else RemoteWorker(Codec(()), setup)
