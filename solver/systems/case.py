"""A system in which some equations hold in a chosen way, and the tests of it."""

from collections import OrderedDict
from collections.abc import Sequence

import numpy as np

from ...base.numeric.arrays import Indices
from ..certify import Certifier, ClosedBox, Ends, enclosure
from ..interval import Interval
from ..polynomial import ExactPolynomial
from .parts import Parts

__all__ = ["Choice", "SystemCase", "SystemCases", "halved", "is_chosen"]

# Cases whose tables are kept; most searches have one.
_MOST_KEPT = 256

Choice = Indices
"""(m, 2): of the ways for each equation to hold, the first that is left, and the one behind the last."""


def is_chosen(choice: Choice) -> bool:
    """Whether every equation is left with one way to hold."""
    return bool(np.all(choice[:, 1] - choice[:, 0] == 1))


def halved(choice: Choice) -> tuple[Choice, Choice]:
    """Two choices that share the ways of the equation which has the most left."""
    k = int(np.argmax(choice[:, 1] - choice[:, 0]))
    first, second = choice.copy(), choice.copy()
    first[k, 1] = second[k, 0] = (choice[k, 0] + choice[k, 1] + 1) // 2
    return first, second


class SystemCase:
    """The equations that are left with one way to hold.

    Attributes:
        equations: those ways.
        certifier: of them.
        asked: the box that solutions are asked for in.
        box: part of it that has all solutions of this case.
        is_root: whether the box holds one number, the root of the only equation in the only unknown.
        is_refuted: whether an equation is left without a way to hold.
    """

    def __init__(self, parts: Sequence[Parts], ends: Ends, choice: Choice):
        chosen = [ways[a] for ways, (a, b) in zip(parts, choice, strict=True) if b - a == 1]
        self.equations: tuple[ExactPolynomial, ...] = tuple(part.polynomial for part in chosen)
        self.certifier = Certifier(self.equations, len(ends))
        self.asked = ClosedBox(self.equations, ends)
        self.box = _hull_of_roots(parts, ends, choice)
        self.is_root = len(ends) == len(parts) == 1 and len(chosen) == 1
        self.is_refuted = bool(np.any(choice[:, 0] >= choice[:, 1]) or np.any(self.box[0] > self.box[1]))


def _hull_of_roots(parts: Sequence[Parts], ends: Ends, choice: Choice) -> Interval:
    """What is left of the box where some of the equations that are left hold at roots of one unknown."""
    left = list(ends)
    for ways, (a, b) in zip(parts, choice, strict=True):
        roots = [part.root for part in ways[a:b] if part.root is not None]
        unknowns = {part.unknown for part in ways[a:b]}
        k = next(iter(unknowns), None)
        if len(unknowns) == 1 and k is not None:
            low, high = min(root[0] for root in roots), max(root[1] for root in roots)
            left[k] = max(left[k][0], low), min(left[k][1], high)
    lower, upper = enclosure(left)
    empty = [k for k, (low, high) in enumerate(left) if low > high]
    lower[empty], upper[empty] = 1.0, -1.0
    return lower, upper


class SystemCases:
    """The cases of a system, each made when it is first asked for.

    Args:
        parts: the ways for each equation to hold.
        ends: of the box, for each unknown.
    """

    def __init__(self, parts: Sequence[Parts], ends: Ends):
        self._parts, self._ends = parts, ends
        self._kept: OrderedDict[bytes, SystemCase] = OrderedDict()

    def of(self, choice: Choice) -> SystemCase:
        """The case in which the equations hold in one of the ways that are left."""
        key = choice.tobytes()
        case = self._kept.pop(key, None) or SystemCase(self._parts, self._ends, choice)
        self._kept[key] = case
        if len(self._kept) > _MOST_KEPT:
            self._kept.popitem(last=False)
        return case

    @property
    def every_way(self) -> Choice:
        """The choice that leaves everything open."""
        return np.array([(0, len(ways)) for ways in self._parts], dtype=np.int64).reshape(-1, 2)
