"""The clock that budgets are held against."""

import time

from .compile_clock import compile_s

__all__ = ["WorkClock"]


class WorkClock:
    """Counts the time since it was made, without what this process has spent on compiling its inner loops.

    That happens once after an installation, takes a minute, and is no part of the work that a budget is for.
    """

    def __init__(self) -> None:
        self._started, self._compiled_before = time.perf_counter(), compile_s()

    @property
    def seconds(self) -> float:
        """The time, in s."""
        return time.perf_counter() - self._started - (compile_s() - self._compiled_before)
