"""Signed distances of many pairs in compiled code, for the steps of a retraction; verdicts are FCL's.

A retraction measures thousands of pairs on its way, and most of the time that FCL takes for each is spent
on the way from Python to it and back. Pairs that are apart are measured by the algorithm of Gilbert, Johnson
& Keerthi, "A fast procedure for computing the distance between complex objects in three-dimensional space"
(1988): a simplex of points of the Minkowski difference walks to the point next to the origin.
"""

import numpy as np

from ..base.machine.jit import compiled
from ..base.numeric.arrays import Array, Indices, Mask
from ..base.numeric.linalg import substitute
from .bodies import PlacedBodies
from .distance import Gaps, measure
from .penetration import expand

__all__ = ["measure_quickly", "nearest_points"]


_MAX_ITERATIONS = 60
# The simplex is next to the origin when no point of the difference is nearer along its direction than this
# share, squared: the distance is then right to half of it.
_SETTLED_SHARE = 1e-11
# Sets that are closer count as touching: their nearest points no longer give a direction.
_TOUCHING_M2 = 1e-16


def measure_quickly(placed: PlacedBodies, pairs: Indices) -> Gaps:
    """As `distance.measure`, to some 1e-8 m, and several times as fast."""
    bodies = placed.bodies
    w_a, w_b, normals = (np.zeros((len(pairs), 3)) for _ in range(3))
    settled = _measure(placed.vertices, bodies.starts, pairs, w_a, w_b, normals)
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
    vertices: Array, starts: Indices, pairs: Indices, w_a: Array, w_b: Array, normals: Array
) -> Mask:
    """Fills in nearest or deepest points and unit normals of pairs; which pairs that succeeded for."""
    settled = np.ones(len(pairs), dtype=np.bool_)
    for k in range(len(pairs)):
        a = vertices[starts[pairs[k, 0]] : starts[pairs[k, 0] + 1]]
        b = vertices[starts[pairs[k, 1]] : starts[pairs[k, 1] + 1]]
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
def nearest_points(a: Array, b: Array, w_a: Array, w_b: Array) -> float:
    """Distance of two hulls of points (n, 3); their nearest points are written to w_a (3,) and w_b (3,).

    Returns 0 where they touch or overlap, and then no points.
    """
    points, on_a, on_b = np.zeros((4, 3)), np.zeros((4, 3)), np.zeros((4, 3))
    weights, scratch = np.zeros(4), np.zeros((5, 4))
    for c in range(3):
        on_a[0, c], on_b[0, c] = a[0, c], b[0, c]
        w_a[c], w_b[c] = a[0, c], b[0, c]
        points[0, c] = b[0, c] - a[0, c]
    weights[0] = 1.0
    count = 1
    v = points[0].copy()
    for _ in range(_MAX_ITERATIONS):
        square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
        if square < _TOUCHING_M2:
            return 0.0
        i, j = _furthest(a, v, 1.0), _furthest(b, v, -1.0)
        reach = 0.0
        for c in range(3):
            reach += v[c] * (b[j, c] - a[i, c])
        if square - reach <= _SETTLED_SHARE * square or _is_known(on_a, on_b, count, a[i], b[j]):
            break
        for c in range(3):
            on_a[count, c], on_b[count, c] = a[i, c], b[j, c]
            points[count, c] = b[j, c] - a[i, c]
        count = _reduce(points, on_a, on_b, weights, count + 1, scratch)
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
def _furthest(points: Array, direction: Array, sign: float) -> int:
    """The point furthest along a direction, or against it."""
    best, most = 0, -np.inf
    x, y, z = sign * direction[0], sign * direction[1], sign * direction[2]
    for i in range(len(points)):
        along = points[i, 0] * x + points[i, 1] * y + points[i, 2] * z
        if along > most:
            best, most = i, along
    return best


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
def _reduce(points: Array, on_a: Array, on_b: Array, weights: Array, count: int, scratch: Array) -> int:
    """Keeps the corners of the face next to the origin, with their weights; 4 if the origin is inside."""
    # Of all faces with the newest corner whose own nearest point lies within them, the nearest: 8 at most.
    # The others were no nearer before.
    best, best_mask = np.inf, 0
    trial = scratch[4]
    newest = 1 << (count - 1)
    for mask in range(newest, 1 << count):
        square = _face(points, count, mask, trial, scratch)
        if square < best:
            best, best_mask = square, mask
            for k in range(4):
                weights[k] = trial[k]
    kept = 0
    for k in range(count):
        if best_mask >> k & 1:
            weights[kept] = weights[k]
            for c in range(3):
                points[kept, c], on_a[kept, c], on_b[kept, c] = points[k, c], on_a[k, c], on_b[k, c]
            kept += 1
    return kept


@compiled
def _face(points: Array, count: int, mask: int, weights: Array, scratch: Array) -> float:
    """Squared distance from the origin to the affine hull of some corners; inf where its foot lies outside.

    Weights of the corners are written to `weights` (4,), 0 for those that are not of the face. The newest
    corner, the last one, is of the face. Rows 0 to 3 of `scratch` (5, 4) are overwritten.
    """
    last, n = count - 1, 0
    G, h = scratch[:3], scratch[3]
    # Edges e from the last corner p: the foot p + E t has E'E t = -E'p.
    for k in range(last):
        if not mask >> k & 1:
            continue
        m = 0
        for other in range(k + 1):
            if mask >> other & 1:
                dot = 0.0
                for c in range(3):
                    dot += (points[k, c] - points[last, c]) * (points[other, c] - points[last, c])
                G[n, m] = dot
                m += 1
        h[n] = 0.0
        for c in range(3):
            h[n] -= (points[k, c] - points[last, c]) * points[last, c]
        n += 1
    if not _solve_gram(G, h, n):
        return np.inf
    rest, n = 1.0, 0
    for k in range(4):
        weights[k] = 0.0
        if k < last and mask >> k & 1:
            if h[n] <= 0.0:
                return np.inf
            weights[k] = h[n]
            rest -= h[n]
            n += 1
    if rest <= 0.0:
        return np.inf
    weights[last] = rest
    square = 0.0
    for c in range(3):
        x = 0.0
        for k in range(count):
            x += weights[k] * points[k, c]
        square += x * x
    return square


@compiled
def _solve_gram(G: Array, h: Array, n: int) -> bool:
    """Solves G t = h in place of h by Cholesky's method, from the lower half of G, which is overwritten.

    False where the edges are dependent.
    """
    for i in range(n):
        scale = G[i, i]
        for j in range(i + 1):
            s = G[i, j]
            for k in range(j):
                s -= G[i, k] * G[j, k]
            if i == j:
                if s <= 1e-13 * scale:
                    return False
                G[i, i] = np.sqrt(s)
            else:
                G[i, j] = s / G[j, j]
    substitute(G, h, n)
    return True
