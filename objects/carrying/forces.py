"""The forces on an object that contacts at given places can bring about without any torque.

A contact is a soft finger as in the squeeze plan: for each newton of normal force it may push along the
tangents within the friction mu, and turn about the normal within mu times the arm of its pad. Its normal
forces, over all its places, sum up to what its finger can give at most. Which forces F act on the object as a
whole, with no torque about its centre of mass, is a convex set; a linear program finds the largest s with s d
in it for a direction d, and the multipliers y of its optimum bound the set everywhere:

    y . F <= h    for every F of the set,    y . d = 1,    h = s.

So the set lies in the polytope of these halfspaces, one a direction, and reaches its faces along each d.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array
from ...base.numeric.simplex import AT_LOWER, BASIC, Tableau, minimise
from ...errors import HoldfastError
from ...geometry import cone_edges, even_directions, perpendicular
from .places import Places

__all__ = ["CarriedForces", "carried_forces", "growing_forces"]

# Torques count as forces at this arm, so that rows of the program are alike.
_ARM_M = 0.01
# Nothing is asked beyond this many newtons: where fingers press without limit it stands for infinity.
_MOST_N = 1e4
# A force of less is none, and what stands for none in halfspaces: less yet, as these may be slanted.
_LEAST_N, _NONE_N = 1e-6, 1e-9
# Multipliers of a direction that stand across it say nothing of it.
_LEAST_COSINE = 1e-9


@dataclass(frozen=True, eq=False)
class CarriedForces:
    """Forces that contacts can bring about, as a polytope that contains them.

    Attributes:
        directions: (m, 3) unit vectors in the object's frame that were looked at.
        along: (m,) largest force in N along each of them.
        normals: (m, 3) of the polytope's halfspaces normals @ F <= along.
    """

    directions: Array
    along: Array
    normals: Array

    def best_turn(self, turned: Array) -> tuple[int, float]:
        """The set of directions of which the worst one carries most, and the force in N along that one.

        Args:
            turned: (k, g, 3) unit vectors, g directions of each of k sets.
        """
        along = np.maximum(self.along, _NONE_N)
        best, steepest = _flattest(
            np.ascontiguousarray(turned), self.normals / along[:, None], _LEAST_COSINE / along
        )
        most = 1.0 / steepest if steepest > 0.0 else np.inf
        return best, most if most > _LEAST_N else 0.0


@compiled
def _flattest(turned: Array, slopes: Array, offsets: Array) -> tuple[int, float]:
    """The set of directions of which the largest slope of all is least, and this slope."""
    best, least = 0, np.inf
    for k in range(len(turned)):
        most = -np.inf
        for g in range(turned.shape[1]):
            x, y, z = turned[k, g]
            for m in range(len(slopes)):
                most = max(most, slopes[m, 0] * x + slopes[m, 1] * y + slopes[m, 2] * z - offsets[m])
            if most >= least:
                break
        if most < least:
            best, least = k, most
    return best, least


def carried_forces(
    places: Sequence[Places],
    centre: Array,
    mu: float,
    directions: Array,
    *,
    subdivisions: int = 1,
    outside: bool = False,
) -> CarriedForces:
    """The forces that contacts can bring about on an object without turning it.

    Args:
        places: where each contact presses, and how hard.
        centre: (3,) centre of mass of the object in m.
        mu: friction.
        directions: (m, 3) unit vectors, each of which makes a halfspace.
        subdivisions: fineness of the cones, see `cone_edges`.
        outside: whether the cones lie within their edges, rather than around them.
    """
    (whole,) = growing_forces(
        places, centre, mu, directions, (len(directions),), subdivisions=subdivisions, outside=outside
    )
    return whole


def growing_forces(
    places: Sequence[Places],
    centre: Array,
    mu: float,
    directions: Array,
    counts: Sequence[int],
    *,
    subdivisions: int = 1,
    outside: bool = False,
) -> Iterator[CarriedForces]:
    """The same by the first few of the directions, then by more of them, as `counts` says."""
    program = _program(places, centre, mu, subdivisions, outside)
    along, normals = np.zeros(len(directions)), np.zeros((len(directions), 3))
    done = 0
    for count in counts:
        along[done:count], normals[done:count] = program.largest(directions[done:count])
        done = count
        yield CarriedForces(directions[:count], along[:count], normals[:count])


class _Program:
    """Largest s with W x = s d, the sums of x by contact within `limits`, x >= 0 and 0 <= s <= _MOST_N."""

    def __init__(self, A: Array, limits: Array):
        # Columns: x, the room left below each limit, and s, whose entries each direction replaces.
        self._A, self._limits = A, limits

    def largest(self, directions: Array) -> tuple[Array, Array]:
        """The largest forces (m,) in N along unit vectors (m, 3), and normals (m, 3) of their halfspaces."""
        along, normals = np.empty(len(directions)), np.empty((len(directions), 3))
        if not _largest(self._A, self._limits, np.ascontiguousarray(directions), along, normals):
            raise HoldfastError("the simplex method found no optimum of a program that has one")
        return along, normals


@compiled
def _largest(A: Array, limits: Array, directions: Array, along: Array, normals: Array) -> bool:
    """Solves the program for each direction, from no force at all; False where steps ran out."""
    rows, columns = A.shape
    s = columns - 1
    upper, cost = np.full(columns + rows, np.inf), np.zeros(columns + rows)
    upper[s], upper[columns : columns + 6], cost[s] = _MOST_N, 0.0, -1.0
    basis, status = np.empty(rows, dtype=np.int64), np.empty(columns + rows, dtype=np.int64)
    inverse, beta, y = np.empty((rows, rows)), np.empty(rows), np.empty(rows)
    for m in range(len(directions)):
        direction = directions[m]
        A[:3, s] = -direction
        status[:], inverse[:], beta[:6], beta[6:] = AT_LOWER, 0.0, 0.0, limits
        for row in range(rows):
            # Behind all columns are artificial variables, of which those of the balance are zero for good.
            basis[row] = columns + row if row < 6 else s - rows + row
            status[basis[row]] = BASIC
            inverse[row, row] = 1.0
        value = minimise(Tableau(A, upper, inverse, beta, basis, status, y), cost, 0.0, -np.inf)
        if not np.isfinite(value):
            return False
        slope = y[:3] @ direction
        # At the bound on s nothing limits the force, and the multipliers vanish.
        if abs(slope) < _LEAST_COSINE:
            along[m], normals[m] = np.inf, direction
        else:
            along[m], normals[m] = -value, y[:3] / slope
    return True


def _program(
    places: Sequence[Places], centre: Array, mu: float, subdivisions: int, outside: bool
) -> _Program:
    limits = np.array([place.largest_N for place in places])
    finite = np.flatnonzero(np.isfinite(limits))
    edges = len(even_directions(subdivisions))
    columns = edges * sum(len(place.points) for place in places)
    A = np.zeros((6 + len(finite), columns + len(finite) + 1))
    start = 0
    for i, place in enumerate(places):
        frames = np.array([[axis, *perpendicular(axis)] for axis in place.inward])
        cone = cone_edges(mu, mu * place.spin_arm_m, subdivisions, outside=outside)
        end = start + edges * len(frames)
        _wrenches(place.points - centre, frames, cone, A[:6, start:end])
        A[6:, start:end] = (finite == i)[:, None]
        start = end
    A[6:, columns:-1] = np.eye(len(finite))
    return _Program(A, limits[finite])


@compiled
def _wrenches(arms: Array, frames: Array, edges: Array, out: Array) -> None:
    """Force in N and torque by `_ARM_M`, out (6, n k), of cone edges (4, k) at `arms` (n, 3) from the centre.

    `frames` (n, 3, 3) has the normal and two tangents of each place as rows.
    """
    count = edges.shape[1]
    for i in range(len(arms)):
        x, y, z = arms[i]
        for k in range(count):
            f = edges[0, k] * frames[i, 0] + edges[1, k] * frames[i, 1] + edges[2, k] * frames[i, 2]
            spin = edges[3, k] * frames[i, 0]
            c = i * count + k
            out[:3, c] = f
            out[3, c] = (y * f[2] - z * f[1] + spin[0]) / _ARM_M
            out[4, c] = (z * f[0] - x * f[2] + spin[1]) / _ARM_M
            out[5, c] = (x * f[1] - y * f[0] + spin[2]) / _ARM_M
