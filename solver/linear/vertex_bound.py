"""Least values of polynomials over a box, proved by the values of products at its vertices."""

from typing import NamedTuple

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array
from ..interval import add, down, mul, power, scale, sub, up
from .vertex_program import VertexProgram

__all__ = ["VertexBox", "least_value", "prepare", "to_vertices"]


class VertexBox(NamedTuple):
    """A box, and what a program needs to know of its powers there.

    Attributes:
        lower: (n,) the box.
        upper: (n,)
        ends: (atoms, 2) of the atoms.
        chords: (powers, 3) slope of the chord, least and largest gap, of the pure powers.
    """

    lower: Array
    upper: Array
    ends: Array
    chords: Array


@compiled
def _gap_of_convex(low_x: float, high_x: float, e: int, slope: float) -> tuple[float, float]:
    """Range of x^e - slope x on [low_x, high_x], where x^e is convex."""
    high = -np.inf
    for x in (low_x, high_x):
        pl, pu = power(x, x, e)
        ql, qu = scale(x, slope, slope)
        high = max(high, sub(pl, pu, ql, qu)[1])
    # The tangent next to the lowest point lies below.
    t = (abs(slope) / e) ** (1.0 / (e - 1))
    t = min(max(t if slope > 0.0 else -t, low_x), high_x)
    pl, pu = power(t, t, e)
    ql, qu = scale(t, slope, slope)
    vl, vu = sub(pl, pu, ql, qu)
    pl, pu = power(t, t, e - 1)
    pl, pu = scale(float(e), pl, pu)
    dl, du = sub(pl, pu, slope, slope)
    xl, xu = sub(low_x, high_x, t, t)
    ql, qu = mul(dl, du, xl, xu)
    return add(vl, vu, ql, qu)[0], high


@compiled
def _gap(low_x: float, high_x: float, e: int, slope: float) -> tuple[float, float]:
    """Range of x^e - slope x on [low_x, high_x]."""
    if e % 2 == 0 or low_x >= 0.0:
        return _gap_of_convex(low_x, high_x, e, slope)
    if high_x <= 0.0:
        low, high = _gap_of_convex(-high_x, -low_x, e, slope)
        return -high, -low
    low, high = _gap_of_convex(0.0, -low_x, e, slope)
    low2, high2 = _gap_of_convex(0.0, high_x, e, slope)
    return min(-high, low2), max(-low, high2)


@compiled
def _chord_slope(low_x: float, high_x: float, e: int) -> float:
    """(high_x^e - low_x^e) / (high_x - low_x) without the division, to rounding."""
    slope, product = 0.0, 1.0
    for _ in range(e):
        slope = slope * high_x + product
        product *= low_x
    return slope


@compiled
def prepare(p: VertexProgram, box: VertexBox) -> bool:
    """Fills in ends and chords over the box; False where something isn't finite."""
    lower, upper, ends, chords = box
    finite = True
    for a in range(len(p.atom_variable)):
        k = p.atom_variable[a]
        ends[a, 0], ends[a, 1] = power(lower[k], upper[k], p.atom_exponent[a])
        finite = finite and np.isfinite(ends[a, 0]) and np.isfinite(ends[a, 1])
    for j in range(len(p.power_variable)):
        low_x, high_x, e = lower[p.power_variable[j]], upper[p.power_variable[j]], p.power_exponent[j]
        slope = _chord_slope(low_x, high_x, e)
        low, high = _gap(low_x, high_x, e, slope)
        chords[j, 0], chords[j, 1], chords[j, 2] = slope, low, high
        finite = finite and np.isfinite(slope) and np.isfinite(low) and np.isfinite(high)
    return finite


@compiled
def to_vertices(values: Array, ends: Array, first: int, count: int) -> None:
    """Turns coefficients of products (2^count,) into values at the vertices, in place."""
    for b in range(count):
        low, high = ends[first + b, 0], ends[first + b, 1]
        stride = 1 << b
        for start in range(0, len(values), 2 * stride):
            for i in range(start, start + stride):
                c0, c1 = values[i], values[i + stride]
                values[i] = c0 + c1 * low
                values[i + stride] = c0 + c1 * high


@compiled
def least_value(p: VertexProgram, box: VertexBox, k: int, sign: float, y: Array) -> float:
    """A proved lower bound, over a box, of sign x_k - sum_e y_e f_e(x); k < 0: without x_k.

    Args:
        p: the program.
        box: the box, prepared.
        k: a variable or -1.
        sign: 1 or -1.
        y: (rows,) any numbers.
    """
    lower, upper, ends, chords = box
    constant = p.power_place + len(p.power_variable)
    cl, cu = np.zeros(constant + 1), np.zeros(constant + 1)
    if k >= 0:
        cl[p.home[k]] = cu[p.home[k]] = sign
    for e in range(len(p.term_start) - 1):
        if y[e] != 0.0:
            for t in range(p.term_start[e], p.term_start[e + 1]):
                q = p.place[t]
                pl, pu = scale(-y[e], p.c_lower[t], p.c_upper[t])
                cl[q], cu[q] = add(cl[q], cu[q], pl, pu)
    total_l, total_u = cl[constant], cu[constant]
    for j in range(len(p.power_variable)):
        q, home = p.power_place + j, p.home[p.power_variable[j]]
        if cl[q] != 0.0 or cu[q] != 0.0:
            pl, pu = scale(chords[j, 0], cl[q], cu[q])
            cl[home], cu[home] = add(cl[home], cu[home], pl, pu)
            pl, pu = mul(cl[q], cu[q], chords[j, 1], chords[j, 2])
            total_l, total_u = add(total_l, total_u, pl, pu)
    groups = len(p.atom_start) - 1
    for i in range(len(p.free)):
        q = p.group_place[groups] + i
        pl, pu = mul(cl[q], cu[q], lower[p.free[i]], upper[p.free[i]])
        total_l, total_u = add(total_l, total_u, pl, pu)
    for g in range(groups):
        begin, end = p.group_place[g], p.group_place[g + 1]
        least = _least_at_vertices(cl[begin:end], cu[begin:end], ends, p.atom_start[g], p.atom_start[g + 1])
        total_l, total_u = add(total_l, total_u, least, least)
    return total_l if np.isfinite(total_l) else -np.inf


@compiled
def _least_at_vertices(cl: Array, cu: Array, ends: Array, first: int, last: int) -> float:
    """A lower bound of the least vertex value of a product form with interval coefficients (2^count,).

    Computed to nearest: each coefficient takes part in 2 count roundings on its way, so that the error is at
    most 2 count + 1 units of 2^-53 of the sum of all magnitudes; twice that is taken off.
    """
    count = last - first
    size = len(cl)
    middle = 0.5 * (cl + cu)
    weight = np.ones(size)
    room = 1.0
    for b in range(count):
        largest = max(abs(ends[first + b, 0]), abs(ends[first + b, 1]), 1e-30)
        room *= max(largest, 1.0)
        stride = 1 << b
        for i in range(stride):
            weight[i + stride] = weight[i] * largest
    magnitude, blur = 0.0, 0.0
    for i in range(size):
        if cl[i] != 0.0 or cu[i] != 0.0:
            magnitude += abs(middle[i]) * weight[i]
            blur += up(max(cu[i] - middle[i], middle[i] - cl[i])) * weight[i]
    error = (magnitude * (2 * count + 1) * 2.0**-52 + blur) * (1.0 + 1e-12) + 1e-300 * room
    to_vertices(middle, ends, first, count)
    least = np.inf
    for i in range(size):
        # Not a number compares false: it must not pass for a large value.
        if not (middle[i] >= least):
            least = middle[i]
    return down(least - error) if np.isfinite(error) and np.isfinite(least) else -np.inf
