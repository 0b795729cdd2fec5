"""What places of contacts cost: the friction that they need, or minus the load that they carry."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple, Protocol, TypeAlias

import numpy as np

from ...base.numeric.arrays import Array
from ..statics import (
    LoadProblem,
    StaticsProblem,
    carried_load,
    friction_against,
    most_against,
    needed_friction,
    twist_for,
)

__all__ = ["Cuts", "Measured", "MinusCarried", "NeededFriction", "Objective"]

# Slopes of friction are those along the twist for so little less than is needed.
_BELOW = 1e-3
# Cuts of other places that are kept.
_MOST_TWISTS = 6
# A twist (6,), and how much each contact (n,) counts along it.
_Twist: TypeAlias = tuple[Array, Array]


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

    def knowing(self, other: "Measured") -> "Measured":
        """The same with cuts of another place besides, where they are of the same kind."""


class Objective(Protocol):
    """What is made small, of the maps (n, 8, 6) of contacts' points, see `power`."""

    def __call__(self, maps: Array, *, below: float = np.inf) -> Measured:
        """The place, with its cost; one that is no less than `below` may be any that is no less."""


@dataclass(frozen=True, eq=False)
class _Friction:
    """How much friction points need beyond some: a maximum over twists, with a cut for each that is known."""

    problem: StaticsProblem
    maps: Array
    cost: float
    needed: float
    others: tuple[_Twist, ...] = ()

    def cuts(self, moved: Sequence[Array]) -> Cuts:
        places = (self.maps, *moved)
        costs = np.array([[self._against(place, twist) for place in places] for twist in self._twists])
        # That of the place itself is the cost; one from elsewhere may seem to be more.
        costs += np.minimum(0.0, self.needed - costs[:, :1])
        costs[0] += self.needed - costs[0, 0]
        return Cuts(self.cost + costs[:, 0] - self.needed, costs[:, 1:] - costs[:, :1])

    def knowing(self, other: Measured) -> "_Friction":
        if not isinstance(other, _Friction):
            return self
        return replace(self, others=(other._own, *self.others, *other.others)[:_MOST_TWISTS])

    @cached_property
    def _own(self) -> _Twist:
        problem = self.problem
        return twist_for(self.maps, problem.arms, problem.reaches, (1.0 - _BELOW) * self.needed)

    @property
    def _twists(self) -> tuple[_Twist, ...]:
        return (self._own, *self.others)

    def _against(self, maps: Array, twist: _Twist) -> float:
        return float(friction_against(maps, self.problem.arms, self.problem.reaches, *twist))


@dataclass(frozen=True, eq=False)
class NeededFriction:
    """The friction that points need, beyond some."""

    problem: StaticsProblem
    beyond: float = 0.0

    def __call__(self, maps: Array, *, below: float = np.inf) -> _Friction:
        """The friction there."""
        del below  # it is found at once
        needed = float(needed_friction(maps, self.problem.arms, self.problem.reaches))
        return _Friction(self.problem, maps, needed - self.beyond, needed)


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

    def knowing(self, other: Measured) -> "_Carried":
        if not isinstance(other, _Carried):
            return self
        return replace(self, twists=np.vstack([self.twists, other.twists[:_MOST_TWISTS]]))

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
