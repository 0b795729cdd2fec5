"""How often a record is written that grows with what is in it."""

import time
from dataclasses import dataclass

__all__ = ["Pace"]

# Share of the time that writing may take: with every grasp, a run of thousands would do little else.
_SHARE = 0.05


@dataclass
class Pace:
    """Tells when the next writing is due.

    Attributes:
        ended_s: when the last one ended, by the clock that never goes back; None before the first.
        took_s: how long it took.
    """

    ended_s: float | None = None
    took_s: float = 0.0

    @property
    def is_due(self) -> bool:
        """Whether so much time has gone by that another writing takes no more than its share."""
        if self.ended_s is None:
            return True
        return self.took_s <= _SHARE * (time.monotonic() - self.ended_s)

    def note(self, started_s: float) -> None:
        """Remembers a writing that began then and has just ended."""
        self.ended_s = time.monotonic()
        self.took_s = self.ended_s - started_s
