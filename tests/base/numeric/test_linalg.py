"""Small dense systems against numpy."""

import numpy as np
import pytest
from holdfast.base.numeric.linalg import damped_step, largest_row, square_inverse


@pytest.mark.parametrize(("m", "n"), [(0, 4), (1, 1), (3, 7), (8, 8), (16, 27)])
def test_steps_are_of_least_norm(m: int, n: int) -> None:
    rng = np.random.default_rng(m)
    A, r, step = rng.normal(size=(m, n)), rng.normal(size=m), np.full(n, np.nan)
    damped_step(A, r, 0.0, step)
    assert step == pytest.approx(np.linalg.lstsq(A, -r, rcond=None)[0], abs=1e-9)


@pytest.mark.parametrize("damping", [1e-6, 1e-2, 10.0])
def test_damping_makes_the_levenberg_marquardt_step(damping: float) -> None:
    rng = np.random.default_rng(1)
    A, r, step = rng.normal(size=(6, 9)), rng.normal(size=6), np.empty(9)
    damped_step(A, r, damping, step)
    assert step == pytest.approx(-np.linalg.solve(A.T @ A + damping * np.eye(9), A.T @ r), abs=1e-8)


def test_rows_that_depend_on_each_other_do_no_harm() -> None:
    """Newton's steps still meet all rows, for they agree."""
    rng = np.random.default_rng(2)
    A = rng.normal(size=(4, 9))
    A[3] = A[0] - 2.0 * A[1]
    x, target = np.zeros(9), A @ rng.normal(size=9)
    step = np.empty(9)
    for _ in range(5):
        damped_step(A, A @ x - target, 1e-14 * largest_row(A), step)
        x += step
    assert A @ x == pytest.approx(target, abs=1e-10)
    assert x == pytest.approx(np.linalg.pinv(A) @ target, abs=1e-6)


def test_no_rows_or_nothing_but_zeros_make_no_step() -> None:
    step = np.full(3, np.nan)
    damped_step(np.zeros((2, 3)), np.ones(2), 0.0, step)
    assert np.array_equal(step, np.zeros(3))


def test_largest_row() -> None:
    assert largest_row(np.array([[3.0, 4.0], [1.0, 1.0]])) == 25.0
    assert largest_row(np.zeros((0, 2))) == 0.0


@pytest.mark.parametrize(("m", "n"), [(1, 3), (4, 4), (6, 11)])
def test_square_part_is_inverted(m: int, n: int) -> None:
    J = np.random.default_rng(n).normal(size=(m, n))
    rows, columns, Y = np.empty(m, dtype=np.int64), np.empty(m, dtype=np.int64), np.empty((m, m))
    assert square_inverse(J, np.ones(n), rows, columns, Y)
    assert len(set(columns.tolist())) == m
    assert Y @ J[:, columns] == pytest.approx(np.eye(m), abs=1e-10)


def test_a_singular_matrix_has_no_inverse() -> None:
    J = np.outer(np.arange(1.0, 4.0), np.arange(1.0, 6.0))
    rows, columns, Y = np.empty(3, dtype=np.int64), np.empty(3, dtype=np.int64), np.empty((3, 3))
    assert not square_inverse(J, np.ones(5), rows, columns, Y)
