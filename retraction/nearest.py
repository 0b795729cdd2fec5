"""Signed distances of many pairs in compiled code, for the steps of a retraction; verdicts are FCL's.

A retraction measures thousands of pairs on its way, and most of the time that FCL takes for each is spent
on the way from Python to it and back. Pairs that are apart are measured by the algorithm of Gilbert, Johnson
& Keerthi, "A fast procedure for computing the distance between complex objects in three-dimensional space"
(1988): a simplex of points of the Minkowski difference walks to the point next to the origin.
"""

from typing import TypeAlias

import numpy as np

from ..base.machine.jit import compiled
from ..base.numeric.arrays import Array, Indices, Mask
from ..geometry import Corners, furthest
from .bodies import PlacedBodies, corners_of
from .distance import Gaps, measure
from .penetration import expand

__all__ = ["measure_quickly", "nearest_points"]


_MAX_ITERATIONS = 60
# The simplex is next to the origin when no point of the difference is nearer along its direction than this
# share, squared: the distance is then right to half of it.
_SETTLED_SHARE = 1e-11
# Sets that are closer count as touching: their nearest points no longer give a direction.
_TOUCHING_M2 = 1e-16
# Edges whose last one rises by so little over the others, as a share squared, are dependent.
_FLAT_SHARE = 1e-13

_Triple: TypeAlias = tuple[float, float, float]


def measure_quickly(placed: PlacedBodies, pairs: Indices) -> Gaps:
    """As `distance.measure`, to some 1e-8 m, and several times as fast."""
    bodies = placed.bodies
    w_a, w_b, normals = (np.zeros((len(pairs), 3)) for _ in range(3))
    settled = _measure(bodies.corners_at(placed.vertices), bodies.starts, pairs, w_a, w_b, normals)
    r_a, r_b = bodies.radius[pairs.T]
    gaps = Gaps(
        pairs,
        placed.separations(pairs, normals) - r_a - r_b,
        w_a + r_a[:, None] * normals,
        w_b - r_b[:, None] * normals,
        normals,
    )
    # Left are pairs that touch and whose difference is flat, as that of two segments.
    return gaps if settled.all() else _replaced(gaps, np.flatnonzero(~settled), placed)


def _replaced(gaps: Gaps, rows: Indices, placed: PlacedBodies) -> Gaps:
    """The gaps with some rows measured by FCL."""
    slow = measure(placed, gaps.pairs[rows])
    for name in ("distance_m", "p_a", "p_b", "normals"):
        getattr(gaps, name)[rows] = getattr(slow, name)
    return gaps


@compiled
def _measure(
    corners: Corners, starts: Indices, pairs: Indices, w_a: Array, w_b: Array, normals: Array
) -> Mask:
    """Fills in nearest or deepest points and unit normals of pairs; which pairs that succeeded for."""
    settled = np.ones(len(pairs), dtype=np.bool_)
    for k in range(len(pairs)):
        a = corners_of(corners, starts, pairs[k, 0])
        b = corners_of(corners, starts, pairs[k, 1])
        distance = nearest_points(a, b, w_a[k], w_b[k])
        if distance > 0.0:
            for c in range(3):
                normals[k, c] = (w_b[k, c] - w_a[k, c]) / distance
            continue
        settled[k], _, p_a, p_b, normal = expand(a, b)
        for c in range(3):
            w_a[k, c], w_b[k, c], normals[k, c] = p_a[c], p_b[c], normal[c]
    return settled


@compiled
def nearest_points(a: Corners, b: Corners, w_a: Array, w_b: Array) -> float:
    """Distance of two hulls of points; their nearest points are written to w_a (3,) and w_b (3,).

    Returns 0 where they touch or overlap, and then no points.
    """
    points, on_a, on_b = np.zeros((4, 3)), np.zeros((4, 3)), np.zeros((4, 3))
    weights = np.zeros(4)
    for c in range(3):
        on_a[0, c], on_b[0, c] = a.points[0, c], b.points[0, c]
        w_a[c], w_b[c] = on_a[0, c], on_b[0, c]
        points[0, c] = on_b[0, c] - on_a[0, c]
    weights[0] = 1.0
    count = 1
    i, j = 0, 0
    v = points[0].copy()
    for _ in range(_MAX_ITERATIONS):
        square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
        if square < _TOUCHING_M2:
            return 0.0
        i, j = furthest(a, (v[0], v[1], v[2]), i), furthest(b, (-v[0], -v[1], -v[2]), j)
        reach = 0.0
        for c in range(3):
            reach += v[c] * (b.points[j, c] - a.points[i, c])
        is_known = _is_known(on_a, on_b, count, a.points[i], b.points[j])
        if square - reach <= _SETTLED_SHARE * square or is_known:
            break
        for c in range(3):
            on_a[count, c], on_b[count, c] = a.points[i, c], b.points[j, c]
            points[count, c] = b.points[j, c] - a.points[i, c]
        count = _reduce(points, on_a, on_b, weights, count + 1)
        if count == 4:
            return 0.0
        nearer = 0.0
        for c in range(3):
            v[c] = 0.0
            for k in range(count):
                v[c] += weights[k] * points[k, c]
            nearer += v[c] * v[c]
        if not nearer < square:
            break  # within rounding there is nothing nearer than the last points
        for c in range(3):
            w_a[c], w_b[c] = 0.0, 0.0
            for k in range(count):
                w_a[c] += weights[k] * on_a[k, c]
                w_b[c] += weights[k] * on_b[k, c]
    return np.sqrt((w_b[0] - w_a[0]) ** 2 + (w_b[1] - w_a[1]) ** 2 + (w_b[2] - w_a[2]) ** 2)


@compiled
def _is_known(on_a: Array, on_b: Array, count: int, p_a: Array, p_b: Array) -> bool:
    for k in range(count):
        same = True
        for c in range(3):
            if on_a[k, c] != p_a[c] or on_b[k, c] != p_b[c]:
                same = False
        if same:
            return True
    return False


@compiled
def _reduce(points: Array, on_a: Array, on_b: Array, weights: Array, count: int) -> int:
    """Keeps the corners of the face next to the origin, with their weights; 4 if the origin is inside.

    Weights of the corners that are kept are written to `weights` (4,).
    """
    # Of all faces with the newest corner whose own nearest point lies within them, the nearest: 8 at most.
    # The others were no nearer before. A face is told by its edges e from the newest corner p: the nearest
    # point p + E t of its plane has E'E t = -E'p.
    last = count - 1
    p = _point(points, last)
    e0 = _edge(points, 0, last)
    e1 = _edge(points, 1, last)
    e2 = _edge(points, 2, last)
    g00, g11, g22 = _dot(e0, e0), _dot(e1, e1), _dot(e2, e2)
    g01, g02, g12 = _dot(e0, e1), _dot(e0, e2), _dot(e1, e2)
    h0, h1, h2 = -_dot(e0, p), -_dot(e1, p), -_dot(e2, p)
    best, t0, t1, t2 = _dot(p, p), 0.0, 0.0, 0.0
    # On edges.
    if h0 > 0.0 and h0 < g00:
        square = _square(p, e0, e1, e2, h0 / g00, 0.0, 0.0)
        if square < best:
            best, t0, t1, t2 = square, h0 / g00, 0.0, 0.0
    if h1 > 0.0 and h1 < g11:
        square = _square(p, e0, e1, e2, 0.0, h1 / g11, 0.0)
        if square < best:
            best, t0, t1, t2 = square, 0.0, h1 / g11, 0.0
    if h2 > 0.0 and h2 < g22:
        square = _square(p, e0, e1, e2, 0.0, 0.0, h2 / g22)
        if square < best:
            best, t0, t1, t2 = square, 0.0, 0.0, h2 / g22
    # In triangles.
    if last > 1:
        a, b = _foot(g00, g01, g11, h0, h1)
        if a > 0.0:
            square = _square(p, e0, e1, e2, a, b, 0.0)
            if square < best:
                best, t0, t1, t2 = square, a, b, 0.0
    if last > 2:
        a, b = _foot(g00, g02, g22, h0, h2)
        if a > 0.0:
            square = _square(p, e0, e1, e2, a, 0.0, b)
            if square < best:
                best, t0, t1, t2 = square, a, 0.0, b
        a, b = _foot(g11, g12, g22, h1, h2)
        if a > 0.0:
            square = _square(p, e0, e1, e2, 0.0, a, b)
            if square < best:
                best, t0, t1, t2 = square, 0.0, a, b
        # Inside: by elimination, as in `_foot`.
        k1, k2 = g01 / g00, g02 / g00
        d11, d12, d22 = g11 - k1 * g01, g12 - k1 * g02, g22 - k2 * g02
        if g00 > 0.0 and d11 > _FLAT_SHARE * g11:
            k12 = d12 / d11
            height = d22 - k12 * d12
            if height > _FLAT_SHARE * g22:
                c = (h2 - k2 * h0 - k12 * (h1 - k1 * h0)) / height
                b = (h1 - k1 * h0 - d12 * c) / d11
                a = (h0 - g01 * b - g02 * c) / g00
                if a > 0.0 and b > 0.0 and c > 0.0 and a + b + c < 1.0:
                    return 4
    kept = 0
    for k in range(last):
        t = t0 if k == 0 else t1 if k == 1 else t2
        if t > 0.0:
            weights[kept] = t
            for c in range(3):
                points[kept, c], on_a[kept, c], on_b[kept, c] = points[k, c], on_a[k, c], on_b[k, c]
            kept += 1
    weights[kept] = 1.0 - t0 - t1 - t2
    for c in range(3):
        points[kept, c], on_a[kept, c], on_b[kept, c] = points[last, c], on_a[last, c], on_b[last, c]
    return kept + 1


@compiled
def _point(points: Array, k: int) -> _Triple:
    return points[k, 0], points[k, 1], points[k, 2]


@compiled
def _edge(points: Array, k: int, last: int) -> _Triple:
    """From the last point to the k-th; zero where there is no such point before it."""
    if k >= last:
        return 0.0, 0.0, 0.0
    return points[k, 0] - points[last, 0], points[k, 1] - points[last, 1], points[k, 2] - points[last, 2]


@compiled
def _dot(u: _Triple, v: _Triple) -> float:
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


@compiled
def _square(p: _Triple, e0: _Triple, e1: _Triple, e2: _Triple, t0: float, t1: float, t2: float) -> float:
    """Squared length of p + t0 e0 + t1 e1 + t2 e2."""
    x = p[0] + t0 * e0[0] + t1 * e1[0] + t2 * e2[0]
    y = p[1] + t0 * e0[1] + t1 * e1[1] + t2 * e2[1]
    z = p[2] + t0 * e0[2] + t1 * e1[2] + t2 * e2[2]
    return x * x + y * y + z * z


@compiled
def _foot(g00: float, g01: float, g11: float, h0: float, h1: float) -> tuple[float, float]:
    """The shares t of two edges with G t = h; zeros where they are dependent, or it lies outside."""
    if g00 <= 0.0:
        return 0.0, 0.0
    k = g01 / g00
    height = g11 - k * g01
    if height <= _FLAT_SHARE * g11:
        return 0.0, 0.0
    b = (h1 - k * h0) / height
    a = (h0 - g01 * b) / g00
    if a > 0.0 and b > 0.0 and a + b < 1.0:
        return a, b
    return 0.0, 0.0
