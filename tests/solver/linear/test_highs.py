"""What is said to be proved about a linear program is true, whatever the floating-point solver answers."""

from fractions import Fraction

import numpy as np
import pytest
import scipy.optimize
from holdfast.base.numeric.arrays import offsets
from holdfast.solver.linear.highs import LinearProgram, LpStatus, dual_bound
from holdfast.solver.polynomial.canonical import Rows

Array = np.ndarray


def dense_rows(A: Array, lower: Array, upper: Array) -> Rows:
    keep = A != 0.0
    return Rows(
        offsets(keep.sum(axis=1)),
        np.nonzero(keep)[1].astype(np.int64),
        A[keep],
        lower.astype(float),
        upper.astype(float),
    )


def exact_products(A: Array, x: Array) -> list[Fraction]:
    return [
        sum((Fraction(a) * Fraction(v) for a, v in zip(row.tolist(), x.tolist(), strict=True)), Fraction(0))
        for row in A
    ]


def feasible_program(rng: np.random.Generator) -> tuple[Array, Rows, Array, Array, Array]:
    """Equalities, one-sided and two-sided rows that hold, exactly, at the point that comes last."""
    n, m = int(rng.integers(2, 7)), int(rng.integers(1, 6))
    x = rng.integers(-8, 9, n) / 4
    A = rng.integers(-16, 17, (m, n)) / 8 * (rng.uniform(size=(m, n)) < 0.7)
    value = A @ x  # exact: dyadic
    lower, upper = value - rng.integers(0, 5, m) / 4, value + rng.integers(0, 5, m) / 4
    lower[rng.uniform(size=m) < 0.3] = -np.inf
    upper[rng.uniform(size=m) < 0.3] = np.inf
    box = np.array([x - rng.integers(0, 9, n) / 4, x + rng.integers(0, 9, n) / 4])
    return A, dense_rows(A, lower, upper), box[0], box[1], x


def oracle(cost: Array, A: Array, rows: Rows, lower: Array, upper: Array):
    """The same program through scipy."""
    signs = [(A, rows.upper), (-A, -rows.lower)]
    A_ub = np.vstack([M[np.isfinite(b)] for M, b in signs])
    b_ub = np.concatenate([b[np.isfinite(b)] for _, b in signs])
    return scipy.optimize.linprog(cost, A_ub, b_ub, bounds=np.column_stack([lower, upper]), method="highs")


def test_bounds_are_proved_and_tight():
    rng = np.random.default_rng(0)
    for _ in range(150):
        A, rows, lower, upper, x = feasible_program(rng)
        program = LinearProgram(A.shape[1])
        program.load(rows, lower, upper)
        for j in range(A.shape[1]):
            for sign in (1.0, -1.0):
                assert program.minimise(j, sign) is LpStatus.OPTIMAL
                bound = program.proved_bound()
                cost = np.zeros(A.shape[1])
                cost[j] = sign
                best = oracle(cost, A, rows, lower, upper)
                assert best.status == 0
                assert bound == pytest.approx(best.fun, abs=1e-7)
                assert Fraction(bound) <= Fraction(sign * x[j])
                assert program.point[j] * sign == pytest.approx(best.fun, abs=1e-7)


@pytest.mark.parametrize("size", [1e-300, 1e-3, 1.0, 1e6, 1e300, 1.7e308])
def test_any_duals_give_a_bound(size):
    """Weak duality in rounded arithmetic: no duals may bound above what a feasible point attains."""
    rng = np.random.default_rng(1)
    for _ in range(300):
        A, rows, lower, upper, x = feasible_program(rng)
        cost = rng.normal(size=A.shape[1]) * (rng.uniform(size=A.shape[1]) < 0.5)
        duals = rng.normal(size=A.shape[0]).clip(-1, 1) * size
        with np.errstate(all="ignore"):
            bound = dual_bound(cost, duals, rows, lower, upper)
        attained = exact_products(cost[None], x)[0]
        assert np.isnan(bound) or bound == -np.inf or Fraction(bound) <= attained


def test_the_bound_of_exact_duals_is_exact_to_rounding():
    # min x + y over x + 2 y >= 3, 3 x + y >= 4 in [0, 10]^2: the vertex (1, 1), duals (2/5, 1/5).
    A = np.array([[1.0, 2.0], [3.0, 1.0]])
    rows = dense_rows(A, np.array([3.0, 4.0]), np.array([np.inf, np.inf]))
    bound = dual_bound(np.ones(2), np.array([0.4, 0.2]), rows, np.zeros(2), np.full(2, 10.0))
    assert bound <= 2.0
    assert bound == pytest.approx(2.0, abs=1e-13)
    # A dual that points to a missing side says nothing.
    bound = dual_bound(np.ones(2), np.array([-0.4, 0.2]), rows, np.zeros(2), np.full(2, 10.0))
    assert bound == pytest.approx(0.8, abs=1e-13)


def test_rounding_is_outward_where_a_thousand_terms_cancel():
    rng = np.random.default_rng(2)
    for _ in range(50):
        n = 30
        A = rng.normal(size=(8, n))
        x = rng.normal(size=n)
        value = exact_products(A, x)
        lower = np.array([float(v) for v in value])
        lower = np.where(
            [Fraction(a) <= v for a, v in zip(lower, value, strict=True)], lower, np.nextafter(lower, -9)
        )
        upper = np.nextafter(lower, 9)
        cost, duals = rng.normal(size=n), rng.normal(size=8)
        bound = dual_bound(cost, duals, dense_rows(A, lower, upper), x, x)
        assert Fraction(bound) <= exact_products(cost[None], x)[0]
        assert bound == pytest.approx(cost @ x, abs=1e-11)


def test_large_and_small_coefficients_of_one_column_are_summed_outward():
    """x takes part in 2^54 x >= w and in x >= z_r for 32 r: a sum of its coefficients loses the ones."""
    n = 32
    A = np.zeros((n + 1, n + 2))
    A[0, n], A[0, n + 1] = -1.0, 2.0**54
    A[np.arange(1, n + 1), np.arange(n)] = -1.0
    A[1:, n + 1] = 1.0
    x = np.array([*[1.0] * n, 2.0**54, 1.0])
    rows = dense_rows(A, np.zeros(n + 1), np.full(n + 1, np.inf))
    assert dual_bound(np.zeros(n + 2), np.ones(n + 1), rows, x, x) <= 0.0


def prove_empty(rows: Rows, lower: Array, upper: Array) -> tuple[LpStatus, bool]:
    program = LinearProgram(len(lower))
    program.load(rows, lower, upper)
    return program.minimise(None), program.proved_infeasible()


def test_a_feasible_program_is_never_proved_infeasible():
    rng = np.random.default_rng(3)
    for _ in range(150):
        _, rows, lower, upper, _ = feasible_program(rng)
        assert prove_empty(rows, lower, upper) == (LpStatus.OPTIMAL, False)


def test_a_clearly_infeasible_program_is_proved_so():
    rng = np.random.default_rng(4)
    proved = 0
    for _ in range(150):
        A, rows, lower, upper, _ = feasible_program(rng)
        # One more row contradicts a combination of all others and of the box.
        y = rng.integers(1, 5, A.shape[0]) / 4
        reach = sum(max(c * lo, c * hi) for c, lo, hi in zip(y @ A, lower, upper, strict=True))
        more = dense_rows(
            np.vstack([A, y @ A]), np.append(rows.lower, reach + 0.5), np.append(rows.upper, np.inf)
        )
        if not (y @ A).any():
            continue
        assert oracle(np.zeros(A.shape[1]), np.vstack([A, y @ A]), more, lower, upper).status == 2
        assert prove_empty(more, lower, upper) == (LpStatus.INFEASIBLE, True)
        proved += 1
    assert proved > 100


def test_infeasible_by_two_rows_that_the_box_alone_admits():
    rows = dense_rows(
        np.array([[1.0, 1.0], [1.0, -1.0], [1.0, 0.0]]), np.array([1, 0, 0]), np.array([1, 0, 0.4])
    )
    assert prove_empty(rows, np.full(2, -5.0), np.full(2, 5.0)) == (LpStatus.INFEASIBLE, True)


def test_barely_infeasible_is_not_claimed_and_barely_feasible_neither():
    A = np.array([[1.0, 1.0]])
    for excess in (0.0, 1e-16, 1e-12):
        rows = dense_rows(A, np.array([2.0 + excess]), np.array([np.inf]))
        claimed = prove_empty(rows, np.zeros(2), np.ones(2))[1]
        assert not claimed or 2.0 + excess > 2.0


def test_one_instance_serves_box_after_box():
    rng = np.random.default_rng(5)
    A, rows, lower, upper, _ = feasible_program(rng)
    program = LinearProgram(A.shape[1])
    cost = np.zeros(A.shape[1])
    cost[1] = -1.0
    for shrink in (0.0, 0.1, 0.2, 0.0):
        lo, hi = lower, upper - shrink * (upper - lower)
        program.load(rows, lo, hi)
        status = program.minimise(1, -1.0)
        best = oracle(cost, A, rows, lo, hi)
        if best.status == 0:
            assert status is LpStatus.OPTIMAL
            assert program.proved_bound() == pytest.approx(best.fun, abs=1e-7)
        else:
            assert status is LpStatus.INFEASIBLE
    # A cost set earlier is gone, and a box changed afterwards by the caller is not the program's.
    program.load(rows, lower, upper)
    assert program.minimise(0, 1.0) is LpStatus.OPTIMAL
    first = program.proved_bound()
    lower[:] = 100.0
    assert program.proved_bound() == first
    assert program.solved == 5
