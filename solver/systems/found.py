"""Solutions of a system that are accounted for, by the case that they solve."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from ..certify import KnownSolutions, UniqueSolution
from ..interval import Interval
from ..polynomial import evaluate, simplest_between
from .case import Choice, SystemCases

__all__ = ["CaseSolution", "KnownInCases", "is_same_point"]


@dataclass(frozen=True, eq=False)
class CaseSolution:
    """A solution that is proved to be alone among those of its case.

    Attributes:
        choice: the way in which each equation holds.
        solution: the solution.
    """

    choice: Choice
    solution: UniqueSolution


class KnownInCases:
    """Solutions, no two of which are the same in the same case.

    Args:
        cases: of the system.
        n: number of unknowns.
        known: solutions to begin with.
    """

    def __init__(self, cases: SystemCases, n: int, known: Iterable[CaseSolution] = ()):
        self._cases = cases
        self._all: list[CaseSolution] = []
        self._by_case: dict[bytes, KnownSolutions] = {}
        self._lower, self._upper = np.zeros((0, n)), np.zeros((0, n))
        for one in known:
            self.add(one)

    def __len__(self) -> int:
        return len(self._all)

    def __iter__(self) -> Iterator[CaseSolution]:
        return iter(self._all)

    def of(self, choice: Choice) -> KnownSolutions:
        """Those of one case."""
        key = choice.tobytes()
        if key not in self._by_case:
            self._by_case[key] = KnownSolutions(self._cases.of(choice).certifier)
        return self._by_case[key]

    def add(self, found: CaseSolution) -> None:
        """Adds a solution that its case does not have yet."""
        self.of(found.choice).add(found.solution)
        self._all.append(found)
        self._lower = np.vstack([self._lower, found.solution.region[0]])
        self._upper = np.vstack([self._upper, found.solution.region[1]])

    def first_near(self, count: int, box: Interval, choice: Choice) -> list[CaseSolution]:
        """Those of the first `count` whose regions meet a box, and whose case is still open there."""
        meets = np.all((self._lower[:count] <= box[1]) & (self._upper[:count] >= box[0]), axis=1)
        near = [self._all[i] for i in np.flatnonzero(meets)]
        return [one for one in near if _is_within(one.choice, choice)]


def _is_within(choice: Choice, other: Choice) -> bool:
    return bool(np.all((other[:, 0] <= choice[:, 0]) & (choice[:, 1] <= other[:, 1])))


def is_same_point(cases: SystemCases, one: CaseSolution, other: CaseSolution) -> bool:
    """Whether the solutions of two cases are proved to be one point: a rational one that solves both."""
    place, place_2 = one.solution.place, other.solution.place
    lower, upper = np.maximum(place[0], place_2[0]), np.minimum(place[1], place_2[1])
    if np.any(lower > upper):
        return False
    ends = zip(lower.tolist(), upper.tolist(), strict=True)
    point = [simplest_between(Fraction(low), Fraction(high)) for low, high in ends]
    for found in (one, other):
        low, high = (end.tolist() for end in found.solution.region)
        if not all(a <= x <= b for a, x, b in zip(low, point, high, strict=True)):
            return False
        if any(evaluate(equation, point) for equation in cases.of(found.choice).equations):
            return False
    return True
