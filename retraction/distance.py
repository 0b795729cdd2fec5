"""Signed distances between convex pieces: a broad phase by slabs, then FCL on those that may be near.

The distance is that between the surfaces; where two pieces overlap it is minus the length of the shortest
translation that parts them (penetration depth).
"""

from dataclasses import dataclass
from typing import NamedTuple

import fcl
import numpy as np
from numpy.typing import NDArray

from .bodies import FCL_UNITS_PER_M, PlacedBodies

__all__ = ["Gaps", "lower_bounds", "measure"]

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

_REQUEST = fcl.DistanceRequest(enable_nearest_points=True, enable_signed_distance=True)

# Axes, face diagonals and space diagonals of a cube: an 26-sided slab bound (k-DOP) around every piece.
_SLABS = np.array(
    [
        (x, y, z)
        for x in (-1, 0, 1)
        for y in (-1, 0, 1)
        for z in (-1, 0, 1)
        if (x, y, z) > (0, 0, 0)
    ],
    dtype=float,
)
_SLABS /= np.linalg.norm(_SLABS, axis=1, keepdims=True)

# Closer than this the nearest points of two cores no longer give a direction.
_TOUCHING_M = 1e-8
# Shifts of one core under which FCL is asked again, to read off a direction or to get it past a bad end.
_NUDGES_M = (1e-5, -1e-4, 1e-3)
# FCL's answer stands when its own normal separates the cores by all but this much.
_DOUBT_M = 1e-8
_DOUBT_SHARE = 1e-5


@dataclass(frozen=True, eq=False)
class Gaps:
    """Signed distances of k pairs of pieces, in the palm frame.

    Attributes:
        pairs: (k, 2) indices of pieces a and b.
        distance_m: (k,) negative where they overlap.
        p_a: (k, 3) nearest, or deepest, point on the surface of a.
        p_b: (k, 3) the same on b.
        normals: (k, 3) unit vectors along which b moves away from a fastest.
    """

    pairs: Indices
    distance_m: Array
    p_a: Array
    p_b: Array
    normals: Array


def lower_bounds(placed: PlacedBodies, pairs: Indices) -> Array:
    """Lower bounds (k,) on the distances of pairs (k, 2) of pieces, in m; cheap, and never too large."""
    low, high = placed.extents(_SLABS)
    a, b = pairs.T
    apart = np.maximum(low[b] - high[a], low[a] - high[b]).max(axis=1)
    radius = placed.bodies.radius
    return apart - radius[a] - radius[b]


def measure(placed: PlacedBodies, pairs: Indices) -> Gaps:
    """Signed distances of pairs (k, 2) of pieces.

    FCL's GJK sometimes ends early, so each answer is checked: the gap between two cores along any direction
    is at most their signed distance, and equals it along the right one. Where FCL's own normal falls
    short, it is asked again from other sides, and the largest gap found is returned.
    """
    objects = {i: placed.fcl_object(i) for i in np.unique(pairs).tolist()}
    count = len(pairs)
    distance, w_a, w_b = np.zeros(count), np.zeros((count, 3)), np.zeros((count, 3))
    for k, (a, b) in enumerate(pairs.tolist()):
        distance[k], w_a[k], w_b[k] = _query(objects[a], objects[b])
    normals = _directions(distance, w_a, w_b)
    shortfall = distance - _separations(placed, pairs, normals)
    touching = np.abs(distance) < _TOUCHING_M
    doubtful = shortfall > _DOUBT_M + _DOUBT_SHARE * np.abs(distance)
    for k in np.flatnonzero(touching | doubtful):
        answer = _ask_again(placed, pairs[k])
        w_a[k], w_b[k], normals[k] = answer.w_a, answer.w_b, answer.normal
        if not touching[k]:
            distance[k] = answer.separation
    r_a, r_b = placed.bodies.radius[pairs.T]
    return Gaps(
        pairs,
        distance - r_a - r_b,
        w_a + r_a[:, None] * normals,
        w_b - r_b[:, None] * normals,
        normals,
    )


def _query(a: fcl.CollisionObject, b: fcl.CollisionObject) -> tuple[float, Array, Array]:
    """Signed distance of two cores in m and their nearest points; a depth comes with the deepest points."""
    result = fcl.DistanceResult()
    distance = fcl.distance(a, b, _REQUEST, result)
    w_a, w_b = result.nearest_points
    return distance / FCL_UNITS_PER_M, w_a / FCL_UNITS_PER_M, w_b / FCL_UNITS_PER_M


def _directions(distance: Array, w_a: Array, w_b: Array) -> Array:
    """Unit vectors (k, 3) from a to b; zero where the points coincide.

    Nearest points swap sides when the cores overlap.
    """
    v = np.sign(distance)[:, None] * (w_b - w_a)
    length = np.linalg.norm(v, axis=1, keepdims=True)
    return np.divide(v, length, out=np.zeros_like(v), where=length > 0.0)


def _separations(placed: PlacedBodies, pairs: Indices, normals: Array) -> Array:
    """Gaps (k,) between the cores of pairs along unit `normals` (k, 3) from a to b."""
    low, high = np.zeros(len(pairs)), np.zeros(len(pairs))
    for i in np.unique(pairs).tolist():
        core = placed.core(i)
        as_a, as_b = np.flatnonzero(pairs[:, 0] == i), np.flatnonzero(pairs[:, 1] == i)
        high[as_a] = (normals[as_a] @ core.T).max(axis=1)
        low[as_b] = (normals[as_b] @ core.T).min(axis=1)
    return low - high


class _Answer(NamedTuple):
    """Nearest points of two cores, the direction from a to b, and the gap along it."""

    w_a: Array
    w_b: Array
    normal: Array
    separation: float

    def turned(self) -> "_Answer":
        """The same, with a and b swapped."""
        return _Answer(self.w_b, self.w_a, -self.normal, self.separation)


def _ask_again(placed: PlacedBodies, pair: Indices) -> _Answer:
    """The answer with the widest gap: cores in either order, then b nudged along the best direction so far."""
    a, b = pair.tolist()
    best = max(_ask(placed, a, b), _ask(placed, b, a).turned(), key=lambda answer: answer.separation)
    for nudge in _NUDGES_M:
        answer = _ask(placed, a, b, nudge * best.normal)
        best = max(best, answer, key=lambda answer: answer.separation)
    return best


def _ask(placed: PlacedBodies, a: int, b: int, shift: Array | None = None) -> _Answer:
    """FCL's answer for b moved by `shift`, its gap taken where b really is."""
    distance, w_a, w_b = _query(placed.fcl_object(a), placed.fcl_object(b, shift))
    normal = _directions(np.array([distance]), w_a[None, :], w_b[None, :])[0]
    if not normal.any():
        between = placed.centres[b] - placed.centres[a]
        length = float(np.linalg.norm(between))
        normal = between / length if length > 0.0 else np.array([0.0, 0.0, 1.0])
    separation = float((placed.core(b) @ normal).min() - (placed.core(a) @ normal).max())
    return _Answer(w_a, w_b if shift is None else w_b - shift, normal, separation)
