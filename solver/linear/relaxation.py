"""The linear relaxation of a system over a box: triangles, tetrahedra and convex hulls (paper, section 4.3).

Each row is valid in exact arithmetic for the coefficients as rounded: what rounding might cut off is given
back on the right-hand side. Linear rows and those of products, cosines and sines are as many in every box.
Hulls have a row for each facet that they have there; every facet has a name, so that a basis carries over
from box to box.
"""

from typing import NamedTuple

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array, Indices, offsets
from ..enclosure import control_points, workspace
from ..interval import Interval, add, down, mul, scale, sqr, sub, up
from ..polynomial import CanonicalForm, Functions, Rows
from .bernstein_hull import count_triangles, lower_facets
from .trig_rows import ROWS_PER_TRIG, trig_rows

__all__ = ["Relaxation", "RelaxedBox"]

# Sides of a box narrower than this: a function is flat along them, and rises over them are mere rounding.
_NARROW = 1e-9


class RelaxedBox(NamedTuple):
    """Rows lower <= A x <= upper that hold at every solution within a box.

    Attributes:
        rows: the linear rows, four rows of each product, four of each cosine and sine, and one of each facet
            of the Bernstein functions' hulls.
        names: (n_rows,) of the rows, below `Relaxation.n_names`. A facet is named by its function, its side
            and where on the net it lies.
    """

    rows: Rows
    names: Indices


class Relaxation:
    """The relaxation of one canonical form.

    Attributes:
        n_names: names of rows that there are; the first `n_fixed` of them are in every box.
        n_fixed: linear rows and rows of products, cosines and sines.
    """

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
        # Behind all of those, where the rows and the entries of cosines and sines begin.
        self._first_trig = sum(map(len, counts)), sum(map(len, columns))
        counts.append(np.full(ROWS_PER_TRIG * len(form.trig.ki), 2))
        columns.append(np.repeat(form.trig.ki, ROWS_PER_TRIG, axis=0).ravel())
        self._start = offsets(np.concatenate(counts))
        self._column = np.concatenate(columns).astype(np.int64)
        self.n_fixed = len(self._start) - 1
        self._functions = _at_least_linear(form.functions)
        # Function by function, a name for each half of each cell of its net, below and then above.
        one_side = [count_triangles(di, dj) for di, dj in self._functions.degree.tolist()]
        self._owner = np.repeat(np.arange(len(one_side)), 2 * np.array(one_side, dtype=np.int64))
        self.n_names = self.n_fixed + len(self._owner)
        self._rises = np.zeros((max(one_side, default=0), 2))
        self._work = workspace(self._functions.degree)

    def build(self, lower: Array, upper: Array) -> RelaxedBox:
        """The relaxation over the box [lower, upper] (n,)."""
        linear = self.form.rows
        value = np.empty(len(self._column))
        value[: len(linear.value)] = linear.value
        sides = np.empty((2, self.n_fixed))
        sides[:, : self.n_linear] = linear.lower, linear.upper
        _product_rows(
            lower, upper, self.form.products, self.n_linear, len(linear.value), value, (sides[0], sides[1])
        )
        if len(self.form.trig.ki):
            trig_rows(lower, upper, self.form.trig, *self._first_trig, value, (sides[0], sides[1]))
        slopes, facet_sides = np.empty((len(self._owner), 2)), np.empty((2, len(self._owner)))
        _facet_rows(
            lower, upper, self._functions, slopes, (facet_sides[0], facet_sides[1]), self._work, self._rises
        )
        facets = np.flatnonzero(~np.isnan(slopes[:, 0]))
        rows = Rows(
            np.concatenate([self._start, self._start[-1] + 3 * np.arange(1, len(facets) + 1)]),
            np.concatenate([self._column, self._functions.kij[self._owner[facets]].ravel()]),
            np.concatenate([value, np.insert(-slopes[facets], 0, 1.0, axis=1).ravel()]),
            *np.concatenate([sides, facet_sides[:, facets]], axis=1),
        )
        return RelaxedBox(rows, np.concatenate([np.arange(self.n_fixed), self.n_fixed + facets]))


def _at_least_linear(functions: Functions) -> Functions:
    """The same functions; what does not depend on a parameter is written with degree 1 in it."""
    nets = []
    for (di, dj), start in zip(functions.degree, functions.start, strict=True):
        net = functions.coefficients[start : start + (di + 1) * (dj + 1)].reshape(di + 1, dj + 1)
        net = np.repeat(net, 2 if di == 0 else 1, axis=0)
        nets.append(np.repeat(net, 2 if dj == 0 else 1, axis=1).ravel())
    return Functions(
        functions.kij,
        np.maximum(functions.degree, 1),
        offsets([len(net) for net in nets])[:-1],
        np.concatenate([*nets, np.zeros(0)]),
    )


@compiled
def _product_rows(
    lower: Array, upper: Array, products: Indices, r: int, t: int, value: Array, sides: Interval
) -> None:
    """Fills rows from number r on, entries from number t on, over the box [lower, upper]."""
    row_lower, row_upper = sides
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


@compiled
def _facet_rows(
    lower: Array,
    upper: Array,
    functions: Functions,
    slopes: Array,
    sides: Interval,
    work: Array,
    rises: Array,
) -> None:
    """By name of the facet: slopes (n, 2), NaN where there is none, and sides of x_k - a_i x_i - a_j x_j."""
    kij, degree, start, coefficients = functions
    row_lower, row_upper = sides
    row_lower[:], row_upper[:] = -np.inf, np.inf
    first = 0
    for f in range(len(kij)):
        _, i, j = kij[f]
        di, dj = degree[f]
        b = coefficients[start[f] : start[f] + (di + 1) * (dj + 1)]
        low, high = control_points(b, di, dj, lower[i], upper[i], lower[j], upper[j], work)
        xl, xu = _abscissas(lower[i], upper[i], di)
        yl, yu = _abscissas(lower[j], upper[j], dj)
        per_i = di / (upper[i] - lower[i]) if upper[i] - lower[i] > _NARROW else 0.0
        per_j = dj / (upper[j] - lower[j]) if upper[j] - lower[j] > _NARROW else 0.0
        n = count_triangles(di, dj)
        for sign in (1.0, -1.0):
            lower_facets(sign * low, di, dj, rises)
            for t in range(n):
                a_i, a_j = sign * rises[t, 0] * per_i, sign * rises[t, 1] * per_j
                slopes[first + t, 0], slopes[first + t, 1] = np.nan, np.nan
                if not np.isfinite(a_i + a_j):
                    continue
                slopes[first + t, 0], slopes[first + t, 1] = a_i, a_j
                lo, hi = _beside_plane(low, high, xl, xu, yl, yu, a_i, a_j)
                if sign > 0.0:
                    row_lower[first + t] = lo
                else:
                    row_upper[first + t] = hi
            first += n


@compiled
def _beside_plane(
    low: Array, high: Array, xl: Array, xu: Array, yl: Array, yu: Array, a_i: float, a_j: float
) -> tuple[float, float]:
    """Bounds of f - a_i x_i - a_j x_j: its control points are those of f less the plane's values there."""
    least, most = np.inf, -np.inf
    k = 0
    for p in range(len(xl)):
        ul, uu = scale(a_i, xl[p], xu[p])
        for q in range(len(yl)):
            vl, vu = scale(a_j, yl[q], yu[q])
            vl, vu = add(ul, uu, vl, vu)
            vl, vu = sub(low[k], high[k], vl, vu)
            least, most = min(least, vl), max(most, vu)
            k += 1
    return least, most


@compiled
def _abscissas(a: float, b: float, d: int) -> tuple[Array, Array]:
    """Enclosures (d + 1,) of a + (p / d)(b - a), where control points p stand (paper, equation 33)."""
    low, high = np.empty(d + 1), np.empty(d + 1)
    for p in range(d + 1):
        al, au = mul(float(d - p), float(d - p), a, a)
        bl, bu = mul(float(p), float(p), b, b)
        al, au = add(al, au, bl, bu)
        low[p], high[p] = down(al / d), up(au / d)
    return low, high
