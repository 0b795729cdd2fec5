"""Signed distances between convex pieces: a broad phase by slabs, then an exact one on the near ones.

The distance is that between the surfaces; where two pieces overlap it is minus the length of the shortest
translation that parts them (penetration depth). FCL measures pieces that are apart, `penetration` depths.
"""

from dataclasses import dataclass
from typing import NamedTuple

import fcl
import numpy as np

from ..base.machine.jit import compiled
from ..base.numeric.arrays import Array, Indices
from .bodies import FCL_UNITS_PER_M, PlacedBodies
from .penetration import penetrate

__all__ = ["Gaps", "joined", "lower_bounds", "measure"]


# Without signed distances: see `penetration`.
_REQUEST = fcl.DistanceRequest(enable_nearest_points=True, enable_signed_distance=False)

# Axes, face diagonals and space diagonals of a cube: an 26-sided slab bound (k-DOP) around every piece.
_SLABS = np.array(
    [(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1) if (x, y, z) > (0, 0, 0)],
    dtype=float,
)
_SLABS /= np.linalg.norm(_SLABS, axis=1, keepdims=True)

# Cores closer than this count as touching: their nearest points no longer give a direction.
_TOUCHING_M = 1e-8
# FCL's answer stands when its own normal separates the cores by all but this much.
_DOUBT_M = 1e-8
_DOUBT_SHARE = 1e-7
# Where FCL is asked again, the cores are first parted by so much; another gap gets it past another bad end.
_PARTED_M = (1e-3, 1e-2, 1e-4, 3e-2, 3e-3)
_SETTLED_M = 1e-12
_MAX_ASCENT = 30


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


def joined(first: Gaps, second: Gaps) -> Gaps:
    """The pairs of both, in this order."""
    return Gaps(
        np.concatenate([first.pairs, second.pairs]),
        np.concatenate([first.distance_m, second.distance_m]),
        np.concatenate([first.p_a, second.p_a]),
        np.concatenate([first.p_b, second.p_b]),
        np.concatenate([first.normals, second.normals]),
    )


def lower_bounds(placed: PlacedBodies, pairs: Indices) -> Array:
    """Lower bounds (k,) on the distances of pairs (k, 2) of pieces, in m; cheap, and never too large."""
    low, high = placed.extents(_SLABS)
    return _slab_gaps(low, high, placed.bodies.radius, np.ascontiguousarray(pairs))


@compiled
def _slab_gaps(low: Array, high: Array, radius: Array, pairs: Indices) -> Array:
    """The widest gap (k,) of each pair (k, 2) over slabs [low, high] (n_pieces, n_slabs), less the radii."""
    gaps = np.empty(len(pairs))
    for k in range(len(pairs)):
        a, b = pairs[k, 0], pairs[k, 1]
        widest = -np.inf
        for i in range(low.shape[1]):
            widest = max(widest, low[b, i] - high[a, i], low[a, i] - high[b, i])
        gaps[k] = widest - radius[a] - radius[b]
    return gaps


def measure(placed: PlacedBodies, pairs: Indices) -> Gaps:
    """Signed distances of pairs (k, 2) of pieces.

    The gap between two cores along any direction is at most their signed distance, and equals it along the
    right one. So what is returned is the gap along the direction found, which overstates no distance.
    FCL's GJK sometimes ends early: where its own distance is not the gap, a wider one is searched for.
    """
    objects = {i: placed.fcl_object(i) for i in np.unique(pairs).tolist()}
    count = len(pairs)
    distance, normals = np.zeros(count), np.zeros((count, 3))
    w_a, w_b = np.zeros((count, 3)), np.zeros((count, 3))
    for k, (a, b) in enumerate(pairs.tolist()):
        apart = _query(objects[a], objects[b])
        answer = apart if apart.distance_m > _TOUCHING_M else _overlap(placed, a, b)
        distance[k], w_a[k], w_b[k], normals[k] = answer
    gaps = placed.separations(pairs, normals)
    for k in np.flatnonzero(distance - gaps > _DOUBT_M + _DOUBT_SHARE * np.abs(distance)).tolist():
        a, b = pairs[k].tolist()
        gaps[k], w_a[k], w_b[k], normals[k] = _ascend(placed, a, b, normals[k])
    r_a, r_b = placed.bodies.radius[pairs.T]
    return Gaps(
        pairs,
        gaps - r_a - r_b,
        w_a + r_a[:, None] * normals,
        w_b - r_b[:, None] * normals,
        normals,
    )


class _Answer(NamedTuple):
    """Signed distance of two cores in m, their nearest or deepest points, and the unit vector from a to b."""

    distance_m: float
    w_a: Array
    w_b: Array
    normal: Array


def _query(a: fcl.CollisionObject, b: fcl.CollisionObject) -> _Answer:
    """FCL's answer on two cores; a distance below zero says only that they overlap."""
    result = fcl.DistanceResult()
    distance = fcl.distance(a, b, _REQUEST, result) / FCL_UNITS_PER_M
    w_a, w_b = result.nearest_points
    w_a, w_b = w_a / FCL_UNITS_PER_M, w_b / FCL_UNITS_PER_M
    normal = (w_b - w_a) / distance if distance > 0.0 else np.zeros(3)
    return _Answer(distance, w_a, w_b, normal)


def _overlap(placed: PlacedBodies, a: int, b: int) -> _Answer:
    """Depth of two cores that overlap or touch."""
    found = penetrate(placed.core(a), placed.core(b))
    if found is not None:
        return _Answer(*found)
    # The Minkowski difference is flat, as that of two parallel segments: some slab parts the two best.
    directions = np.concatenate([_SLABS, -_SLABS])
    gaps = [_separation(placed, a, b, n) for n in directions]
    return _ascend(placed, a, b, directions[int(np.argmax(gaps))])


def _ascend(placed: PlacedBodies, a: int, b: int, normal: Array) -> _Answer:
    """The widest gap that is reached uphill from a direction.

    With b moved by t along the normal n until the two are well apart, their distance is the maximum over m
    of gap(m) + t n.m. Its argument m, which the nearest points show, has no narrower a gap than n. So the
    gap only widens, and every gap is a lower bound of the signed distance.
    """
    gap = _separation(placed, a, b, normal)
    for _ in range(_MAX_ASCENT):
        for parted in _PARTED_M:
            answer = _query_parted(placed, a, b, (parted - gap) * normal)
            wider = _separation(placed, a, b, answer.normal)
            if wider > gap or answer.distance_m <= parted + _DOUBT_M:
                break  # uphill, or proved to be on top: FCL finds no points that are closer
        if wider <= gap + _SETTLED_M:
            break
        gap, normal = wider, answer.normal
    return _Answer(gap, answer.w_a, answer.w_b, normal)


def _query_parted(placed: PlacedBodies, a: int, b: int, shift: Array) -> _Answer:
    """FCL's answer with b moved by `shift`; its point on b is given where b really is."""
    distance, w_a, w_b, normal = _query(placed.fcl_object(a), placed.fcl_object(b, shift))
    return _Answer(distance, w_a, w_b - shift, normal)


def _separation(placed: PlacedBodies, a: int, b: int, normal: Array) -> float:
    """Gap between two cores along a unit vector from a to b."""
    return float((placed.core(b) @ normal).min() - (placed.core(a) @ normal).max())
