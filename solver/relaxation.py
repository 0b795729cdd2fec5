"""The linear relaxation of a system over a box: triangles, tetrahedra and bands (paper, section 4.3).

The pattern of the matrix is the same for every box; only values change, so a basis carries over from box
to box. Each row is valid in exact arithmetic for the coefficients as rounded: what rounding might cut
off is given back on the right-hand side.
"""

import numpy as np
from numpy.typing import NDArray

from .bernstein_box import control_points, workspace
from .canonical import CanonicalForm, Rows
from .rounding import add, down, jit, mul, scale, sqr, sub, up

__all__ = ["Relaxation"]

Array = NDArray[np.float64]


class Relaxation:
    """Rows lower <= A x <= upper that hold at every solution within a box."""

    def __init__(self, form: CanonicalForm):
        self.form = form
        self.n_linear = len(form.rows.lower)
        squares = form.products[:, 1] == form.products[:, 2]
        counts = [np.diff(form.rows.start)]
        columns = [form.rows.column]
        for (k, i, j), square in zip(form.products, squares, strict=True):
            n_rows, entries = 4, (k, i) if square else (k, i, j)
            counts.append(np.full(n_rows, len(entries)))
            columns.append(np.tile(entries, n_rows))
        for k, i, j in form.functions.kij:
            counts.append(np.full(2, 3))
            columns.append(np.tile((k, i, j), 2))
        self._start = np.concatenate([[0], np.cumsum(np.concatenate(counts))]).astype(np.int64)
        self._column = np.concatenate(columns).astype(np.int64)
        self._work = workspace(form.functions.degree)
        self.n_rows = len(self._start) - 1

    def build(self, lower: Array, upper: Array) -> Rows:
        """The rows over the box [lower, upper] (n,), products and linear rows alike."""
        value = np.empty(len(self._column))
        row_lower, row_upper = np.empty(self.n_rows), np.empty(self.n_rows)
        linear = self.form.rows
        m = len(linear.value)
        value[:m] = linear.value
        row_lower[: self.n_linear], row_upper[: self.n_linear] = linear.lower, linear.upper
        r, t = _product_rows(lower, upper, self.form.products, self.n_linear, m, value, row_lower, row_upper)
        _function_rows(lower, upper, *self.form.functions, r, t, value, row_lower, row_upper, self._work)
        return Rows(self._start, self._column, value, row_lower, row_upper)


@jit
def _product_rows(lower, upper, products, r, t, value, row_lower, row_upper):  # type: ignore[no-untyped-def]
    for _, i, j in products:
        if i == j:
            a, b = lower[i], upper[i]
            # Tangents at both ends and between: x_k >= 2 x x_i - x^2, with the coefficient 2 x exact.
            # Two alone would let a unit vector's tip leave the arc between them by far.
            for x in (a, b, 0.5 * (a + b)):
                value[t], value[t + 1] = 1.0, -2.0 * x
                row_lower[r], row_upper[r] = -sqr(x, x)[1], np.inf
                t, r = t + 2, r + 1
            # The chord: x_k <= (a + b) x_i - a b; s differs from a + b by less than the gap below.
            s = a + b
            gap = up(up(up(s) - down(s)) * max(abs(a), abs(b)))
            value[t], value[t + 1] = 1.0, -s
            row_lower[r], row_upper[r] = -np.inf, up(-mul(a, a, b, b)[0] + gap)
            t, r = t + 2, r + 1
            continue
        # Four planes (McCormick): x_k - b x_i - a x_j >= or <= -a b, for corners (a, b) of the rectangle.
        for a, b, below in (
            (lower[i], lower[j], True), (upper[i], upper[j], True),
            (upper[i], lower[j], False), (lower[i], upper[j], False),
        ):  # fmt: skip
            value[t], value[t + 1], value[t + 2] = 1.0, -b, -a
            lo, hi = mul(a, a, b, b)
            row_lower[r] = -hi if below else -np.inf
            row_upper[r] = np.inf if below else -lo
            t, r = t + 3, r + 1
    return r, t


@jit
def _function_rows(  # type: ignore[no-untyped-def]
    lower, upper, kij, degree, start, coefficients, r, t, value, row_lower, row_upper, work
):
    """Two parallel planes around each Bernstein function: its chords' slopes, shifted to enclose it."""
    for f in range(len(kij)):
        _, i, j = kij[f]
        di, dj = degree[f]
        n = (di + 1) * (dj + 1)
        b = coefficients[start[f] : start[f] + n]
        il, iu, jl, ju = lower[i], upper[i], lower[j], upper[j]
        low, high = control_points(b, di, dj, il, iu, jl, ju, work)
        # The four corners lie on the surface itself; any slopes near its own will do.
        p00, p01, p10, p11 = low[0], low[dj], low[n - dj - 1], low[n - 1]
        a_i = 0.5 * (p10 - p00 + p11 - p01) / (iu - il) if iu > il else 0.0
        a_j = 0.5 * (p01 - p00 + p11 - p10) / (ju - jl) if ju > jl else 0.0
        # f - a_i x_i - a_j x_j over the sub-box in Bernstein form: degree elevation of the linear part.
        lo, hi = np.inf, -np.inf
        for p in range(di + 1):
            for q in range(dj + 1):
                xl, xu = _mix(il, iu, p, di)
                yl, yu = _mix(jl, ju, q, dj)
                sl, su = scale(a_i, xl, xu)
                vl, vu = scale(a_j, yl, yu)
                sl, su = add(sl, su, vl, vu)
                k = p * (dj + 1) + q
                cl, cu = sub(low[k], high[k], sl, su)
                lo, hi = min(lo, cl), max(hi, cu)
        for below in (True, False):
            value[t], value[t + 1], value[t + 2] = 1.0, -a_i, -a_j
            row_lower[r] = lo if below else -np.inf
            row_upper[r] = np.inf if below else hi
            t, r = t + 3, r + 1


@jit
def _mix(a, b, p, d):  # type: ignore[no-untyped-def]
    """Enclosure of a + (p / d)(b - a), the abscissa of control point p (paper, equation 33)."""
    if d == 0:
        return a, b
    al, au = mul(float(d - p), float(d - p), a, a)
    bl, bu = mul(float(p), float(p), b, b)
    al, au = add(al, au, bl, bu)
    return down(al / d), up(au / d)
