"""Rows of a linear program by the entries that are not zero.

Most of a squeeze's rows concern one direction of gravity alone: as whole matrices they would be nine tenths
zeros, and to write these down took longer than to solve the program. SciPy's sparse arrays, which check all
that they are given, take ten times as long for matrices of this size.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array

__all__ = ["SparseRows"]


@dataclass(frozen=True, eq=False)
class SparseRows:
    """A matrix (m, n), row by row; columns go up within a row, and no value is zero.

    Attributes:
        starts: where each row begins, and the last one ends (m + 1,).
        columns: of each entry.
        values: of each entry.
        n_columns: n.
    """

    starts: NDArray[np.int32]
    columns: NDArray[np.int32]
    values: Array
    n_columns: int

    @classmethod
    def of(cls, matrix: Array) -> "SparseRows":
        """Those of a matrix (m, n)."""
        return cls(*_by_rows(np.ascontiguousarray(matrix, dtype=float)), matrix.shape[1])

    @classmethod
    def stacked(cls, *parts: "SparseRows") -> "SparseRows":
        """Matrices of as many columns below each other, at least one."""
        ends = np.cumsum([0] + [part.starts[-1] for part in parts])
        starts = [part.starts[:-1] + end for part, end in zip(parts, ends[:-1], strict=True)]
        return cls(
            np.concatenate([*starts, ends[-1:]]).astype(np.int32),
            np.concatenate([part.columns for part in parts]),
            np.concatenate([part.values for part in parts]),
            parts[0].n_columns,
        )

    def __len__(self) -> int:
        return len(self.starts) - 1

    def along_diagonal(self, count: int) -> "SparseRows":
        """A matrix (count m, count n) with this one so many times along its diagonal, at least once."""
        steps = np.arange(count, dtype=np.int32)[:, None]
        starts = (self.starts[:-1] + steps * self.starts[-1]).ravel()
        return SparseRows(
            np.append(starts, np.int32(count * self.starts[-1])),
            (self.columns + steps * np.int32(self.n_columns)).ravel(),
            np.tile(self.values, count),
            count * self.n_columns,
        )

    def beside(self, right: "SparseRows") -> "SparseRows":
        """A matrix (m, n + k) with another one (m, k) to the right of this one."""
        left = (self.starts, self.columns, self.values, self.n_columns)
        entries = _beside(*left, right.starts, right.columns, right.values)
        return SparseRows(*entries, self.n_columns + right.n_columns)


@compiled
def _by_rows(A: Array) -> tuple[NDArray[np.int32], NDArray[np.int32], Array]:
    """Where each row's entries start (m + 1,), and columns and values of all that are not zero."""
    m, n = A.shape
    starts = np.zeros(m + 1, dtype=np.int32)
    for i in range(m):
        count = 0
        for j in range(n):
            count += A[i, j] != 0.0
        starts[i + 1] = starts[i] + count
    columns, values = np.empty(starts[m], dtype=np.int32), np.empty(starts[m])
    k = 0
    for i in range(m):
        for j in range(n):
            if A[i, j] != 0.0:
                columns[k], values[k] = j, A[i, j]
                k += 1
    return starts, columns, values


@compiled
def _beside(
    starts: NDArray[np.int32],
    columns: NDArray[np.int32],
    values: Array,
    shift: int,
    right_starts: NDArray[np.int32],
    right_columns: NDArray[np.int32],
    right_values: Array,
) -> tuple[NDArray[np.int32], NDArray[np.int32], Array]:
    """Rows of two matrices joined; the right one's columns move by `shift`."""
    out_starts = starts + right_starts
    out_columns = np.empty(len(columns) + len(right_columns), dtype=np.int32)
    out_values = np.empty(len(out_columns))
    k = 0
    for i in range(len(starts) - 1):
        for j in range(starts[i], starts[i + 1]):
            out_columns[k], out_values[k] = columns[j], values[j]
            k += 1
        for j in range(right_starts[i], right_starts[i + 1]):
            out_columns[k], out_values[k] = right_columns[j] + shift, right_values[j]
            k += 1
    return out_starts, out_columns, out_values
