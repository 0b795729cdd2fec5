"""Penetration depth of two convex point sets, by growing a polytope inside their Minkowski difference.

The depth is the least distance from the origin to the boundary of C = {a - b} (Cameron; van den Bergen,
"Proximity queries and penetration depth computation on 3D game objects", 2001). FCL has this algorithm
too, but reports trouble in it by a C++ exception that its Python binding does not catch: at grazing
contacts, which this project is about, the process ends (FCL issues 390, 529). So FCL is asked for
distances of bodies that are apart, and depths are computed here.

Unlike the textbook's, this polytope need not hold the origin at first: it grows at the facet with the
least signed offset, until that facet proves to be one of C.
"""

from typing import NamedTuple, TypeAlias

import numpy as np

from ..base.machine.jit import compiled
from ..base.numeric.arrays import Array, Indices
from ..geometry import Corners, any_corners, furthest

__all__ = ["Penetration", "expand", "penetrate"]


# A support point this close to a facet lies in it; rounding makes some 1e-15.
_IN_PLANE_M = 1e-12
# Facets with a smaller double area give no direction.
_LEAST_AREA_M2 = 1e-15
# A thinner Minkowski difference counts as flat.
_FLAT_M = 1e-8
_MAX_POINTS = 400
_MAX_FACETS = 2 * _MAX_POINTS


class Penetration(NamedTuple):
    """How two convex sets a and b overlap.

    Attributes:
        distance_m: minus the depth; positive by less than the distance where the sets turn out to be apart.
        p_a: point (3,) of a that lies deepest in b.
        p_b: point (3,) of b that lies deepest in a; p_b = p_a + distance_m * normal.
        normal: unit vector (3,) along which moving b parts the two soonest.
    """

    distance_m: float
    p_a: Array
    p_b: Array
    normal: Array


_Triple: TypeAlias = tuple[float, float, float]


class _Polytope(NamedTuple):
    """Points of C and the facets of their hull, in slots of which the first are taken.

    Attributes:
        points: (n, 3) points of C.
        chosen: (n, 2) indices of the points of a and b whose difference each is.
        facets: (m, 3) indices of the corners of each facet.
        normals: (m, 3) unit normals outwards.
        offsets: (m,) signed distance of each plane from the origin, along its normal.
    """

    points: Array
    chosen: Indices
    facets: Indices
    normals: Array
    offsets: Array


def penetrate(a: Array, b: Array) -> Penetration | None:
    """Depth of two convex hulls of points (n, 3) that overlap or touch.

    Returns None where the polytope degenerates, as it does for sets that are flat in parallel planes.
    """
    done, offset, p_a, p_b, normal = expand(any_corners(a), any_corners(b))
    return Penetration(-offset, p_a, p_b, normal) if done else None


@compiled
def expand(a: Corners, b: Corners) -> tuple[bool, float, Array, Array, Array]:
    """`penetrate` for compiled callers.

    Returns:
        Whether the polytope settled, then the offset, the points and the normal of the facet nearest to the
        origin.
    """
    hull = _Polytope(
        np.empty((_MAX_POINTS, 3)),
        np.empty((_MAX_POINTS, 2), dtype=np.int64),
        np.empty((_MAX_FACETS, 3), dtype=np.int64),
        np.empty((_MAX_FACETS, 3)),
        np.empty(_MAX_FACETS),
    )
    edges = np.empty((3 * _MAX_FACETS, 2), dtype=np.int64)
    p_a, p_b = np.zeros(3), np.zeros(3)
    n_facets = 4 if _first_tetrahedron(a, b, hull) else 0
    inside = _middle(hull.points)
    n_points = 4
    while n_facets > 0 and n_points < _MAX_POINTS:
        nearest = int(np.argmin(hull.offsets[:n_facets]))
        normal = _point(hull.normals, nearest)
        reach = _support(a, b, normal, hull, n_points)
        if reach - hull.offsets[nearest] <= _IN_PLANE_M:
            p_a, p_b = _deepest_points(a.points, b.points, hull, n_facets, nearest)
            return True, hull.offsets[nearest], p_a, p_b, np.array(normal)
        n_facets = _grow(hull, edges, n_facets, n_points, inside)
        n_points += 1
    return False, 0.0, p_a, p_b, p_a


# Three numbers each: unlike arrays they need no memory of their own, which would take half of the time.
@compiled
def _point(points: Array, k: int) -> _Triple:
    return points[k, 0], points[k, 1], points[k, 2]


@compiled
def _dot(u: _Triple, v: _Triple) -> float:
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


@compiled
def _cross(u: _Triple, v: _Triple) -> _Triple:
    return u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]


@compiled
def _scaled(u: _Triple, factor: float) -> _Triple:
    return u[0] * factor, u[1] * factor, u[2] * factor


@compiled
def _difference(u: _Triple, v: _Triple) -> _Triple:
    return u[0] - v[0], u[1] - v[1], u[2] - v[2]


@compiled
def _middle(points: Array) -> _Triple:
    """Mean of the first four points, which lies inside all that grows from them."""
    x, y, z = 0.0, 0.0, 0.0
    for k in range(4):
        x, y, z = x + 0.25 * points[k, 0], y + 0.25 * points[k, 1], z + 0.25 * points[k, 2]
    return x, y, z


@compiled
def _support(a: Corners, b: Corners, direction: _Triple, hull: _Polytope, slot: int) -> float:
    """Puts the point of C furthest along a direction into a slot; returns its coordinate there."""
    before = max(slot - 1, 0)
    best_a = furthest(a, direction, hull.chosen[before, 0] if slot else 0)
    best_b = furthest(b, _scaled(direction, -1.0), hull.chosen[before, 1] if slot else 0)
    p_a, p_b = _point(a.points, best_a), _point(b.points, best_b)
    hull.points[slot, 0], hull.points[slot, 1], hull.points[slot, 2] = _difference(p_a, p_b)
    hull.chosen[slot, 0], hull.chosen[slot, 1] = best_a, best_b
    return _dot(p_a, direction) - _dot(p_b, direction)


@compiled
def _first_tetrahedron(a: Corners, b: Corners, hull: _Polytope) -> bool:
    """Four points of C that span a volume and their facets; False where C is flat."""
    points, facets = hull.points, hull.facets
    direction = (1.0, 0.0, 0.0)
    _support(a, b, direction, hull, 0)
    first = _point(points, 0)
    for slot in range(1, 4):
        if slot == 1:
            direction = _scaled(direction, -1.0)
        elif slot == 2:
            axis = _difference(_point(points, 1), first)
            direction = _cross(axis, _along_least(axis))
        else:
            direction = _cross(_difference(_point(points, 1), first), _difference(_point(points, 2), first))
        length = np.sqrt(_dot(direction, direction))
        if length < _LEAST_AREA_M2:
            return False
        direction = _scaled(direction, 1.0 / length)
        # What finds nothing new is tried the other way round.
        if _support(a, b, direction, hull, slot) - _dot(direction, first) < _FLAT_M:
            direction = _scaled(direction, -1.0)
            if _support(a, b, direction, hull, slot) - _dot(direction, first) < _FLAT_M:
                return False
    inside = _middle(points)
    for f in range(4):
        facets[f, 0], facets[f, 1], facets[f, 2] = f, (f + 1) % 4, (f + 2) % 4
        if not _set_plane(hull, f, inside):
            return False
    return True


@compiled
def _along_least(u: _Triple) -> _Triple:
    """The unit vector along the coordinate that is least in size, the first of equals."""
    if abs(u[1]) < abs(u[0]):
        return (0.0, 0.0, 1.0) if abs(u[2]) < abs(u[1]) else (0.0, 1.0, 0.0)
    return (0.0, 0.0, 1.0) if abs(u[2]) < abs(u[0]) else (1.0, 0.0, 0.0)


@compiled
def _set_plane(hull: _Polytope, f: int, inside: _Triple) -> bool:
    """Normal and offset of a facet, which is turned to face outwards; False where it is too thin."""
    points, facets = hull.points, hull.facets
    p = _point(points, facets[f, 0])
    to_q, to_r = _difference(_point(points, facets[f, 1]), p), _difference(_point(points, facets[f, 2]), p)
    normal = _cross(to_q, to_r)
    area = np.sqrt(_dot(normal, normal))
    if area < _LEAST_AREA_M2:
        return False
    normal = _scaled(normal, 1.0 / area)
    if _dot(normal, _difference(inside, p)) > 0.0:
        normal = _scaled(normal, -1.0)
        facets[f, 1], facets[f, 2] = facets[f, 2], facets[f, 1]
    hull.normals[f, 0], hull.normals[f, 1], hull.normals[f, 2] = normal
    hull.offsets[f] = _dot(normal, p)
    return True


@compiled
def _grow(hull: _Polytope, edges: Indices, n_facets: int, new: int, inside: _Triple) -> int:
    """Replaces the facets that see point `new` by a fan to their horizon; their new number, 0 in trouble."""
    points, facets, normals, offsets = hull.points, hull.facets, hull.normals, hull.offsets
    n_edges, kept = 0, 0
    p = _point(points, new)
    for f in range(n_facets):
        if _dot(_point(normals, f), p) - offsets[f] > _IN_PLANE_M:
            for c in range(3):
                edges[n_edges, 0], edges[n_edges, 1] = facets[f, c], facets[f, (c + 1) % 3]
                n_edges += 1
        else:
            offsets[kept] = offsets[f]
            for c in range(3):
                facets[kept, c], normals[kept, c] = facets[f, c], normals[f, c]
            kept += 1
    for e in range(n_edges):
        inner = False
        for g in range(n_edges):
            if edges[g, 0] == edges[e, 1] and edges[g, 1] == edges[e, 0]:
                inner = True
                break
        if inner:
            continue
        if kept == _MAX_FACETS:
            return 0
        facets[kept, 0], facets[kept, 1], facets[kept, 2] = edges[e, 0], edges[e, 1], new
        if not _set_plane(hull, kept, inside):
            return 0
        kept += 1
    return kept


@compiled
def _deepest_points(a: Array, b: Array, hull: _Polytope, n_facets: int, nearest: int) -> tuple[Array, Array]:
    """The points (3,) of a and b whose difference is the foot of the origin on the nearest plane.

    Of the facets in that plane the one that holds the foot is taken, so that the points lie in a and b.
    """
    points, chosen, facets, normals, offsets = hull
    foot = _scaled(_point(normals, nearest), offsets[nearest])
    p_a, p_b = np.zeros(3), np.zeros(3)
    best = -np.inf
    for f in range(n_facets):
        if offsets[f] > offsets[nearest] + _IN_PLANE_M:
            continue
        p, normal = _point(points, facets[f, 0]), _point(normals, f)
        to_q = _difference(_point(points, facets[f, 1]), p)
        to_r = _difference(_point(points, facets[f, 2]), p)
        to_foot = _difference(foot, p)
        double = _dot(normal, _cross(to_q, to_r))
        weight_q = _dot(normal, _cross(to_foot, to_r)) / double
        weight_r = _dot(normal, _cross(to_q, to_foot)) / double
        weights = (1.0 - weight_q - weight_r, weight_q, weight_r)
        if min(weights) > best:
            best = min(weights)
            for i in range(3):
                p_a[i], p_b[i] = 0.0, 0.0
                for c in range(3):
                    p_a[i] += weights[c] * a[chosen[facets[f, c], 0], i]
                    p_b[i] += weights[c] * b[chosen[facets[f, c], 1], i]
    return p_a, p_b
