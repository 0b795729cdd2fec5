"""The canonical form of a system: linear rows, products and functions (paper, section 4.1)."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, TypeAlias

import numpy as np

from ...base.numeric.arrays import Array, Indices, offsets
from ..interval import mul, sqr
from .polynomial import Monomial, Polynomial
from .system import BernsteinFunction, PolynomialSystem, TrigFunction, bounds_itself

__all__ = [
    "CanonicalForm",
    "Functions",
    "Rows",
    "TrigFunctions",
    "canonical_form",
    "count_products",
    "pack_trig",
]

# Redundant equations follow from the others only up to the rounding of their coefficients (lengths of unit
# vectors, nets that are flat to their last decimal), so they are asked for to within this share of their
# coefficients: a row that must be zero to the last bit would cut off true solutions.
_REDUNDANT_ROOM = 1e-12
# What is left of a constant equation where all terms cancel is no contradiction below this.
_CONSTANT_ROUNDING = 1e-9

_Row: TypeAlias = tuple[dict[int, float], float, float]  # entries by column, lower, upper


class Rows(NamedTuple):
    """Linear rows lower <= A x <= upper, A by rows (start, column, value)."""

    start: Indices
    column: Indices
    value: Array
    lower: Array
    upper: Array


class Functions(NamedTuple):
    """Bernstein functions x_k = f(x_i, x_j), their coefficients one after another.

    Attributes:
        kij: (m, 3) indices.
        degree: (m, 2).
        start: (m,) where each function's coefficients begin.
        coefficients: all coefficients, row by row.
    """

    kij: Indices
    degree: Indices
    start: Indices
    coefficients: Array


class TrigFunctions(NamedTuple):
    """x_k = cos or sin of (ratio x_i + offset).

    Attributes:
        ki: (m, 2) indices.
        kind: (m,) `COSINE` or `SINE`.
        ratio: (m,) above zero.
        offset: (m,) in rad.
    """

    ki: Indices
    kind: Indices
    ratio: Array
    offset: Array


@dataclass(frozen=True, eq=False)
class CanonicalForm:
    """A system as Lambda(x) = 0 and psi(x) = 0 (paper, equations 29-32).

    Attributes:
        lower: (n,) initial box; the system's variables come first, products follow.
        upper: (n,) initial box.
        rows: linear equations and inequalities.
        products: (m, 3) x_k = x_i x_j with i <= j, squares where i == j.
        functions: Bernstein functions.
        trig: cosines and sines, of which the paper has none.
    """

    lower: Array
    upper: Array
    rows: Rows
    products: Indices
    functions: Functions
    trig: TrigFunctions

    @property
    def size(self) -> int:
        """Number of columns."""
        return len(self.lower)

    @cached_property
    def factors(self) -> Indices:
        """(m, 2) columns on which each product and function rests; twice the same one for a square or cosine.

        Products come first, then Bernstein functions, then cosines and sines.
        """
        return np.concatenate([self.products[:, 1:], self.functions.kij[:, 1:], self.trig.ki[:, [1, 1]]])


class _Products:
    """Columns for monomials; a product that occurs twice is one column."""

    def __init__(self, lower: Array, upper: Array):
        self.lower = list(lower)
        self.upper = list(upper)
        self.triples: list[tuple[int, int, int]] = []
        self._known: dict[tuple[int, int], int] = {}

    def column(self, monomial: Monomial) -> int:
        k = monomial[0]
        # Pairs first, so that x^4 becomes the square of x^2.
        if len(monomial) > 1:
            half = len(monomial) // 2
            k = self._pair(self.column(monomial[:half]), self.column(monomial[half:]))
        return k

    def _pair(self, i: int, j: int) -> int:
        i, j = min(i, j), max(i, j)
        if (i, j) not in self._known:
            if i == j:
                lo, hi = sqr(self.lower[i], self.upper[i])
            else:
                lo, hi = mul(self.lower[i], self.upper[i], self.lower[j], self.upper[j])
            self.lower.append(lo)
            self.upper.append(hi)
            self._known[i, j] = len(self.lower) - 1
            self.triples.append((self._known[i, j], i, j))
        return self._known[i, j]


def count_products(rows: Iterable[Polynomial]) -> int:
    """How many products the canonical form of these polynomials has."""
    rows = list(rows)
    size = 1 + max((i for row in rows for i in row.variables), default=-1)
    products = _Products(np.zeros(size), np.zeros(size))
    for row in rows:
        _row(row, products, equality=True)
    return len(products.triples)


def canonical_form(system: PolynomialSystem) -> CanonicalForm:
    """Expands a system to its canonical form.

    A definition that nothing uses has no row: its column stands alone. Without variables there is one column,
    for rows that are false need one.
    """
    none = np.zeros(0 if system.size else 1)
    products = _Products(np.append(system.lower, none), np.append(system.upper, none))
    rows: list[_Row] = []
    functions: list[tuple[int, BernsteinFunction]] = []
    trig: list[tuple[int, TrigFunction]] = []
    used = _used(system)
    for k, value in system.definitions.items():
        if isinstance(value, BernsteinFunction):
            functions.append((k, value))
        elif isinstance(value, TrigFunction):
            trig.append((k, value))
        elif k in used or not bounds_itself(k, value, system.lower, system.upper):
            rows.append(_row(value - Polynomial.variable(k), products, equality=True))
    rows.extend(_row(value, products, equality=True) for value in system.equations)
    for value in system.redundant:
        if value.degree == 0:
            continue  # zero but for the rounding of what cancelled in it
        room = _REDUNDANT_ROOM * sum(abs(c) for c in value.terms.values())
        entries, lower, upper = _row(value, products, equality=True)
        rows.append((entries, lower - room, upper + room))
    rows.extend(_row(value, products, equality=False) for value in system.inequalities)
    return _assemble(products, rows, functions, trig)


def _used(system: PolynomialSystem) -> set[int]:
    """The variables on which some equation or inequality rests, directly or by definitions."""
    rows = (*system.equations, *system.redundant, *system.inequalities)
    used = {i for row in rows for i in row.variables}
    for k, value in reversed(system.definitions.items()):
        if (
            not isinstance(value, Polynomial)
            or k in used
            or not bounds_itself(k, value, system.lower, system.upper)
        ):
            used |= value.variables
    return used


def _assemble(
    products: _Products,
    rows: list[_Row],
    functions: list[tuple[int, BernsteinFunction]],
    trig: list[tuple[int, TrigFunction]],
) -> CanonicalForm:
    return CanonicalForm(
        np.array(products.lower),
        np.array(products.upper),
        _pack_rows([_with_a_column(row) for row in rows if row[0] or _excludes_zero(row)]),
        np.array(products.triples, dtype=np.int64).reshape(-1, 3),
        _pack_functions(functions),
        pack_trig(trig),
    )


def _excludes_zero(row: _Row) -> bool:
    """Whether a row without columns is false, by more than the rounding of what cancelled in it."""
    return row[1] > _CONSTANT_ROUNDING or row[2] < -_CONSTANT_ROUNDING


def _with_a_column(row: _Row) -> _Row:
    """The row itself; a constant one, such as 1 = 0, becomes 0 x_0 = 1, which no box satisfies."""
    entries, lower, upper = row
    return (entries or {0: 0.0}), lower, upper


def _row(value: Polynomial, products: _Products, *, equality: bool) -> _Row:
    """The row sum a_j x_j = b, or >= b, of a polynomial that is zero, or at least zero."""
    entries: dict[int, float] = {}
    constant = 0.0
    for monomial, coefficient in value.terms.items():
        if monomial:
            entries[products.column(monomial)] = coefficient
        else:
            constant = coefficient
    return entries, -constant, -constant if equality else np.inf


def _pack_rows(rows: list[_Row]) -> Rows:
    lengths = [len(entries) for entries, _, _ in rows]
    return Rows(
        offsets(lengths),
        np.array([j for entries, _, _ in rows for j in entries], dtype=np.int64),
        np.array([a for entries, _, _ in rows for a in entries.values()], dtype=np.float64),
        np.array([lower for _, lower, _ in rows], dtype=np.float64),
        np.array([upper for _, _, upper in rows], dtype=np.float64),
    )


def _pack_functions(functions: list[tuple[int, BernsteinFunction]]) -> Functions:
    sizes = [f.coefficients.size for _, f in functions]
    return Functions(
        np.array([(k, f.i, f.j) for k, f in functions], dtype=np.int64).reshape(-1, 3),
        np.array([np.subtract(f.coefficients.shape, 1) for _, f in functions], dtype=np.int64).reshape(-1, 2),
        offsets(sizes)[:-1],
        np.concatenate([f.coefficients.ravel() for _, f in functions]) if sizes else np.zeros(0),
    )


def pack_trig(trig: Sequence[tuple[int, TrigFunction]]) -> TrigFunctions:
    """Functions, each with its variable, as compiled loops take them."""
    return TrigFunctions(
        np.array([(k, f.i) for k, f in trig], dtype=np.int64).reshape(-1, 2),
        np.array([f.kind for _, f in trig], dtype=np.int64),
        np.array([f.ratio for _, f in trig], dtype=np.float64),
        np.array([f.offset for _, f in trig], dtype=np.float64),
    )
