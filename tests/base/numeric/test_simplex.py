"""The small simplex method agrees with HiGHS, and its dual values prove its optimum."""

import numpy as np
import pytest
from holdfast.base.numeric.simplex import Tableau, feasible_basis, minimise
from scipy.optimize import linprog

Array = np.ndarray


def random_program(rng: np.random.Generator) -> tuple[Array, Array, Array, Array]:
    """A, b >= 0, upper bounds and cost; feasible in about half of the cases."""
    rows, columns = int(rng.integers(1, 7)), int(rng.integers(1, 20))
    A = rng.integers(-3, 4, (rows, columns)) * rng.choice([0.5, 1.0, 3.7], (rows, columns))
    upper = np.where(rng.uniform(size=columns) < 0.5, rng.uniform(0.0, 2.0, columns), np.inf)
    inside = A @ np.minimum(rng.uniform(0.0, 1.0, columns), upper)
    b = np.where(rng.uniform() < 0.5, inside, rng.uniform(-3.0, 3.0, rows))
    flip = np.where(b < 0.0, -1.0, 1.0)
    return A * flip[:, None], b * flip, upper, rng.normal(size=columns)


def solve(A: Array, b: Array, upper: Array, cost: Array) -> tuple[float, float, Array]:
    """Infeasibility left, optimum and dual values."""
    rows, columns = A.shape
    beta, bounds = b.copy(), np.concatenate([upper, np.full(rows, np.inf)])
    basis, status = np.zeros(rows, dtype=np.int64), np.zeros(columns + rows, dtype=np.int64)
    inverse, y = np.zeros((rows, rows)), np.zeros(rows)
    tableau = Tableau(A, bounds, inverse, beta, basis, status, y)
    left = feasible_basis(tableau)
    if left > 1e-7:
        return left, np.inf, y
    whole = np.concatenate([cost, np.zeros(rows)])
    z = np.where(status == 2, bounds, 0.0)
    z[basis] = beta
    optimum = minimise(tableau, whole, float(whole @ z), -np.inf)
    assert np.allclose(np.hstack([A, np.eye(rows)])[:, basis] @ inverse, np.eye(rows))
    return left, optimum, y


@pytest.mark.parametrize("seed", range(8))
def test_agrees_with_highs(seed):
    rng = np.random.default_rng(seed)
    seen = set()
    for _ in range(50):
        A, b, upper, cost = random_program(rng)
        left, optimum, y = solve(A, b, upper, cost)
        expected = linprog(cost, A_eq=A, b_eq=b, bounds=list(zip(np.zeros(len(upper)), upper, strict=True)))
        seen.add(expected.status)
        if expected.status == 2:
            assert left > 1e-7
            # A Farkas proof: y . b is more than y . A z can be.
            price = y @ A
            pays = price > 1e-9
            assert y @ b > price[pays] @ upper[pays] + 1e-8
        elif expected.status == 3:
            assert left <= 1e-7
            assert optimum == -np.inf
        else:
            assert left <= 1e-7
            assert optimum == pytest.approx(expected.fun, abs=1e-6)
            reduced = cost - y @ A
            pays = reduced < -1e-9
            assert y @ b + reduced[pays] @ upper[pays] == pytest.approx(optimum, abs=1e-6)
    assert {0, 2} <= seen


def test_stops_where_it_is_told_that_it_is_enough():
    A, beta, bounds = np.array([[1.0, 1.0, 1.0]]), np.array([1.0]), np.full(4, np.inf)
    basis, status = np.zeros(1, dtype=np.int64), np.zeros(4, dtype=np.int64)
    inverse, y = np.zeros((1, 1)), np.zeros(1)
    tableau = Tableau(A, bounds, inverse, beta, basis, status, y)
    assert feasible_basis(tableau) == 0.0
    cost = np.array([0.0, -1.0, -2.0, 0.0])
    start = float(cost[basis[0]])
    assert minimise(tableau, cost, start, 5.0) == start
    assert minimise(tableau, cost, start, -np.inf) == -2.0
