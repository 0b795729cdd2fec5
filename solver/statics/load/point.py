"""What contacts at given points carry, whichever way gravity acts: from inside and from outside.

The forces without a torque that contacts of limited normal force bring about are a convex set; how much is
carried in every direction is the distance of its boundary from the origin. Points of the set, each from a
linear program, span a polytope within it, and the multipliers of each program bound the set from outside. The
program's columns are forces on the rim of the cones; those that its multipliers ask for are added, so that
cones stay round.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from ....base.machine.jit import compiled
from ....base.numeric.arrays import Array
from ....base.numeric.simplex import AT_LOWER, BASIC, Tableau, minimise
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
    where, powers = np.empty((len(forces), 4)), np.empty(len(forces))
    _powers(np.ascontiguousarray(maps), _rims(arms, friction), -twist, where, powers)
    return float(forces @ np.maximum(powers, 0.0))


def _rims(arms: Array, friction: float) -> Array:
    """How far the cones (n,) reach across their normals (n, 4): three directions and the spin."""
    return friction * np.concatenate([np.ones((len(arms), 3)), arms[:, None]], axis=1)


@compiled
def _powers(maps: Array, rims: Array, twist: Array, where: Array, powers: Array) -> None:
    """Where on its rim (n, 4) each cone has the most power along a twist, and that power (n,)."""
    for i in range(len(powers)):
        size = 0.0
        for k in range(4):
            across = 0.0
            for c in range(6):
                across += maps[i, 1 + k, c] * twist[c]
            where[i, k] = rims[i, k] * across
            size += where[i, k] ** 2
        size = np.sqrt(size)
        where[i] /= max(size, 1e-300)
        powers[i] = size
        for c in range(6):
            powers[i] += maps[i, 0, c] * twist[c]


class _Program:
    """Largest d . f over forces f without a torque; columns and basis are kept from one d to the next."""

    def __init__(self, maps: Array, arms: Array, friction: float, forces: Array):
        self._maps, self._rims, self._forces = np.ascontiguousarray(maps), _rims(arms, friction), forces
        n = len(forces)
        rows = 3 + n
        # First a column for each row that fills it up: no torque does, and less force than the largest.
        self._wrenches = np.zeros((_ROOM, 6))
        self._tableau = Tableau(
            np.zeros((rows, _ROOM)),
            np.zeros(_ROOM + rows),
            np.eye(rows),
            np.concatenate([np.zeros(3), forces]),
            np.arange(rows),
            np.full(_ROOM + rows, AT_LOWER),
            np.zeros(rows),
        )
        self._tableau.A[:, :rows] = np.eye(rows)
        self._tableau.upper[3:rows] = np.inf
        self._tableau.status[:rows] = BASIC
        self._count = rows
        for i in range(n):
            for rim in (np.zeros(4), *np.eye(4), *-np.eye(4)):
                self._count = _add(self._tableau, self._wrenches, self._count, i, maps[i], self._rims[i], rim)

    def farthest(self, direction: Array) -> tuple[Array, float, Array]:
        """The force (3,) that goes farthest along a unit vector, what none exceeds, and a twist for that."""
        force, shown = np.zeros(3), np.append(direction, np.zeros(3))
        most = np.inf
        for _ in range(_MOST_COLUMNS_ADDED):
            if self._count + len(self._forces) > len(self._wrenches):
                self._grow()
            most, self._count, is_done = _improved(
                self._tableau,
                self._wrenches,
                self._count,
                self._maps,
                self._rims,
                self._forces,
                direction,
                most,
                shown,
                force,
            )
            if is_done:
                break
        return force, most, -shown

    def _grow(self) -> None:
        """Room for twice as many columns."""
        t, room = self._tableau, len(self._wrenches)
        rows = len(t.beta)
        none = np.zeros(room)
        self._wrenches = np.vstack([self._wrenches, np.zeros((room, 6))])
        self._tableau = t._replace(
            A=np.hstack([t.A, np.zeros((rows, room))]),
            upper=np.concatenate([t.upper[:room], none, t.upper[room:]]),
            status=np.concatenate([t.status[:room], np.full(room, AT_LOWER), t.status[room:]]),
        )


@compiled
def _improved(
    t: Tableau,
    wrenches: Array,
    count: int,
    maps: Array,
    rims: Array,
    forces: Array,
    direction: Array,
    most: float,
    shown: Array,
    force: Array,
) -> tuple[float, int, bool]:
    """The optimum over the columns, and a column for each contact that would do better.

    Args:
        t: the program, whose basis is gone on from; columns from `count` on are room.
        wrenches: of its columns (room, 6).
        count: columns there are.
        maps: of points and unit normals (n, 8, 6).
        rims: of the cones (n, 4).
        forces: largest normal forces (n,).
        direction: unit vector (3,) along which the force is to be large.
        most: what no force exceeds, as far as is known.
        shown: receives the twist (6,) that shows it, where it shows less than `most`.
        force: receives the force (3,) that was found.

    Returns:
        What no force exceeds, the columns there are now, and whether the optimum is near enough.
    """
    n, rows = len(forces), len(t.beta)
    cost, value = np.zeros(len(t.upper)), 0.0
    for c in range(rows, count):
        for k in range(3):
            cost[c] -= wrenches[c, k] * direction[k]
    for r in range(rows):
        value += cost[t.basis[r]] * t.beta[r]
    if not np.isfinite(minimise(t, cost, value, -np.inf)):
        return most, count, True
    force[:] = 0.0
    for r in range(rows):
        force += t.beta[r] * wrenches[t.basis[r], :3]
    twist, where, powers = np.empty(6), np.empty((n, 4)), np.empty(n)
    twist[:3], twist[3:] = direction, t.y[:3]
    _powers(maps, rims, twist, where, powers)
    bound = 0.0
    for i in range(n):
        bound += forces[i] * max(powers[i], 0.0)
    if bound < most:
        most = bound
        shown[:] = twist
    if most - force @ direction <= _PROGRAM * most:
        return most, count, True
    before = count
    for i in range(n):
        if powers[i] > 1e-12 - t.y[3 + i]:
            count = _add(t, wrenches, count, i, maps[i], rims[i], where[i])
    return most, count, count == before


@compiled
def _add(t: Tableau, wrenches: Array, count: int, contact: int, maps: Array, rims: Array, rim: Array) -> int:
    """Adds the force of unit normal part at `rim` (4,), in the unit ball, of a contact's cone."""
    wrenches[count] = maps[0]
    for k in range(4):
        wrenches[count] += rims[k] * rim[k] * maps[1 + k]
    t.A[:3, count] = wrenches[count, 3:]
    t.A[3 + contact, count] = 1.0
    t.upper[count] = np.inf
    return count + 1
