"""A worker process: `python -m holdfast.workers.process` does the jobs that it is sent.

It ends with the process that started it, however that ends, and whatever it is at: the pipe between them is
closed then, and a thread notices.
"""

import gc
import os
import pickle
import queue
import sys
import threading
import traceback
from typing import IO, Any

from .contract import WorkerSetup
from .messages import Codec, ProcessLost, receive, send

__all__ = ["main"]

# Things made between searches for garbage. Jobs leave next to none that only a search would find; with the
# usual 700 these would take 2 % of their time.
_ALLOCATIONS = 20_000


def main(setup: WorkerSetup[Any, Any] | None = None) -> None:
    """Does jobs from standard input until it is closed.

    Args:
        setup: what the worker is made from; None for that in the first message, which is the same.
    """
    gc.set_threshold(_ALLOCATIONS)
    stdin, stdout = _streams()
    messages: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    threading.Thread(target=_listen, args=(stdin, messages), daemon=True).start()
    try:
        _serve(messages, stdout, setup)
    except ProcessLost:
        return  # the pool is closed, or its process was killed


def _listen(stdin: IO[bytes], messages: "queue.SimpleQueue[bytes]") -> None:
    """Hands messages on until there can be no more; then nobody wants what this process is doing."""
    try:
        while True:
            messages.put(receive(stdin))
    except ProcessLost:
        os._exit(0)


def _serve(
    messages: "queue.SimpleQueue[bytes]", stdout: IO[bytes], known: WorkerSetup[Any, Any] | None
) -> None:
    codec = Codec(())
    try:
        first = messages.get()
        setup: WorkerSetup[Any, Any] = known or pickle.loads(first)  # noqa: S301 - from the process that started this one
        codec = Codec(setup.shared)
        worker = setup.new_worker()
    except Exception as error:  # noqa: BLE001 - raised again where the pool is
        send(stdout, _failure(codec, error))
        return
    send(stdout, codec.encode((True, None)))
    while True:
        message = messages.get()
        try:
            answer = codec.encode((True, worker.work(codec.decode(message))))
        except Exception as error:  # noqa: BLE001 - raised again where the pool is
            answer = _failure(codec, error)
        send(stdout, answer)


def _failure(codec: Codec, error: Exception) -> bytes:
    """The error as a message, with where it was raised as a note; in words if it can't be sent itself."""
    error.add_note("in a worker process:\n" + "".join(traceback.format_tb(error.__traceback__)).rstrip())
    try:
        answer = codec.encode((False, error))
        codec.decode(answer)
    except Exception:  # noqa: BLE001 - an exception's way of being pickled may fail in any way
        answer = codec.encode((False, RuntimeError(f"{type(error).__name__}: {error}")))
    return answer


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
