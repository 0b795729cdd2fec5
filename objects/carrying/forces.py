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

import highspy
import numpy as np
from numpy.typing import NDArray

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array
from ...base.numeric.highs import accept, new_highs
from ...errors import HoldfastError
from ...geometry import cone_edges, perpendicular
from .places import Places

__all__ = ["CarriedForces", "carried_forces", "growing_forces"]

# Torques count as forces at this arm, so that rows of the program are alike.
_ARM_M = 0.01
# Nothing is asked beyond this many newtons: where fingers press without limit it stands for infinity.
_MOST_N = 1e4
# A force of less is none.
_LEAST_N = 1e-9
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
        along = np.maximum(self.along, _LEAST_N)
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
        for k in range(done, count):
            along[k], normals[k] = program.largest(directions[k])
        done = count
        yield CarriedForces(directions[:count], along[:count], normals[:count])


class _Program:
    """Largest s with W x = s d, the sums of x by contact within `limits`, x >= 0 and 0 <= s <= _MOST_N."""

    def __init__(self, W: Array, contact: Array, limits: Array):
        n, finite = W.shape[1], np.flatnonzero(np.isfinite(limits))
        rows = np.vstack([W, *(contact == i for i in finite)])
        # The column of s is dense in the rows of the force, whose entries each direction replaces.
        columns = np.column_stack([rows, np.concatenate([np.ones(3), np.zeros(len(rows) - 3)])])
        starts, places, values = _by_columns(columns)
        self._highs, self._s = new_highs(), n
        accept(
            self._highs.passModel(
                n + 1, len(rows), len(values), int(highspy.MatrixFormat.kColwise),
                int(highspy.ObjSense.kMaximize), 0.0,
                np.append(np.zeros(n), 1.0), np.zeros(n + 1), np.append(np.full(n, np.inf), _MOST_N),
                np.append(np.zeros(6), np.full(len(finite), -np.inf)), np.append(np.zeros(6), limits[finite]),
                starts, places, values, np.zeros(n + 1, dtype=np.int32),
            )
        )  # fmt: skip

    def largest(self, direction: Array) -> tuple[float, Array]:
        """The largest force in N along a unit vector (3,), and the normal (3,) of its halfspace."""
        for row in range(3):
            accept(self._highs.changeCoeff(row, self._s, -float(direction[row])))
        self._highs.run()
        if self._highs.getModelStatus() != highspy.HighsModelStatus.kOptimal:
            raise HoldfastError("HiGHS found no optimum of a program that has one")
        solution = self._highs.getSolution()
        y = np.array(solution.row_dual[:3])
        along, slope = float(solution.col_value[self._s]), float(y @ direction)
        # At the bound on s nothing limits the force, and the multipliers vanish.
        if abs(slope) < _LEAST_COSINE:
            return np.inf, np.asarray(direction, dtype=float)
        return max(0.0, along), y / slope


def _program(
    places: Sequence[Places], centre: Array, mu: float, subdivisions: int, outside: bool
) -> _Program:
    blocks, contact = [], []
    for i, place in enumerate(places):
        edges = cone_edges(mu, mu * place.spin_arm_m, subdivisions, outside=outside)
        blocks.append(_wrenches(place.points - centre, place.inward, edges))
        contact.append(np.full(blocks[-1].shape[1], i))
    limits = np.array([place.largest_N for place in places])
    return _Program(np.column_stack(blocks), np.concatenate(contact), limits)


def _wrenches(arms: Array, inward: Array, edges: Array) -> Array:
    """Force in N and torque by `_ARM_M` (6, n k) of cone edges (4, k) at `arms` (n, 3) from the centre."""
    count, k = len(arms), edges.shape[1]
    wrenches = np.empty((6, count, k))
    for i, (arm, axis) in enumerate(zip(arms, inward, strict=True)):
        forces = np.vstack([axis, perpendicular(axis)]).T @ edges[:3]
        (x, y, z), (fx, fy, fz) = arm, forces
        wrenches[:3, i] = forces
        wrenches[3, i] = y * fz - z * fy
        wrenches[4, i] = z * fx - x * fz
        wrenches[5, i] = x * fy - y * fx
        wrenches[3:, i] += np.outer(axis, edges[3])
    wrenches[3:] /= _ARM_M
    return wrenches.reshape(6, count * k)


def _by_columns(A: Array) -> tuple[NDArray[np.int32], NDArray[np.int32], Array]:
    """Where each column's entries start (n,), and rows and values of all that are not zero."""
    columns, rows = np.nonzero(A.T)
    starts = np.searchsorted(columns, np.arange(A.shape[1])).astype(np.int32)
    return starts, rows.astype(np.int32), A.T[columns, rows]
