"""How long this process has compiled inner loops, which only the first use after an installation does."""

import time
from collections.abc import Callable

__all__ = ["clock", "compile_s", "when_compiling"]


class CompileClock:
    """Time from outermost begins to their ends; numba lets one thread compile at a time."""

    def __init__(self) -> None:
        self.total_s = 0.0
        self.announce: Callable[[], object] | None = None
        self._depth = 0
        self._started = 0.0

    def begin(self) -> None:
        """Something begins to be compiled, perhaps as a part of something else."""
        self._depth += 1
        if self._depth == 1:
            self._started = time.perf_counter()
            announce, self.announce = self.announce, None
            if announce is not None:
                announce()

    def end(self) -> None:
        """What has begun last is done."""
        self._depth -= 1
        if self._depth == 0:
            self.total_s += time.perf_counter() - self._started


clock = CompileClock()
"""That of this process."""


def compile_s() -> float:
    """Time that this process has spent on compiling, in s; what was kept by earlier ones takes none."""
    return clock.total_s


def when_compiling(announce: Callable[[], object] | None) -> None:
    """Has `announce` called once, when something is compiled that was not kept; None for nothing."""
    clock.announce = announce
