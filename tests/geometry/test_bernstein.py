"""Compiled Bernstein polynomials agree with those on arrays, and with finite differences."""

import numpy as np
import pytest
from holdfast.geometry import bernstein, bernstein_jets, de_casteljau


@pytest.mark.parametrize("degree", range(1, 7))
@pytest.mark.parametrize("x", [0.0, 0.3, 1.0, 1.2])
def test_compiled_and_on_arrays_they_agree(degree, x):
    coefficients = np.random.default_rng(degree).normal(size=degree + 1)
    expected = bernstein(degree, x)
    values, slopes, curvatures = bernstein_jets(degree, x)
    np.testing.assert_allclose(values, expected, atol=1e-13)
    assert de_casteljau(coefficients.copy(), x) == pytest.approx(expected @ coefficients, abs=1e-12)
    h = 1e-4
    before, after = bernstein(degree, x - h), bernstein(degree, x + h)
    np.testing.assert_allclose(slopes, (after - before) / (2.0 * h), atol=1e-4)
    np.testing.assert_allclose(curvatures, (after - 2.0 * expected + before) / h**2, atol=1e-3)
