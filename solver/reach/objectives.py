"""What places of contacts cost: the friction that they need, or minus the load that they carry."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from ...arrays import Array
from ..statics import LoadProblem, StaticsProblem, carried_load, most_against, needed_friction

__all__ = ["Cuts", "MinusCarried", "NeededFriction", "Objective"]


class Cuts(NamedTuple):
    """What is known of a cost about a place: the largest of some smooth ones, to first order.

    Attributes:
        values: (m,) of each of them there.
        changes: (m, d) to each of d places near by.
    """

    values: Array
    changes: Array


class Objective(Protocol):
    """A cost of the maps (n, 8, 6) of contacts' points, see `power`; infinite where they are of no use."""

    def __call__(self, maps: Array) -> float:
        """The cost."""

    def cuts(self, maps: Array, moved: Sequence[Array]) -> Cuts:
        """The cost about `maps`, by what becomes of it where they are `moved` a little."""


@dataclass(frozen=True, eq=False)
class NeededFriction:
    """The friction that points need."""

    problem: StaticsProblem

    def __call__(self, maps: Array) -> float:
        """The friction."""
        return float(needed_friction(maps, self.problem.arms, self.problem.reaches))

    def cuts(self, maps: Array, moved: Sequence[Array]) -> Cuts:
        """By differences."""
        value = self(maps)
        return Cuts(np.array([value]), np.array([[self(there) - value for there in moved]]))


@dataclass(frozen=True, eq=False)
class MinusCarried:
    """Minus the multiple of the load that points carry.

    That is a minimum over twists, so those against which least is carried say how it changes.
    """

    problem: LoadProblem

    def __call__(self, maps: Array) -> float:
        """Minus the multiple."""
        problem = self.problem
        found = carried_load(maps, problem.arms, problem.friction, problem.forces_N)
        return -found.least / problem.weight_N

    def cuts(self, maps: Array, moved: Sequence[Array]) -> Cuts:
        """One for each of the twists."""
        problem = self.problem
        found = carried_load(maps, problem.arms, problem.friction, problem.forces_N)
        places = (maps, *moved)
        costs = np.array([[self._against(place, twist) for place in places] for twist in found.twists])
        return Cuts(costs[:, 0], costs[:, 1:] - costs[:, :1])

    def _against(self, maps: Array, twist: Array) -> float:
        problem = self.problem
        return -most_against(maps, problem.arms, problem.friction, problem.forces_N, twist) / problem.weight_N
