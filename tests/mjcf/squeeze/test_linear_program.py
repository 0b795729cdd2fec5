"""Linear programs: known answers, and multipliers that are derivatives of the value."""

import numpy as np
import pytest
from holdfast.mjcf.squeeze.linear_program import largest_last, minimise


def test_a_known_corner() -> None:
    """Of x + y = 1 with x <= 0.3 the cheapest point for cost (1, 2) is (0.3, 0.7)."""
    optimum = minimise(
        np.array([1.0, 2.0]), np.ones((1, 2)), np.ones(1), np.array([[1.0, 0.0]]), np.array([0.3])
    )
    assert optimum is not None
    assert optimum.x == pytest.approx([0.3, 0.7])
    assert optimum.value == pytest.approx(1.7)
    # One more unit of the sum costs 2; one more of the bound saves 1.
    assert (optimum.equal[0], optimum.upper[0]) == pytest.approx((2.0, -1.0))


def test_what_has_no_solution_gives_none() -> None:
    assert minimise(np.ones(2), np.ones((1, 2)), -np.ones(1)) is None
    assert largest_last(np.zeros((0, 2)), np.array([[0.0, 1.0]]), np.array([-1.0]), 5.0) is None


@pytest.mark.parametrize("most", [0.5, 5.0])
def test_the_largest_last_unknown(most: float) -> None:
    """x - s = 0 and x <= 2."""
    optimum = largest_last(np.array([[1.0, -1.0]]), np.array([[1.0, 0.0]]), np.array([2.0]), most)
    assert optimum is not None
    assert optimum.x[-1] == pytest.approx(min(most, 2.0)) == pytest.approx(-optimum.value)


def test_bounds_of_single_unknowns() -> None:
    optimum = minimise(np.array([1.0, 1.0]), np.zeros((0, 2)), bounds={0: (0.25, 1.0), -1: (-3.0, 0.0)})
    assert optimum is not None and optimum.x == pytest.approx([0.25, -3.0])
