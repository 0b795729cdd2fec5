"""The system that a log refutes."""

from typing import Any

import numpy as np

from ..base.numeric.arrays import Array, Indices
from .bernstein import BernsteinGroup
from .box import Box
from .reading import Rejected, indices, items, numbers
from .trig import TrigFunction

__all__ = ["LoggedSystem"]


_HIGHEST_DEGREE = 40
# Rows are filled up to the longest of them.
_MOST_ENTRIES = 4_000_000


class LoggedSystem:
    """Linear rows, products x_k = x_i x_j and functions over a box, as a log writes them.

    Functions are Bernstein functions first, and then cosines and sines.

    Raises:
        Rejected: the data are no such system.
    """

    def __init__(self, data: Any):
        if not isinstance(data, dict):
            raise Rejected("the system is missing")
        self.box = Box(numbers(data.get("lower")), numbers(data.get("upper")))
        n = self.n = len(self.box.lower)
        if len(self.box.upper) != n:
            raise Rejected("the initial box has a side too few")
        self._read_rows(items(data.get("rows")))
        triples = [indices(triple, n, 3) for triple in items(data.get("products"))]
        self.products = np.array(triples, dtype=np.int64).reshape(-1, 3)
        is_square = self.products[:, 1] == self.products[:, 2]
        self.squares, self.others = self.products[is_square].T, self.products[~is_square].T
        # Rows of the relaxation: the linear ones, 4 for a product, then planes of functions.
        first = self.n_linear + 4 * np.arange(len(self.products), dtype=np.int64)
        self.square_rows, self.other_rows = first[is_square], first[~is_square]
        self.n_fixed = self.n_linear + 4 * len(self.products)
        self._read_functions(items(data.get("functions")))
        self.trig = [self._trig_function(items(f, 5)) for f in items(data.get("trig", []))]
        factors = [
            self.products[:, 1:].ravel(), *(f.i for f in self.groups), *(f.j for f in self.groups),
            np.array([f.i for f in self.trig]),
        ]  # fmt: skip
        self.factors = np.unique(np.concatenate(factors)).astype(np.int64)

    def _read_rows(self, rows: list[Any]) -> None:
        self.n_linear = len(rows)
        longest = max((len(items(items(row, 4)[0])) for row in rows), default=0)
        if self.n_linear * longest > _MOST_ENTRIES:
            raise Rejected(f"the system is too large: {self.n_linear} rows, the longest of {longest} entries")
        self.columns = np.zeros((len(rows), longest), dtype=np.int64)
        self.values = np.zeros((len(rows), longest))
        self.row_lower, self.row_upper = np.full(len(rows), -np.inf), np.full(len(rows), np.inf)
        for r, (columns, values, lower, upper) in enumerate(rows):
            self.columns[r, : len(columns)] = indices(columns, self.n)
            self.values[r, : len(columns)] = numbers(values, len(columns))
            if lower is not None:
                self.row_lower[r] = numbers([lower])[0]
            if upper is not None:
                self.row_upper[r] = numbers([upper])[0]

    def _read_functions(self, functions: list[Any]) -> None:
        """Groups the functions by their degrees."""
        found: dict[tuple[int, int], list[tuple[int, Indices, Array]]] = {}
        for number, function in enumerate(functions):
            kij, degrees, coefficients = items(function, 3)
            di, dj = indices(degrees, _HIGHEST_DEGREE + 1, 2).tolist()
            net = numbers(coefficients, (di + 1) * (dj + 1)).reshape(di + 1, dj + 1)
            found.setdefault((di, dj), []).append((number, indices(kij, self.n, 3), net))
        self.groups = [
            BernsteinGroup([f[1] for f in group], [f[2] for f in group]) for group in found.values()
        ]
        self.n_bernstein = len(functions)
        # Of each function: its group, and which one it is there.
        self.group_of, self.place_of = np.zeros((2, self.n_bernstein), dtype=np.int64)
        for g, group in enumerate(found.values()):
            members = [f[0] for f in group]
            self.group_of[members], self.place_of[members] = g, np.arange(len(members))

    def _trig_function(self, data: list[Any]) -> TrigFunction:
        """The function `[k, i, kind, ratio, offset]`, kind 0 being a cosine and 1 a sine."""
        (k, i), (kind,) = indices(data[:2], self.n, 2).tolist(), indices(data[2:3], 2, 1).tolist()
        ratio, offset = numbers(data[3:], 2).tolist()
        if not ratio > 0.0:
            raise Rejected("the ratio of a cosine or sine is not above zero")
        return TrigFunction(k, i, kind == 1, ratio, offset)

    @property
    def n_functions(self) -> int:
        """Number of functions of all kinds."""
        return self.n_bernstein + len(self.trig)
