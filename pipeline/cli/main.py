"""What `holdfast` and `python -m holdfast` start; signals are answered from here on."""

import atexit
import gc
import os
from collections.abc import Sequence

from .interrupt import INTERRUPTED, answered_by, leave

__all__ = ["main"]

# Matrices here are small, and the cores are the workers': threads of linear algebra would only wait for each
# other, in all processes alike. It counts before numpy is imported.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


def main(argv: Sequence[str] | None = None) -> int:
    """Runs a command and returns its exit code.

    Args:
        argv: the words after `holdfast`; None takes those of this process.
    """
    if argv is None:
        # The process ends with the command: what is in memory need not be searched for garbage first.
        atexit.register(gc.freeze)
    # Libraries swallow a KeyboardInterrupt that reaches them while they are being imported.
    with answered_by(lambda number, frame: leave(INTERRUPTED)):
        from .command_line import run_command

        return run_command(argv)
