"""Solutions of a system that are accounted for, and whether another one is one of them."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from ..interval import Interval, hull, is_within
from .interval_newton import Certifier

__all__ = ["KnownSolutions", "UniqueSolution"]


@dataclass(frozen=True, eq=False)
class UniqueSolution:
    """A solution that is proved to be alone.

    Attributes:
        region: it is the only one in here.
        place: it lies in here.
        inside: whether it lies in the box that was asked for; None where that can't be told.
    """

    region: Interval
    place: Interval
    inside: bool | None


class KnownSolutions:
    """Solutions, no two of which are the same.

    Args:
        certifier: of the system.
        known: solutions to begin with.
    """

    def __init__(self, certifier: Certifier, known: Iterable[UniqueSolution] = ()):
        self._certifier = certifier
        self._known: list[UniqueSolution] = []
        self._lower, self._upper = np.zeros((0, certifier.n)), np.zeros((0, certifier.n))  # of all regions
        for solution in known:
            self.add(solution)

    def __len__(self) -> int:
        return len(self._known)

    def __iter__(self) -> Iterator[UniqueSolution]:
        return iter(self._known)

    def add(self, solution: UniqueSolution) -> None:
        """Adds a solution that `holds` says is none of these."""
        self._known.append(solution)
        self._lower = np.vstack([self._lower, solution.region[0]])
        self._upper = np.vstack([self._upper, solution.region[1]])

    def solves(self, box: Interval) -> bool:
        """Whether a box lies in a region, so that all is known about it."""
        return bool(np.any(np.all((box[0] >= self._lower) & (box[1] <= self._upper), axis=1)))

    def first_near(self, count: int, box: Interval) -> list[UniqueSolution]:
        """Those of the first `count` solutions whose regions meet a box."""
        meets = np.all((self._lower[:count] <= box[1]) & (self._upper[:count] >= box[0]), axis=1)
        return [self._known[i] for i in np.flatnonzero(meets)]

    def holds(self, place: Interval, region: Interval) -> bool | None:
        """Whether the only solution of `region`, at `place`, is one of these; None if it can't be told."""
        for known in self._known:
            if is_within(place, known.region) or is_within(known.place, region):
                return True
            if np.any(place[1] < known.place[0]) or np.any(place[0] > known.place[1]):
                continue
            both = hull(place, known.place)
            if self._certifier.test(0.5 * (both[0] + both[1]), both)[0]:
                return True
            return None
        return False
