"""A worker process: `python -m holdfast.solver.worker_process` works on the slices that it is sent."""

import os
import pickle
import sys
from typing import IO, Any

from .contract import SearchSetup
from .messages import WorkerLost, decode, encode, receive, send

__all__ = ["main"]


def main() -> None:
    """Serves slices from standard input until it is closed."""
    stdin, stdout = _streams()
    try:
        setup: SearchSetup[Any, Any] = pickle.loads(receive(stdin))  # noqa: S301 - from the process that started this one
        worker = setup.new_worker()
        send(stdout, b"ready")
        while True:
            try:
                message = worker.work(decode(receive(stdin), setup.task))
                answer = encode(message)
            except WorkerLost:
                raise
            except Exception as error:  # noqa: BLE001 - raised again where the search runs
                answer = encode(error)
            send(stdout, answer)
    except WorkerLost:
        return  # the search is over, or was killed


def _streams() -> tuple[IO[bytes], IO[bytes]]:
    """The two pipes, moved away from where a library might print."""
    stdin, stdout = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.close(nothing)
    os.dup2(2, 1)
    sys.stdout = sys.stderr
    return stdin, stdout


if __name__ == "__main__":
    main()
