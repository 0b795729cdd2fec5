"""Points of regions that carry much: local search, from many starts.

A step takes the four corners of a small rectangle about each contact's point, and asks which mixture of
corners carries most in all directions at once. Its dual are twists, so it is the same descent that bounds
boxes, and the step is a subgradient method that knows several of the worst directions.
"""

from dataclasses import dataclass

import numpy as np

from ....arrays import Array
from ....geometry import even_directions
from ..climb import Climber
from ..points import RegionPoints
from .point import carried_load
from .problem import LoadProblem
from .twists import descend, load_rows

__all__ = ["CarryingPoint", "LoadClimber"]

# Half widths of the rectangles in parameters, at first and at last, and how they shrink and grow.
_FIRST, _LAST, _SHRINK, _GROW = 0.25, 1e-4, 0.35, 1.6
_MOST_STEPS, _MOST_TWISTS = 60, 5
# A step helps where it gains so much.
_GAIN = 1e-5
# Estimates that are so near to what is certain need no more twists; and how often such are asked for.
_NEAR, _MOST_ROUNDS = 1e-3, 5


@dataclass(frozen=True, eq=False)
class CarryingPoint:
    """Points of all regions at which contacts carry the load.

    Attributes:
        root: which choice of charts, by number.
        params: (2 n,) parameters u, v of each contact in its chart.
        multiple: of the load that they carry whichever way it acts.
    """

    root: int
    params: Array
    multiple: float


class LoadClimber(RegionPoints):
    """Local search over the points of one problem."""

    problem: LoadProblem

    def __init__(self, problem: LoadProblem):
        super().__init__(problem)
        self._shares = problem.forces_N / problem.weight_N
        self._by_friction = Climber(problem)

    def least_twist(
        self, root: int, params: Array, twists: tuple[Array, ...] = (), enough: float = 0.0
    ) -> tuple[float, Array]:
        """About what is carried at points, and a twist (6,) that shows it; no less than is carried.

        Args:
            root: which choice of charts.
            params: (2 n,)
            twists: to begin with, beside some in all directions.
            enough: where so little or less is carried it may be any number down to that.
        """
        rows, n = self._rows(root, [params]), self.problem.n_contacts
        least, best = np.inf, np.zeros(6)
        for start in (*twists, *(np.append(d, np.zeros(3)) for d in even_directions(0))):
            value, found, _ = descend(rows, np.arange(n), n, start[None], enough, 0)
            if value < least:
                least, best = value, found[0]
            if least <= enough:
                break
        return least, best

    def carried(self, root: int, params: Array) -> tuple[float, float, Array]:
        """What points carry for certain, and at most, in multiples of the load; a twist that shows it."""
        problem = self.problem
        found = carried_load(self.maps(root, params), problem.arms, problem.friction, problem.forces_N)
        return found.least / problem.weight_N, found.most / problem.weight_N, found.twist

    def start(self, rng: np.random.Generator, samples: int) -> tuple[int, Array]:
        """That of so many random points that carries most; if none does, one that needs little friction."""
        best, most = self.random(rng), 0.0
        for _ in range(samples):
            point = self.random(rng)
            value, _ = self.least_twist(*point, enough=most)
            if value > most:
                best, most = point, value
        if most > 0.0:
            return best
        balanced = self._by_friction.climb_from_the_best(rng, samples)
        return balanced.root, balanced.params

    def climb(self, root: int, params: Array) -> CarryingPoint:
        """From points to such that carry more, as far as local search goes; what they carry for certain."""
        best, twists = CarryingPoint(root, params, -1.0), []  # type: tuple[CarryingPoint, list[Array]]
        for _ in range(_MOST_ROUNDS):
            params, estimate = self._climb(root, params, twists)
            certain, most, twist = self.carried(root, params)
            if certain > best.multiple:
                best = CarryingPoint(root, params, certain)
            if estimate <= most * (1.0 + _NEAR):
                break
            twists.append(twist)
        return best

    def _climb(self, root: int, params: Array, known: list[Array]) -> tuple[Array, float]:
        value, twist = self.least_twist(root, params, tuple(known))
        twists, reach = [*known, twist], _FIRST
        for _ in range(_MOST_STEPS):
            if value <= 0.0 or reach < _LAST:
                break
            trial, twists = self._step(root, params, twists, reach)
            after, twist = self.least_twist(root, trial, (*known, *twists), enough=0.0)
            twists = [*twists, twist]
            if after > value * (1.0 + _GAIN):
                params, value, reach = trial, after, min(0.5, _GROW * reach)
            else:
                reach *= _SHRINK
        return params, value

    def _step(self, root: int, params: Array, twists: list[Array], reach: float) -> tuple[Array, list[Array]]:
        """Where the best mixture of corners lies (2 n,), and the twists that it is the best against."""
        n = self.problem.n_contacts
        low, high = np.clip(params - reach, 0.0, 1.0), np.clip(params + reach, 0.0, 1.0)
        corners = [
            np.where(np.tile(side, n), high, low)
            for side in ((False, False), (False, True), (True, False), (True, True))
        ]
        rows = self._rows(root, corners)
        start = np.array(twists[-_MOST_TWISTS:])
        start = start / np.maximum(np.linalg.norm(start[:, :3], axis=1), 1e-12)[:, None]
        _, found, weights = descend(rows, np.repeat(np.arange(n), 4), n, np.ascontiguousarray(start), 0.0, 0)
        mixed = weights.reshape(n, 4)
        places = np.array(corners).reshape(4, n, 2)
        trial = np.einsum("ik,kic->ic", mixed, places) / np.maximum(mixed.sum(axis=1), 1e-12)[:, None]
        sizes = np.linalg.norm(found[:, :3], axis=1)
        kept = [y for y, size in zip(found, sizes, strict=True) if size > 1e-3 * sizes.max()]
        return np.clip(trial.ravel(), 0.0, 1.0), kept[: _MOST_TWISTS - 1]

    def _rows(self, root: int, places: list[Array]) -> Array:
        """Rows (n m, 5, 6) for `measure` of m places of each contact, contact by contact."""
        problem, n, m = self.problem, self.problem.n_contacts, len(places)
        maps = np.array([self.maps(root, params) for params in places]).swapaxes(0, 1).reshape(n * m, 8, 6)
        normals = maps[:, 0, :3]
        return load_rows(
            maps, normals, self._shares, problem.arms, np.repeat(np.arange(n), m), problem.friction
        )
