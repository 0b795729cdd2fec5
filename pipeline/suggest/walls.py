"""Places on both sides of a hollow wall, such as a rim: two inside for the edges of a flat pad, one outside.

Pads get to a wall where it ends within their length in the direction of their edges, so only such places
count.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from ...base.numeric.arrays import Array
from ...geometry import perpendicular
from ...objects import ObjectModel
from .cover import are_covered
from .surface import Site, draw_surface, site_at

__all__ = ["wall_sites"]

# Points of the surface, and how many of them are looked at as the middle of a wall's inside.
_POINTS, _MIDDLES = 4000, 500
_DIRECTIONS = 8
# A point counts as that on the other side where it is off the line through the wall by no more.
_ASIDE = 0.35
# Normals of the two sides of a wall, and of the places inside with that between them.
_OPPOSED, _LEAST_LEAN, _MOST_LEAN = np.cos(np.radians(20.0)), np.radians(5.0), np.radians(35.0)
# How deep a pad reaches over the end of a wall; beyond it, up to the hand, nothing may be in its way.
_WAY_M, _REACH_M, _CLEAR_M = np.arange(0.0, 0.07, 0.002), 0.014, 0.005
_ABOVE_M = 0.002


class _Cloud(NamedTuple):
    """Points that stand for a surface.

    Attributes:
        points: (n, 3) in m.
        normals: (n, 3).
        faces: (n,) on which they lie.
        is_free: (n,) whether no convex piece covers them.
        tree: of all points.
    """

    points: Array
    normals: Array
    faces: NDArray[np.int64]
    is_free: NDArray[np.bool_]
    tree: KDTree


def wall_sites(
    obj: ObjectModel, span_m: float, widest_m: float, count: int, seed: int
) -> list[tuple[Site, Site, Site]]:
    """At most so many triples: two places inside a hollow wall, `span_m` apart, and one outside between them.

    Args:
        obj: the object.
        span_m: how far the edges of a pad are apart.
        widest_m: how far the pads open.
        count: of triples at most, spread over the object.
        seed: of the points that are looked at.
    """
    rng = np.random.default_rng(seed)
    points, faces = draw_surface(obj.mesh, _POINTS, rng)
    normals = np.array(obj.mesh.face_normals[faces])
    cloud = _Cloud(points, normals, faces, ~are_covered(obj, points), KDTree(points))
    triples: list[tuple[int, int, int]] = []
    for middle in rng.permutation(np.flatnonzero(cloud.is_free))[:_MIDDLES]:
        if len(triples) == count:
            break
        triple = _triple(cloud, int(middle), span_m, widest_m)
        if triple is not None and all(_apart(points, triple, other) > 0.5 * span_m for other in triples):
            triples.append(triple)
    return [_sites(obj, cloud, triple) for triple in triples]


def _triple(cloud: _Cloud, middle: int, span_m: float, widest_m: float) -> tuple[int, int, int] | None:
    """Indices of two places inside and one outside of the wall behind a point of its inside."""
    p, n = cloud.points[middle], cloud.normals[middle]
    outside = _behind(cloud, p, n, _ASIDE * span_m, widest_m)
    if outside is None:
        return None
    e1, e2 = perpendicular(n)
    for angle in np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS:
        across = np.cos(angle) * e1 + np.sin(angle) * e2
        if not _ends(cloud, p, n, np.cross(n, across)):
            continue
        sides = [_inside(cloud, p, n, sign * across, span_m) for sign in (-1.0, 1.0)]
        if sides[0] is not None and sides[1] is not None:
            return sides[0], sides[1], outside
    return None


def _behind(cloud: _Cloud, p: Array, n: Array, aside_m: float, widest_m: float) -> int | None:
    """The nearest point that faces the other way, across the wall behind a point."""
    away = cloud.points - p
    depth = -(away @ n)
    aside = np.linalg.norm(away + depth[:, None] * n, axis=1)
    fits = cloud.is_free & (cloud.normals @ n < -_OPPOSED) & (depth > 0.0) & (depth < widest_m)
    fits &= aside < aside_m
    which = np.flatnonzero(fits)
    return int(which[np.argmin(depth[which] + aside[which])]) if len(which) else None


def _inside(cloud: _Cloud, p: Array, n: Array, out: Array, span_m: float) -> int | None:
    """The point half a span beside the middle, where the wall leans towards the middle there."""
    target = p + 0.5 * span_m * out + _ABOVE_M * n
    near = np.array(cloud.tree.query_ball_point(target, _ASIDE * span_m), dtype=np.int64)
    lean = np.arctan2(-(cloud.normals[near] @ out), cloud.normals[near] @ n)
    near = near[cloud.is_free[near] & (lean > _LEAST_LEAN) & (lean < _MOST_LEAN)]
    if not len(near):
        return None
    return int(near[np.argmin(np.linalg.norm(cloud.points[near] - target, axis=1))])


def _ends(cloud: _Cloud, p: Array, n: Array, along: Array) -> bool:
    """Whether the wall at a point ends in one of the directions along a pad, and all of the object does."""
    for sign in (-1.0, 1.0):
        way = p + 2.0 * _ABOVE_M * n + sign * _WAY_M[:, None] * along
        is_out = bool(np.any((way[-1] < cloud.tree.mins) | (way[-1] > cloud.tree.maxes)))
        if is_out and np.all(cloud.tree.query(way)[0] > np.where(_WAY_M < _REACH_M, _ABOVE_M, _CLEAR_M)):
            return True
    return False


def _apart(points: Array, a: Sequence[int], b: Sequence[int]) -> float:
    return float(np.linalg.norm(points[list(a)].mean(axis=0) - points[list(b)].mean(axis=0)))


def _sites(obj: ObjectModel, cloud: _Cloud, triple: Sequence[int]) -> tuple[Site, Site, Site]:
    first, second, outside = (site_at(obj, cloud.points[i], int(cloud.faces[i])) for i in triple)
    return first, second, outside
