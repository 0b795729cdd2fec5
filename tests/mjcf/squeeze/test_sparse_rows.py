"""Matrices by their entries that are not zero are what numpy makes of the whole ones."""

import numpy as np
import pytest
from holdfast.mjcf.squeeze.sparse_rows import SparseRows
from scipy.sparse import csr_array


def whole(rows: SparseRows) -> np.ndarray:
    """With its zeros, by another library."""
    shape = (len(rows), rows.n_columns)
    return csr_array((rows.values, rows.columns, rows.starts), shape=shape).toarray()


def matrix(m: int, n: int, seed: int = 0) -> np.ndarray:
    """Some numbers, two thirds of them zero."""
    rng = np.random.default_rng(seed)
    return rng.normal(size=(m, n)) * (rng.random((m, n)) < 1.0 / 3.0)


@pytest.mark.parametrize("shape", [(4, 7), (3, 1), (0, 5)])
def test_the_same_matrix(shape: tuple[int, int]) -> None:
    A = matrix(*shape)
    rows = SparseRows.of(A)
    assert np.array_equal(whole(rows), A)
    assert len(rows) == len(A) and (rows.values != 0.0).all()


@pytest.mark.parametrize("count", [1, 3])
def test_blocks_along_the_diagonal(count: int) -> None:
    A = matrix(4, 5)
    assert np.array_equal(whole(SparseRows.of(A).along_diagonal(count)), np.kron(np.eye(count), A))


def test_matrices_beside_each_other_and_stacked() -> None:
    A, B, C = matrix(4, 5, 1), matrix(4, 2, 2), matrix(3, 7, 3)
    joined = SparseRows.stacked(SparseRows.of(A).beside(SparseRows.of(B)), SparseRows.of(C))
    assert np.array_equal(whole(joined), np.vstack([np.column_stack([A, B]), C]))
