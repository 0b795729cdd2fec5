"""The power of contact forces along a twist of the object, over parts of a region: Bernstein forms, enclosed.

For the twist y = (a, w), a point moves with v = a + w x p. With the inward m of any length,

    q(u, v; y) = (v . m, v x m, w . m, w x m)

is linear in y and in Bernstein form in (u, v). Along y, the force of a soft-finger contact with friction mu
and spin arm r (cone f_t^2 + (tau / r)^2 <= mu^2 f_n^2) has at least the power

    f_n (q_0 - mu |(q_1, q_2, q_3, r q_4)|) / |m|.

A wide contact acts anywhere within a disc of radius s about the point, in the tangent plane. At d from the
point the velocity is v + w x d: less along m by s |w x m| at most, and more across it by s |w . m|. So its
power is at least f_n (q_0 - mu |(q_1, q_2, q_3, r q_4)| - mu s |q_4| - s |(q_5, q_6, q_7)|) / |m|. The q that
make this positive are a convex cone. So all forces of the contact have positive power, wherever in the part
it is, if all control points of q over the part lie inside that cone.
"""

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array
from ..enclosure import restricted_net
from ..interval import add, div, down, mul, scale, sqr, sub, up

__all__ = ["point_power", "power_net", "refuted_friction"]

_HIGHEST_DEGREE = 64
_BINOMIALS = np.zeros((_HIGHEST_DEGREE + 1, _HIGHEST_DEGREE + 1))
_BINOMIALS[:, 0] = 1.0
for _n in range(1, _HIGHEST_DEGREE + 1):
    _BINOMIALS[_n, 1:] = _BINOMIALS[_n - 1, 1:] + _BINOMIALS[_n - 1, :-1]


@compiled
def power_net(
    points_low: Array,
    points_high: Array,
    normals_low: Array,
    normals_high: Array,
    is_patch: bool,
    part: Array,
) -> tuple[Array, Array]:
    """Enclosure of the control points of q over a part of a chart, as maps (n, 8, 6) of the twist.

    Args:
        points_low: see `Chart`.
        points_high: likewise.
        normals_low: likewise.
        normals_high: likewise.
        is_patch: likewise.
        part: (4,) u from, u to, v from, v to.
    """
    pl, pu = _restricted(points_low, points_high, part)
    if is_patch:
        ml, mu = _patch_normals(pl, pu)
    else:
        ml, mu = _restricted(normals_low, normals_high, part)
    wl, wu = _products(pl, pu, ml, mu)
    n = wl.shape[0]
    low, high = np.zeros((n, 8, 6)), np.zeros((n, 8, 6))
    for k in range(n):
        _put(wl[k], wu[k], low[k], high[k])
    return low, high


@compiled
def point_power(p: Array, m: Array) -> Array:
    """The map (8, 6) of q at one point p (3,) with the inward m (3,), in floats."""
    products = np.zeros((4, 3))
    for y in range(3):
        for x in range(3):
            products[x, y] = p[x] * m[y]
        products[3, y] = m[y]
    low, high = np.zeros((8, 6)), np.zeros((8, 6))
    _put(products, products, low, high)
    return 0.5 * (low + high)


@compiled
def refuted_friction(low: Array, high: Array, arms: Array, reaches: Array, twist: Array) -> float:
    """Below this coefficient, every force has positive power along a twist; at most 0 where that isn't shown.

    Args:
        low: control points as maps (n, 8, 6), enclosed.
        high: likewise.
        arms: spin arm (n,) of the contact that each belongs to.
        reaches: radius (n,) of the disc in which it acts.
        twist: (6,)
    """
    least = np.inf
    for k in range(len(arms)):
        ql, qu = np.zeros(8), np.zeros(8)
        for r in range(8):
            for c in range(6):
                tl, tu = scale(twist[c], low[k, r, c], high[k, r, c])
                ql[r], qu[r] = add(ql[r], qu[r], tl, tu)
        squares = 0.0
        for r in range(5, 8):
            _, square = sqr(ql[r], qu[r])
            squares = up(squares + square)
        left = down(ql[0] - up(reaches[k] * up(np.sqrt(squares))))
        if left <= 0.0:
            return 0.0
        tl, tu = mul(arms[k], arms[k], ql[4], qu[4])
        _, squares = sqr(tl, tu)
        for r in range(1, 4):
            _, square = sqr(ql[r], qu[r])
            squares = up(squares + square)
        lost = up(up(np.sqrt(squares)) + up(reaches[k] * max(-ql[4], qu[4])))
        if lost > 0.0:
            least = min(least, down(left / lost))
    return least


@compiled
def _restricted(low: Array, high: Array, part: Array) -> tuple[Array, Array]:
    """Control points over a part of what has the control points (m, n, c)."""
    m, n, width = low.shape
    out_l, out_u = np.zeros(low.shape), np.zeros(low.shape)
    work = np.zeros(6 * m * n)
    for c in range(width):
        one_l, one_u = np.zeros(m * n), np.zeros(m * n)
        for i in range(m):
            for j in range(n):
                one_l[i * n + j], one_u[i * n + j] = low[i, j, c], high[i, j, c]
        rl, ru = restricted_net(one_l, one_u, m - 1, n - 1, part[0], part[1], part[2], part[3], work)
        for i in range(m):
            for j in range(n):
                out_l[i, j, c], out_u[i, j, c] = rl[i * n + j], ru[i * n + j]
    return out_l, out_u


@compiled
def _patch_normals(pl: Array, pu: Array) -> tuple[Array, Array]:
    """Control points of p_v x p_u, inward, but for the factor that degrees and widths of the part give."""
    m, n, _ = pl.shape
    out_l, out_u = np.zeros((2 * m - 2, 2 * n - 2, 3)), np.zeros((2 * m - 2, 2 * n - 2, 3))
    ul, uu = np.zeros((m - 1, n, 3)), np.zeros((m - 1, n, 3))
    vl, vu = np.zeros((m, n - 1, 3)), np.zeros((m, n - 1, 3))
    for i in range(m):
        for j in range(n):
            for c in range(3):
                if i + 1 < m:
                    binomial = _BINOMIALS[m - 2, i] * _BINOMIALS[n - 1, j]
                    dl, du = sub(pl[i + 1, j, c], pu[i + 1, j, c], pl[i, j, c], pu[i, j, c])
                    ul[i, j, c], uu[i, j, c] = scale(binomial, dl, du)
                if j + 1 < n:
                    binomial = _BINOMIALS[m - 1, i] * _BINOMIALS[n - 2, j]
                    dl, du = sub(pl[i, j + 1, c], pu[i, j + 1, c], pl[i, j, c], pu[i, j, c])
                    vl[i, j, c], vu[i, j, c] = scale(binomial, dl, du)
    for i in range(m):
        for j in range(n - 1):
            for k in range(m - 1):
                for h in range(n):
                    for c in range(3):
                        a, b = (c + 1) % 3, (c + 2) % 3
                        xl, xu = mul(vl[i, j, a], vu[i, j, a], ul[k, h, b], uu[k, h, b])
                        yl, yu = mul(vl[i, j, b], vu[i, j, b], ul[k, h, a], uu[k, h, a])
                        xl, xu = sub(xl, xu, yl, yu)
                        out_l[i + k, j + h, c], out_u[i + k, j + h, c] = add(
                            out_l[i + k, j + h, c], out_u[i + k, j + h, c], xl, xu
                        )
    for i in range(2 * m - 2):
        for j in range(2 * n - 2):
            binomial = _BINOMIALS[2 * m - 3, i] * _BINOMIALS[2 * n - 3, j]
            for c in range(3):
                out_l[i, j, c], out_u[i, j, c] = div(out_l[i, j, c], out_u[i, j, c], binomial, binomial)
    return out_l, out_u


@compiled
def _products(pl: Array, pu: Array, ml: Array, mu: Array) -> tuple[Array, Array]:
    """Control points (k, 4, 3) of all products of a component of (P, w) and one of m."""
    d, e = pl.shape[0] - 1, pl.shape[1] - 1
    f, g = ml.shape[0] - 1, ml.shape[1] - 1
    low, high = np.zeros((d + f + 1, e + g + 1, 4, 3)), np.zeros((d + f + 1, e + g + 1, 4, 3))
    for i in range(d + 1):
        for j in range(e + 1):
            for k in range(f + 1):
                for h in range(g + 1):
                    weight = (
                        _BINOMIALS[d, i] * _BINOMIALS[e, j] * _BINOMIALS[f, k] * _BINOMIALS[g, h]
                    )  # a whole number, exact
                    for y in range(3):
                        yl, yu = scale(weight, ml[k, h, y], mu[k, h, y])
                        for x in range(4):
                            tl, tu = mul(pl[i, j, x], pu[i, j, x], yl, yu)
                            low[i + k, j + h, x, y], high[i + k, j + h, x, y] = add(
                                low[i + k, j + h, x, y], high[i + k, j + h, x, y], tl, tu
                            )
    for i in range(d + f + 1):
        for j in range(e + g + 1):
            weight = _BINOMIALS[d + f, i] * _BINOMIALS[e + g, j]
            for x in range(4):
                for y in range(3):
                    low[i, j, x, y], high[i, j, x, y] = div(low[i, j, x, y], high[i, j, x, y], weight, weight)
    n = (d + f + 1) * (e + g + 1)
    return low.reshape((n, 4, 3)), high.reshape((n, 4, 3))


@compiled
def _put(pl: Array, pu: Array, low: Array, high: Array) -> None:
    """Writes the map (8, 6) that products (4, 3) of (P, w) and m make."""
    for x in range(3):
        y, z = (x + 1) % 3, (x + 2) % 3
        # v . m = a . m + w . (p x m)
        low[0, x], high[0, x] = pl[3, x], pu[3, x]
        low[0, 3 + x], high[0, 3 + x] = sub(pl[y, z], pu[y, z], pl[z, y], pu[z, y])
        # v x m = a x m + p (w . m) - w (p . m)
        low[1 + x, y], high[1 + x, y] = pl[3, z], pu[3, z]
        low[1 + x, z], high[1 + x, z] = -pu[3, y], -pl[3, y]
        low[1 + x, 3 + y], high[1 + x, 3 + y] = pl[x, y], pu[x, y]
        low[1 + x, 3 + z], high[1 + x, 3 + z] = pl[x, z], pu[x, z]
        sl, su = add(pl[y, y], pu[y, y], pl[z, z], pu[z, z])
        low[1 + x, 3 + x], high[1 + x, 3 + x] = -su, -sl
        low[4, 3 + x], high[4, 3 + x] = pl[3, x], pu[3, x]
        # w x m
        low[5 + x, 3 + y], high[5 + x, 3 + y] = pl[3, z], pu[3, z]
        low[5 + x, 3 + z], high[5 + x, 3 + z] = -pu[3, y], -pl[3, y]
