"""What every search reports: where it stands, how it ended."""

from dataclasses import dataclass
from enum import Enum

from ...base.text.plain_text import counted

__all__ = ["Progress", "SearchResult", "Verdict"]


class Verdict(Enum):
    """What a search has shown.

    SOLVED: solutions were found, perhaps not all. COMPLETE: all solutions were found. INFEASIBLE: it is
    proved that there is none. UNDECIDED: nothing of these.
    """

    SOLVED = "solved"
    COMPLETE = "complete"
    INFEASIBLE = "infeasible"
    UNDECIDED = "undecided"


@dataclass(frozen=True, kw_only=True)
class Progress:
    """Where a search stands.

    Attributes:
        boxes: boxes processed.
        open: boxes still to be processed.
        found: solutions, or boxes of a cover, so far.
        undecided: boxes that may hold further solutions, but are too small to be split.
        depth: splits above the deepest box.
        decided: share of the initial box that is decided, by number of splits.
        seconds: time since the start, that of earlier runs of a resumed search included.
    """

    boxes: int
    open: int
    found: int
    undecided: int
    depth: int
    decided: float
    seconds: float

    def __str__(self) -> str:
        return (
            f"{self.found} found, {counted(self.boxes, 'box', 'boxes')} done, {self.open} open, "
            f"{self.decided:.1%} decided, {self.seconds:.1f} s"
        )


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class SearchResult:
    """How a search ended.

    Attributes:
        verdict: what was shown.
        progress: where the search stood at the end.
        sigma: width below which a box was not split.
        abandoned: those of the undecided boxes that were given up because every process that worked on them
            died.
    """

    verdict: Verdict
    progress: Progress
    sigma: float
    abandoned: int = 0

    @property
    def boxes(self) -> int:
        """Boxes processed."""
        return self.progress.boxes

    @property
    def open(self) -> int:
        """Boxes that were still to be processed where the search stopped early."""
        return self.progress.open

    @property
    def undecided(self) -> int:
        """Boxes that may hold further solutions, but were too small to be split."""
        return self.progress.undecided

    @property
    def decided(self) -> float:
        """Share of the initial box that is decided, by number of splits."""
        return self.progress.decided

    @property
    def seconds(self) -> float:
        """Time taken."""
        return self.progress.seconds

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self}>"

    def summary(self, found: str) -> str:
        """The result in a line; `found` tells what was found."""
        parts = [found, counted(self.boxes, "box", "boxes")]
        if self.verdict is Verdict.UNDECIDED:
            parts += [f"{self.undecided} undecided", f"{self.open} open"]
        return f"{self.verdict.value}: {', '.join(parts)}, {self.seconds:.1f} s"
