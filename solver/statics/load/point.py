"""What contacts at given points carry, whichever way gravity acts: from inside and from outside.

The forces without a torque that contacts of limited normal force bring about are a convex set; how much is
carried in every direction is the distance of its boundary from the origin. Points of the set, each from a
linear program, span a polytope within it, and the multipliers of each program bound the set from outside. The
program's columns are forces on the rim of the cones; those that its multipliers ask for are added, so that
cones stay round.
"""

from dataclasses import dataclass

import highspy
import numpy as np
from scipy.spatial import ConvexHull, QhullError

from ....arrays import Array
from ....geometry import even_directions
from ....highs import accept, new_highs

__all__ = ["CarriedLoad", "carried_load"]

# How closely a program is solved, and the distance is found, as a share of it.
_PROGRAM, _ENOUGH = 1e-6, 1e-4
_MOST_COLUMNS_ADDED, _MOST_DIRECTIONS = 60, 400
# Shares of the largest force below which nothing is carried.
_NOTHING = 1e-7


@dataclass(frozen=True, eq=False)
class CarriedLoad:
    """What is carried in every direction.

    Attributes:
        least: in N; so much for certain, but for the rounding of linear programs.
        most: no more.
        twist: (6,) that shows it.
    """

    least: float
    most: float
    twist: Array


def carried_load(maps: Array, arms: Array, friction: float, forces: Array) -> CarriedLoad:
    """What contacts at points carry in every direction.

    Args:
        maps: of points and unit normals (n, 8, 6), see `power`.
        arms: spin arms (n,).
        friction: coefficient.
        forces: largest normal forces (n,).
    """
    program = _Program(maps, arms, friction, forces)
    nothing = _NOTHING * float(forces.sum())
    points: list[Array] = []
    least, most, shown = 0.0, np.inf, np.zeros(6)

    def look(direction: Array) -> Array:
        """The farthest force (3,) along a direction, which is kept."""
        nonlocal most, shown
        point, bound, twist = program.farthest(direction)
        if bound < most:
            most, shown = bound, twist
        points.append(point)
        return point

    for direction in even_directions(0):
        look(direction)
        if most <= nothing:
            return CarriedLoad(0.0, most, shown)
    for _ in range(_MOST_DIRECTIONS):
        try:
            facets = ConvexHull(np.array(points)).equations
        except QhullError:  # they lie in a plane
            return CarriedLoad(0.0, most, shown)
        nearest = facets[np.argmax(facets[:, 3])]
        least = max(0.0, float(-nearest[3]))
        if most - least <= _ENOUGH * most or most <= nothing:
            break
        point = look(nearest[:3])
        if point @ nearest[:3] - least <= 0.1 * _ENOUGH * most:
            break
    return CarriedLoad(least, most, shown)


class _Program:
    """Largest d . f over forces f without a torque; columns are kept from one d to the next."""

    def __init__(self, maps: Array, arms: Array, friction: float, forces: Array):
        self._maps, self._n = maps, len(forces)
        self._rims = friction * np.concatenate([np.ones((self._n, 3)), arms[:, None]], axis=1)
        self._forces = forces
        self._highs = new_highs()
        accept(self._highs.changeObjectiveSense(highspy.ObjSense.kMaximize))
        none = np.array([], dtype=np.int32)
        for _ in range(3):
            accept(self._highs.addRow(0.0, 0.0, 0, none, np.array([])))
        for force in forces:
            accept(self._highs.addRow(-np.inf, float(force), 0, none, np.array([])))
        self._columns: list[Array] = []
        for i in range(self._n):
            self._add(i, np.zeros(4))
            for sign in (1.0, -1.0):
                for k in range(4):
                    self._add(i, sign * np.eye(4)[k])

    def farthest(self, direction: Array) -> tuple[Array, float, Array]:
        """The force (3,) that goes farthest along a unit vector, what none exceeds, and a twist for that."""
        highs = self._highs
        columns = np.arange(len(self._columns), dtype=np.int32)
        accept(highs.changeColsCost(len(columns), columns, np.array(self._columns)[:, :3] @ direction))
        most, shown, force = np.inf, np.append(direction, np.zeros(3)), np.zeros(3)
        for _ in range(_MOST_COLUMNS_ADDED):
            if not self._solve():
                break
            solution = highs.getSolution()
            force = np.array(solution.col_value) @ np.array(self._columns)[:, :3]
            duals = np.array(solution.row_dual)
            twist = np.concatenate([direction, -duals[:3]])
            rims, prices = self._best(twist)
            bound = float(self._forces @ np.maximum(prices, 0.0))
            if bound < most:
                most, shown = bound, -twist
            wanted = np.flatnonzero(prices > duals[3:] + 1e-12)
            if most - force @ direction <= _PROGRAM * most or not len(wanted):
                break
            for i in wanted:
                self._add(int(i), rims[i])
                cost = float(self._columns[-1][:3] @ direction)
                accept(highs.changeColCost(len(self._columns) - 1, cost))
        return force, most, shown

    def _solve(self) -> bool:
        """Whether an optimum is found; where that fails from the last basis, from none."""
        for _ in range(2):
            accept(self._highs.run())
            if self._highs.getModelStatus() == highspy.HighsModelStatus.kOptimal:
                return True
            accept(self._highs.clearSolver())
        return False

    def _best(self, twist: Array) -> tuple[Array, Array]:
        """Where on its rim (n, 4) each cone has the most power along a twist, and that power (n,)."""
        q = self._maps[:, :5] @ twist
        across = self._rims * q[:, 1:]
        sizes = np.linalg.norm(across, axis=1)
        return across / np.maximum(sizes, 1e-300)[:, None], q[:, 0] + sizes

    def _add(self, contact: int, rim: Array) -> None:
        """A column: the force of unit normal part at `rim` (4,), in the unit ball, of a contact's cone."""
        maps = self._maps[contact]
        wrench = maps[0] + (self._rims[contact] * rim) @ maps[1:5]
        rows = np.array([0, 1, 2, 3 + contact], dtype=np.int32)
        accept(self._highs.addCol(0.0, 0.0, np.inf, 4, rows, np.append(wrench[3:], 1.0)))
        self._columns.append(wrench)
