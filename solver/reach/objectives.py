"""What places of contacts cost: the friction that they need, or minus the load that they carry."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple, Protocol

import numpy as np

from ...arrays import Array
from ..statics import LoadProblem, StaticsProblem, carried_load, most_against, needed_friction

__all__ = ["Cuts", "Measured", "MinusCarried", "NeededFriction", "Objective"]


class Cuts(NamedTuple):
    """What is known of a cost about a place: the largest of some smooth ones, to first order.

    Attributes:
        values: (m,) of each of them there.
        changes: (m, d) to each of d places near by.
    """

    values: Array
    changes: Array


class Measured(Protocol):
    """A place whose cost is known.

    Attributes:
        cost: infinite where it is of no use.
    """

    @property
    def cost(self) -> float:
        """The cost."""

    def cuts(self, moved: Sequence[Array]) -> Cuts:
        """The cost about the place, by what becomes of it where its maps are `moved` a little."""


class Objective(Protocol):
    """What is made small, of the maps (n, 8, 6) of contacts' points, see `power`."""

    def __call__(self, maps: Array, *, below: float = np.inf) -> Measured:
        """The place, with its cost; one that is no less than `below` may be any that is no less."""


@dataclass(frozen=True, eq=False)
class _Friction:
    """How much friction points need beyond some; how that changes is known by differences."""

    objective: "NeededFriction"
    cost: float

    def cuts(self, moved: Sequence[Array]) -> Cuts:
        changes = [self.objective(maps).cost - self.cost for maps in moved]
        return Cuts(np.array([self.cost]), np.array([changes]))


@dataclass(frozen=True, eq=False)
class NeededFriction:
    """The friction that points need, beyond some."""

    problem: StaticsProblem
    beyond: float = 0.0

    def __call__(self, maps: Array, *, below: float = np.inf) -> _Friction:
        """The friction there."""
        del below  # it is found at once
        needed = float(needed_friction(maps, self.problem.arms, self.problem.reaches))
        return _Friction(self, needed - self.beyond)


@dataclass(frozen=True, eq=False)
class _Carried:
    """Minus the load that is carried: a maximum over twists, with a cut for each (k, 6) that tells."""

    problem: LoadProblem
    maps: Array
    cost: float
    twists: Array

    def cuts(self, moved: Sequence[Array]) -> Cuts:
        places = (self.maps, *moved)
        costs = np.array([[self._against(place, twist) for place in places] for twist in self.twists])
        return Cuts(costs[:, 0], costs[:, 1:] - costs[:, :1])

    def _against(self, maps: Array, twist: Array) -> float:
        problem = self.problem
        return -most_against(maps, problem.arms, problem.friction, problem.forces_N, twist) / problem.weight_N


@dataclass(frozen=True, eq=False)
class MinusCarried:
    """Minus the multiple of the load that points carry; of those that carry nothing, what friction they lack.

    So a place without any balance has a slope, too, which leads to where some load is carried.
    """

    problem: LoadProblem

    def __call__(self, maps: Array, *, below: float = np.inf) -> Measured:
        """The cost there."""
        problem = self.problem
        beyond = problem.weight_N * max(0.0, -below)
        found = carried_load(maps, problem.arms, problem.friction, problem.forces_N, beyond=beyond)
        if 0.0 < found.most <= beyond:  # some direction shows as much
            return _Carried(problem, maps, -found.most / problem.weight_N, found.twists)
        if found.least <= 0.0:
            lacking = NeededFriction(problem, problem.friction)(maps)
            return replace(lacking, cost=max(0.0, lacking.cost))
        return _Carried(problem, maps, -found.least / problem.weight_N, found.twists)
