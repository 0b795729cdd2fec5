"""Enclosures of equations, of their slopes and of their curvatures over a box."""

from typing import NamedTuple

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array
from ..interval import add, mul, power, sub
from .native import NativeSystem

__all__ = ["Expansion", "centre_slopes", "curvatures", "values_and_slopes"]


class Expansion(NamedTuple):
    """Enclosures of the m equations of a native system about a point of a box.

    Attributes:
        f_lower: (m,) values at the point.
        f_upper: (m,)
        J0_lower: (m, n) derivatives at the point.
        J0_upper: (m, n)
        J_lower: (m, n) derivatives, or slopes from the point, over the box.
        J_upper: (m, n)
        H_lower: (curvatures,) half the second derivatives over the box, in the order of the system's
            `pair_user`; those of the derivatives by i, then j, and by j, then i, are one.
        H_upper: likewise.
    """

    f_lower: Array
    f_upper: Array
    J0_lower: Array
    J0_upper: Array
    J_lower: Array
    J_upper: Array
    H_lower: Array
    H_upper: Array


@compiled
def values_and_slopes(
    s: NativeSystem,
    lower: Array,
    upper: Array,
    value_lower: Array,
    value_upper: Array,
    J_lower: Array,
    J_upper: Array,
) -> None:
    """Enclosures of all equations (m,) and of their derivatives (m, n), term by term."""
    m = len(s.term_start) - 1
    J_lower[:] = 0.0
    J_upper[:] = 0.0
    for e in range(m):
        total_l, total_u = 0.0, 0.0
        for t in range(s.term_start[e], s.term_start[e + 1]):
            begin, end = s.factor_start[t], s.factor_start[t + 1]
            vl, vu = s.c_lower[t], s.c_upper[t]
            for f in range(begin, end):
                pl, pu = power(lower[s.variable[f]], upper[s.variable[f]], s.exponent[f])
                vl, vu = mul(vl, vu, pl, pu)
            total_l, total_u = add(total_l, total_u, vl, vu)
            for f in range(begin, end):
                k = s.variable[f]
                wl, wu = s.c_lower[t], s.c_upper[t]
                n = s.exponent[f]
                if n > 1:
                    pl, pu = power(lower[k], upper[k], n - 1)
                    wl, wu = mul(wl, wu, pl, pu)
                    wl, wu = mul(wl, wu, float(n), float(n))
                for g in range(begin, end):
                    if g != f:
                        pl, pu = power(lower[s.variable[g]], upper[s.variable[g]], s.exponent[g])
                        wl, wu = mul(wl, wu, pl, pu)
                J_lower[e, k], J_upper[e, k] = add(J_lower[e, k], J_upper[e, k], wl, wu)
        value_lower[e], value_upper[e] = total_l, total_u


@compiled
def curvatures(s: NativeSystem, lower: Array, upper: Array, H_lower: Array, H_upper: Array) -> None:
    """Enclosures of half the second derivatives (curvatures,) of all equations over a box, term by term."""
    H_lower[:] = 0.0
    H_upper[:] = 0.0
    seen = 0
    for t in range(len(s.c_lower)):
        begin, end = s.factor_start[t], s.factor_start[t + 1]
        for f in range(begin, end):
            for g in range(f, end):
                n, o = s.exponent[f], s.exponent[g]
                if f == g and n < 2:
                    continue
                wl, wu = s.c_lower[t], s.c_upper[t]
                for h in range(begin, end):
                    left = s.exponent[h]
                    if h == f:
                        left -= 1
                    if h == g:
                        left -= 1
                    if left > 0:
                        pl, pu = power(lower[s.variable[h]], upper[s.variable[h]], left)
                        wl, wu = mul(wl, wu, pl, pu)
                # Half of the second derivative: on the diagonal n (n - 1) / 2, off it n o / 2 twice.
                factor = 0.5 * n * (n - 1) if f == g else 0.5 * n * o
                wl, wu = mul(wl, wu, factor, factor)
                at = s.curvature[seen]
                seen += 1
                H_lower[at], H_upper[at] = add(H_lower[at], H_upper[at], wl, wu)


@compiled
def centre_slopes(s: NativeSystem, x: Array, lower: Array, upper: Array, at: Expansion) -> None:
    """Narrows the slopes over a box by J(x) + H(X) (X - x), in place; x lies in the box."""
    G_lower, G_upper = at.J0_lower.copy(), at.J0_upper.copy()
    for p in range(len(s.pair)):
        i, j = s.pair[p]
        il, iu = sub(lower[i], upper[i], x[i], x[i])
        jl, ju = sub(lower[j], upper[j], x[j], x[j])
        for c in range(s.pair_start[p], s.pair_start[p + 1]):
            e = s.pair_user[c]
            # H holds half of the second derivatives.
            hl, hu = mul(2.0, 2.0, at.H_lower[c], at.H_upper[c])
            pl, pu = mul(hl, hu, jl, ju)
            G_lower[e, i], G_upper[e, i] = add(G_lower[e, i], G_upper[e, i], pl, pu)
            if i != j:
                pl, pu = mul(hl, hu, il, iu)
                G_lower[e, j], G_upper[e, j] = add(G_lower[e, j], G_upper[e, j], pl, pu)
    at.J_lower[:] = np.maximum(at.J_lower, G_lower)
    at.J_upper[:] = np.minimum(at.J_upper, G_upper)
