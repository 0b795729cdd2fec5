"""The linear relaxation of a system over a box, and what multipliers of its rows prove."""

import math
from dataclasses import dataclass

import numpy as np

from ..base.numeric.arrays import Array, Indices
from .box import Box
from .intervals import down, mul, up
from .system import LoggedSystem

__all__ = ["Inequalities", "Planes", "bound", "relax"]


@dataclass(frozen=True, eq=False)
class Planes:
    """Slopes of planes beside functions, as a log chooses them; any slopes do.

    Beside a cosine or sine, which has one variable, only the first slope counts.

    Attributes:
        function: (m,) numbers of the functions, which may repeat.
        a_i: (m,) slopes along their first parameters.
        a_j: (m,) slopes along their second parameters.
    """

    function: Indices
    a_i: Array
    a_j: Array


@dataclass(frozen=True, eq=False)
class Inequalities:
    """Rows lower <= sum of value * x_column <= upper, their entries in any order."""

    row: Indices
    column: Indices
    value: Array
    lower: Array
    upper: Array


class _Rows:
    """Rows in the making, at first without sides."""

    def __init__(self, n_rows: int):
        self.lower, self.upper = np.full(n_rows, -np.inf), np.full(n_rows, np.inf)
        self._entries: list[tuple[Indices, Indices, Array]] = []

    def put(self, row: Indices, column: Indices, value: Array) -> None:
        self._entries.append((row, column, value))

    def plane(self, row: Indices, k: Indices, i: Indices, a_i: Array, j: Indices, a_j: Array) -> None:
        """x_k - a_i x_i - a_j x_j in the given rows."""
        for column, value in ((k, np.ones(len(k))), (i, -a_i), (j, -a_j)):
            self.put(row, column, value)

    @property
    def finished(self) -> Inequalities:
        row, column, value = (np.concatenate(part) for part in zip(*self._entries, strict=True))
        return Inequalities(row.astype(np.int64), column.astype(np.int64), value, self.lower, self.upper)


def relax(system: LoggedSystem, box: Box, planes: Planes) -> Inequalities:
    """Linear inequalities that hold at every solution in the box: rows, those of products, planes."""
    rows = _Rows(system.n_fixed + len(planes.function))
    rows.lower[: system.n_linear], rows.upper[: system.n_linear] = system.row_lower, system.row_upper
    r, t = np.nonzero(system.values)
    rows.put(r, system.columns[r, t], system.values[r, t])
    _relax_squares(system, box, rows)
    _relax_products(system, box, rows)
    _relax_bernstein(system, box, planes, rows)
    _relax_trig(system, box, planes, rows)
    return rows.finished


def _relax_squares(system: LoggedSystem, box: Box, rows: _Rows) -> None:
    """Three tangents and the chord."""
    k, i, _ = system.squares
    none = np.zeros(len(k))
    a, b = box.lower[i], box.upper[i]
    for number, x in enumerate((a, b, 0.5 * (a + b))):  # tangents: (x_i - x)^2 >= 0
        rows.plane(system.square_rows + number, k, i, 2.0 * x, i, none)
        rows.lower[system.square_rows + number] = down(-(x * x))
    slope = a + b  # the chord: (x_i - a)(x_i - b) <= 0, with room for the rounding of the slope
    room = up(up(up(slope) - down(slope)) * np.maximum(np.abs(a), np.abs(b)))
    rows.plane(system.square_rows + 3, k, i, slope, i, none)
    rows.upper[system.square_rows + 3] = up(up(-(a * b)) + room)


def _relax_products(system: LoggedSystem, box: Box, rows: _Rows) -> None:
    """The four faces of the tetrahedron."""
    k, i, j = system.others
    il, iu, jl, ju = box.lower[i], box.upper[i], box.lower[j], box.upper[j]
    for number, (a, b) in enumerate(((il, jl), (iu, ju))):  # (x_i - a)(x_j - b) >= 0
        rows.plane(system.other_rows + number, k, i, b, j, a)
        rows.lower[system.other_rows + number] = down(-(a * b))
    for number, (a, b) in enumerate(((iu, jl), (il, ju)), start=2):  # (x_i - a)(x_j - b) <= 0
        rows.plane(system.other_rows + number, k, i, b, j, a)
        rows.upper[system.other_rows + number] = up(-(a * b))


def _relax_bernstein(system: LoggedSystem, box: Box, planes: Planes, rows: _Rows) -> None:
    """Both sides of each plane, moved until all control points lie between them."""
    bernstein = np.flatnonzero(planes.function < system.n_bernstein)
    for g, group in enumerate(system.groups):
        of_group = bernstein[system.group_of[planes.function[bernstein]] == g]
        if not len(of_group):
            continue
        which = system.place_of[planes.function[of_group]]
        a_i, a_j = planes.a_i[of_group], planes.a_j[of_group]
        row = system.n_fixed + of_group
        rows.lower[row], rows.upper[row] = group.beside_planes(box, which, a_i, a_j)
        rows.plane(row, group.k[which], group.i[which], a_i, group.j[which], a_j)


def _relax_trig(system: LoggedSystem, box: Box, planes: Planes, rows: _Rows) -> None:
    """Both sides of each line beside a cosine or sine."""
    for plane in np.flatnonzero(planes.function >= system.n_bernstein).tolist():
        function = system.trig[planes.function[plane] - system.n_bernstein]
        slope, a, b = planes.a_i[plane], box.lower[function.i], box.upper[function.i]
        row = system.n_fixed + plane
        rows.lower[row], rows.upper[row] = function.beside_line(float(slope), float(a), float(b))
        at = np.full(2, row)
        rows.put(at, np.array([function.k, function.i]), np.array([1.0, -slope]))


def bound(rows: Inequalities, duals: Array, column: int | None, sign: float, box: Box) -> float:
    """A lower bound on sign * x_column over the rows and the box, or on zero where no column is given.

    For every y: c . x = y . (A x) + (c - A^T y) . x; a bound above zero on zero shows that there is no x.
    """
    n = len(box.lower)
    side = np.where(duals > 0.0, rows.lower, rows.upper)
    duals = np.where(np.isfinite(side), duals, 0.0)  # that side is missing
    used = np.flatnonzero(duals[rows.row])
    at, products = rows.column[used], duals[rows.row[used]] * rows.value[used]
    cost = np.zeros(n)
    if column is not None:
        cost[column] = sign
    reduced = cost - np.bincount(at, products, n)
    # A sum of m rounded products is off by less than m 2^-53 of the sum of their sizes, to first order,
    # and m underflows; twice that covers the rest.
    m = np.bincount(at, minlength=n) + 2.0
    error = m * 2.0**-52 * (np.abs(cost) + np.bincount(at, np.abs(products), n)) + m * 1e-300
    terms, _ = mul(down(reduced - error), up(reduced + error), box.lower, box.upper)
    y = np.flatnonzero(duals)
    terms = np.concatenate([terms, down(duals[y] * side[y])])
    # The sum is rounded once. Terms so large that it might overflow prove nothing.
    return float(down(math.fsum(terms))) if np.all(np.abs(terms) < 1e300) else -np.inf
