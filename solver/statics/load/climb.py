"""Points of regions that carry much: local search, from many starts.

A step takes the four corners of a small rectangle about each contact's point, and asks which mixture of
corners carries most in all directions at once. Its dual are twists, so it is the same descent that bounds
boxes, and the step is a subgradient method that knows several of the worst directions.
"""

from dataclasses import dataclass

import numpy as np

from ....base.machine.cancellation import give_up_if_asked
from ....base.numeric.arrays import Array
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

    def carried(
        self, root: int, params: Array, *, beyond: float = 0.0, twist: Array | None = None
    ) -> tuple[float, float, Array]:
        """What points carry for certain, and at most, in multiples of the load; a twist that shows it.

        Args:
            root: which choice of charts.
            params: (2 n,)
            beyond: where no more than this multiple is carried, both are found only as far as that shows.
            twist: one against which little is carried, if any is known.
        """
        problem, weight = self.problem, self.problem.weight_N
        found = carried_load(
            self.maps(root, params),
            problem.arms,
            problem.friction,
            problem.forces_N,
            beyond=beyond * weight,
            first=None if twist is None else -twist[:3] / max(float(np.linalg.norm(twist[:3])), 1e-300),
        )
        return found.least / weight, found.most / weight, found.twist

    def start(self, rng: np.random.Generator, samples: int) -> tuple[int, Array]:
        """That of so many random points that carries most; if none does, one that needs little friction."""
        best, most = self.random(rng), 0.0
        for _ in range(samples):
            give_up_if_asked()
            point = self.random(rng)
            value, _ = self.least_twist(*point, enough=most)
            if value > most:
                best, most = point, value
        if most > 0.0:
            return best
        balanced = self._by_friction.climb_from_the_best(rng, samples)
        return balanced.root, balanced.params

    def climb(self, root: int, params: Array, beyond: float = 0.0) -> tuple[float, CarryingPoint | None]:
        """From points to such that carry more, as far as local search goes.

        Args:
            root: which choice of charts.
            params: (2 n,)
            beyond: a multiple; points that carry no more are of no use.

        Returns:
            About what is carried there, or more; and the points, where they carry more than `beyond`.
        """
        best: CarryingPoint | None = None
        twists: list[Array] = []
        estimate = 0.0
        for _ in range(_MOST_ROUNDS):
            params, estimate, twist = self._climb(root, params, twists)
            if estimate <= beyond:
                break
            certain, most, twist = self.carried(root, params, beyond=beyond, twist=twist)
            if certain > beyond:
                best, beyond = CarryingPoint(root, params, certain), certain
            if estimate <= most * (1.0 + _NEAR):
                break
            estimate = most
            twists.append(twist)
        return estimate, best

    def _climb(self, root: int, params: Array, known: list[Array]) -> tuple[Array, float, Array]:
        value, twist = self.least_twist(root, params, tuple(known))
        twists, reach, least = [*known, twist], _FIRST, twist
        for _ in range(_MOST_STEPS):
            give_up_if_asked()
            if value <= 0.0 or reach < _LAST:
                break
            trial, twists = self._step(root, params, twists, reach)
            after, twist = self.least_twist(root, trial, (*known, *twists), enough=value)
            twists = [*twists, twist]
            if after > value * (1.0 + _GAIN):
                params, value, least, reach = trial, after, twist, min(0.5, _GROW * reach)
            else:
                reach *= _SHRINK
        return params, value, least

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
