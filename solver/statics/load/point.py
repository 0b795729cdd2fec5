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

from ....base.numeric.arrays import Array
from ....base.numeric.highs import accept, new_highs
from ....geometry import even_directions

__all__ = ["CarriedLoad", "carried_load", "most_against"]

# How closely a program is solved, and the distance is found, as a share of it.
_PROGRAM, _ENOUGH = 5e-5, 2e-4
_ROOM = 256
_MOST_COLUMNS_ADDED, _MOST_DIRECTIONS = 60, 400
# Shares of the largest force below which nothing is carried.
_NOTHING = 1e-7
# Twists that show no more than so many times what is carried are told.
_TELLING = 1.25


@dataclass(frozen=True, eq=False)
class CarriedLoad:
    """What is carried in every direction.

    Attributes:
        least: in N; so much for certain, but for the rounding of linear programs.
        most: no more.
        twist: (6,) that shows it.
        twists: (k, 6) that show nearly as little, `twist` first.
    """

    least: float
    most: float
    twist: Array
    twists: Array


def carried_load(
    maps: Array,
    arms: Array,
    friction: float,
    forces: Array,
    *,
    beyond: float = 0.0,
    first: Array | None = None,
) -> CarriedLoad:
    """What contacts at points carry in every direction.

    Args:
        maps: of points and unit normals (n, 8, 6), see `power`.
        arms: spin arms (n,).
        friction: coefficient.
        forces: largest normal forces (n,).
        beyond: in N; where no more is carried, both bounds may be any as far as this shows.
        first: direction (3,) in which to look first.
    """
    program = _Program(maps, arms, friction, forces)
    beyond = max(beyond, _NOTHING * float(forces.sum()))
    points: list[Array] = []
    seen: list[tuple[float, Array]] = []
    least = 0.0

    def look(direction: Array) -> Array:
        """The farthest force (3,) along a direction, which is kept."""
        point, bound, twist = program.farthest(direction)
        seen.append((bound, twist))
        points.append(point)
        return point

    def most() -> float:
        return min(bound for bound, _ in seen)

    def told() -> CarriedLoad:
        known = sorted(seen, key=lambda one: one[0])
        twists = [twist for bound, twist in known if bound <= _TELLING * known[0][0]]
        return CarriedLoad(least, known[0][0], known[0][1], np.array(twists or [known[0][1]]))

    for direction in [*([] if first is None else [first]), *even_directions(0)]:
        look(direction)
        if most() <= beyond:
            return told()
    # They may lie in a plane though the set doesn't.
    across = np.linalg.svd(np.array(points) - np.mean(points, axis=0))[2][-1]
    look(across), look(-across)
    for _ in range(_MOST_DIRECTIONS):
        try:
            facets = ConvexHull(np.array(points)).equations
        except QhullError:  # the set is flat
            least = 0.0
            return told()
        nearest = facets[np.argmax(facets[:, 3])]
        least = max(0.0, float(-nearest[3]))
        if most() - least <= _ENOUGH * most() or most() <= beyond:
            break
        point = look(nearest[:3])
        if point @ nearest[:3] - least <= 0.1 * _ENOUGH * most():
            break
    return told()


def most_against(maps: Array, arms: Array, friction: float, forces: Array, twist: Array) -> float:
    """What contacts at points carry at most, in N, as a twist (6,) with a unit vector first shows it.

    Args:
        maps: of points and unit normals (n, 8, 6), see `power`.
        arms: spin arms (n,).
        friction: coefficient.
        forces: largest normal forces (n,).
        twist: as `carried_load` gives it.
    """
    _, prices = _powers(maps, _rims(arms, friction), -twist)
    return float(forces @ np.maximum(prices, 0.0))


def _rims(arms: Array, friction: float) -> Array:
    """How far the cones (n,) reach across their normals (n, 4): three directions and the spin."""
    return friction * np.concatenate([np.ones((len(arms), 3)), arms[:, None]], axis=1)


def _powers(maps: Array, rims: Array, twist: Array) -> tuple[Array, Array]:
    """Where on its rim (n, 4) each cone has the most power along a twist, and that power (n,)."""
    q = maps[:, :5] @ twist
    across = rims * q[:, 1:]
    sizes = np.linalg.norm(across, axis=1)
    return across / np.maximum(sizes, 1e-300)[:, None], q[:, 0] + sizes


class _Program:
    """Largest d . f over forces f without a torque; columns are kept from one d to the next."""

    def __init__(self, maps: Array, arms: Array, friction: float, forces: Array):
        self._maps, self._n = maps, len(forces)
        self._rims = _rims(arms, friction)
        self._forces = forces
        self._highs = new_highs()
        accept(self._highs.changeObjectiveSense(highspy.ObjSense.kMaximize))
        none = np.array([], dtype=np.int32)
        for _ in range(3):
            accept(self._highs.addRow(0.0, 0.0, 0, none, np.array([])))
        for force in forces:
            accept(self._highs.addRow(-np.inf, float(force), 0, none, np.array([])))
        self._columns, self._count = np.zeros((_ROOM, 6)), 0
        for i in range(self._n):
            self._add(i, np.zeros(4), np.zeros(3))
            for sign in (1.0, -1.0):
                for k in range(4):
                    self._add(i, sign * np.eye(4)[k], np.zeros(3))

    def farthest(self, direction: Array) -> tuple[Array, float, Array]:
        """The force (3,) that goes farthest along a unit vector, what none exceeds, and a twist for that."""
        highs = self._highs
        columns = np.arange(self._count, dtype=np.int32)
        accept(highs.changeColsCost(self._count, columns, self._columns[: self._count, :3] @ direction))
        most, shown, force = np.inf, np.append(direction, np.zeros(3)), np.zeros(3)
        for _ in range(_MOST_COLUMNS_ADDED):
            if not self._solve():
                break
            solution = highs.getSolution()
            force = np.array(solution.col_value) @ self._columns[: self._count, :3]
            duals = np.array(solution.row_dual)
            twist = np.concatenate([direction, -duals[:3]])
            rims, prices = _powers(self._maps, self._rims, twist)
            bound = float(self._forces @ np.maximum(prices, 0.0))
            if bound < most:
                most, shown = bound, -twist
            wanted = np.flatnonzero(prices > duals[3:] + 1e-12)
            if most - force @ direction <= _PROGRAM * most or not len(wanted):
                break
            for i in wanted:
                self._add(int(i), rims[i], direction)
        return force, most, shown

    def _solve(self) -> bool:
        """Whether an optimum is found; where that fails from the last basis, from none."""
        for _ in range(2):
            accept(self._highs.run())
            if self._highs.getModelStatus() == highspy.HighsModelStatus.kOptimal:
                return True
            accept(self._highs.clearSolver())
        return False

    def _add(self, contact: int, rim: Array, direction: Array) -> None:
        """A column: the force of unit normal part at `rim` (4,), in the unit ball, of a contact's cone."""
        maps = self._maps[contact]
        wrench = maps[0] + (self._rims[contact] * rim) @ maps[1:5]
        rows = np.array([0, 1, 2, 3 + contact], dtype=np.int32)
        cost = float(wrench[:3] @ direction)
        accept(self._highs.addCol(cost, 0.0, np.inf, 4, rows, np.append(wrench[3:], 1.0)))
        if self._count == len(self._columns):
            self._columns = np.concatenate([self._columns, np.zeros_like(self._columns)])
        self._columns[self._count] = wrench
        self._count += 1
