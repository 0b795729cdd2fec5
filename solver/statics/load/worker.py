"""What a tree for the load does with a box: what contacts at its points carry at most."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ....base.numeric.arrays import Array
from ....geometry import even_directions
from ..separation import separate
from ..worker import TWIST_SIZE, Maps, StaticsBox, StaticsSetup, StaticsWorker
from .bound import load_bound
from .climb import CarryingPoint, LoadClimber
from .problem import LoadProblem
from .twists import descend, load_rows

__all__ = ["LoadSetup", "LoadWorker"]

# Directions that normals are measured along are logged in whole numbers, the largest of them this.
_ALONG_SIZE = 2.0**10
# Descents from other directions than that of the box around, for each box.
_OTHERS = 2
# What a split gains in either half counts from this share of the bound on: often it takes several splits, of
# different sides, before any of them gains something.
_LEAST_GAIN = 2e-3
# Number of the first smoothing of descents in halves, which begin where that of the whole has ended.
_FINER = 1
# The same for a contact that has no part in what separates.
_IDLE_WEIGHT = 0.1


@dataclass(frozen=True, eq=False, kw_only=True)
class LoadSetup(StaticsSetup[CarryingPoint]):
    """A tree that bounds the load.

    Attributes:
        problem: with forces and weight.
        limit: boxes that carry no larger multiple are done with.
        known: a multiple that some points are known to carry.
    """

    problem: LoadProblem
    known: float

    @property
    def fingerprint(self) -> list[Any]:
        """Form and order."""
        return [self.problem.form, self.order.value]

    @property
    def point_kind(self) -> type[CarryingPoint]:
        """Points that carry."""
        return CarryingPoint

    @property
    def unknown(self) -> float:
        """Any load."""
        return np.inf

    def worker(self) -> "LoadWorker":
        """A worker."""
        return LoadWorker(self)

    def urgency(self, bound: float) -> float:
        """Boxes that may carry most come first."""
        return -bound

    def shown(self, bounds: Sequence[float]) -> float:
        """The multiple that no points exceed."""
        return float(max([self.limit, *bounds]))

    def badness(self, point: CarryingPoint) -> float:
        """The less it carries the worse."""
        return -point.multiple


class LoadWorker(StaticsWorker[CarryingPoint]):
    """Bounds or splits boxes for the load."""

    def __init__(self, setup: LoadSetup):
        self._asked, self._climber = setup, LoadClimber(setup.problem)
        super().__init__(setup, self._climber)

    def refute(self, box: StaticsBox, maps: Maps) -> tuple[StaticsBox, bool, Array]:
        """Lowers the bound to the limit, or as far as a twist does."""
        limit, counts = self._asked.limit, self._extents(box)
        along = self._along(maps)
        if along is None:
            return box, False, counts
        if box.twist is not None:
            box = self._with(box, maps, along, box.twist)
        if box.bound <= limit:
            return box, True, counts
        if limit <= 0.0:
            twist, weights = self._separating(maps)
            counts = counts * weights
        else:
            twist = self._found(box, maps, self._rows(maps, along))
        box = self._with(box, maps, along, twist)
        if 0.0 < limit < box.bound < np.inf:
            counts = self._gains(box)
        return box, box.bound <= limit, counts

    def points_within(self, box: StaticsBox) -> list[CarryingPoint]:
        """The middle of the box, where it carries more than is known: from there local search goes on."""
        middle, known = 0.5 * (box.lower + box.upper), self._asked.known
        start = () if box.twist is None else (box.twist / np.linalg.norm(box.twist[:3]),)
        about, _ = self._climber.least_twist(box.root, middle, start, enough=known)
        if about <= known:
            return []
        _, point = self._climber.climb(box.root, middle, known)
        return [] if point is None else [point]

    def _found(self, box: StaticsBox, maps: Maps, rows: Array) -> Array:
        """A twist (6,) against which contacts carry little in the box."""
        directions = even_directions(0)
        starts = [np.append(d, np.zeros(3)) for d in directions]
        if box.twist is not None:
            others = [starts[(5 * len(box.path) + 7 * k) % len(starts)] for k in range(_OTHERS)]
            starts = [box.twist / np.linalg.norm(box.twist[:3]), *others]
        least, best = np.inf, starts[0]
        n = self._asked.problem.n_contacts
        for start in starts:
            value, found, _ = descend(rows, maps.owner, n, start[None], self._asked.limit, 0)
            if value < least:
                least, best = value, found[0]
            if least <= self._asked.limit:
                break
        return best

    def _separating(self, maps: Maps) -> tuple[Array, Array]:
        """A twist (6,) that no force can stand against, if any, and how much each side (2 n,) counts."""
        problem, n = self._asked.problem, self._asked.problem.n_contacts
        none = np.zeros(len(maps.owner))
        _, twist, wrenches = separate(
            maps.middle, problem.arms[maps.owner], none, maps.owner, problem.friction, n
        )
        weights = np.linalg.norm(wrenches[:, :3], axis=1)
        return np.asarray(twist), np.repeat(weights / max(weights.max(), 1e-12) + _IDLE_WEIGHT, 2)

    def _with(self, box: StaticsBox, maps: Maps, along: Array, twist: Array) -> StaticsBox:
        """The box with the bound by a twist, if it is lower."""
        problem = self._asked.problem
        whole = np.rint(twist / np.abs(twist).max() * TWIST_SIZE)
        bound_N = load_bound(
            maps.low, maps.high, maps.owner, problem.arms, problem.friction, problem.forces_N, along, whole
        )
        # The weight is a product that was rounded, and so is the quotient.
        bound = bound_N / problem.weight_N * (1.0 + 1e-15)
        if bound >= box.bound:
            return box
        return replace(box, bound=bound, twist=whole, along=along)

    def _along(self, maps: Maps) -> Array | None:
        """Whole numbers (n, 3) about along the normals of each contact; None where these differ too much."""
        n = self._asked.problem.n_contacts
        normals = maps.middle[:, 0, :3]
        units = normals / np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
        sums = np.array([units[maps.owner == i].sum(axis=0) for i in range(n)])
        whole = np.rint(sums / np.maximum(np.abs(sums).max(axis=1), 1e-300)[:, None] * _ALONG_SIZE)
        sizes = (normals * whole[maps.owner]).sum(axis=1)
        return whole if (sizes > 0.0).all() else None

    def _rows(self, maps: Maps, along: Array) -> Array:
        problem = self._asked.problem
        units = along / np.linalg.norm(along, axis=1)[:, None]
        shares = problem.forces_N / problem.weight_N
        return load_rows(maps.middle, units[maps.owner], shares, problem.arms, maps.owner, problem.friction)

    def _gains(self, box: StaticsBox) -> Array:
        """How much a split of each side (2 n,) lowers the bounds of both halves, and the wider the more.

        What is lost in a box is that forces may act at several places of a region at once, and of which side
        that is can't be seen from how powers differ: where they rise all along it, nothing is lost.
        """
        wide = box.upper - box.lower
        return np.array([size * self._gain(box, k) for k, size in enumerate(wide.tolist())])

    def _gain(self, box: StaticsBox, side: int) -> float:
        """The product of what both halves gain on the box, down to the limit."""
        product, middle = 1.0, 0.5 * (box.lower[side] + box.upper[side])
        for ends in (box.lower, box.upper):
            half = replace(box, lower=box.lower.copy(), upper=box.upper.copy())
            (half.upper if ends is box.lower else half.lower)[side] = middle
            gain = box.bound - max(self._asked.limit, self._about(half))
            product *= max(0.0, gain) + _LEAST_GAIN * box.bound
        return product

    def _about(self, box: StaticsBox) -> float:
        """The bound of a part of a box by the twist that is found from that of the whole; not proved."""
        maps = self._maps(box)
        along = self._along(maps)
        if along is None or box.twist is None:
            return box.bound
        start, n = box.twist / np.linalg.norm(box.twist[:3]), self._asked.problem.n_contacts
        about, _, _ = descend(self._rows(maps, along), maps.owner, n, start[None], self._asked.limit, _FINER)
        return float(about)
