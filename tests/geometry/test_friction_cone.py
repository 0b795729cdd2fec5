"""Friction cones as hulls of edges."""

from math import inf

import numpy as np
import pytest
from holdfast.geometry import cone_edges
from scipy.optimize import nnls


@pytest.mark.parametrize("outside", [False, True])
def test_cones_lie_around_or_within_their_edges(outside: bool) -> None:
    mu, mu_t = 0.6, 0.002
    edges = cone_edges(mu, mu_t, 1, outside=outside) / np.array([1.0, mu, mu, mu_t])[:, None]
    rng = np.random.default_rng(0)
    lean = rng.normal(size=(50, 3))
    lean /= np.linalg.norm(lean, axis=1, keepdims=True)
    worst = 0.0
    for direction in lean:
        # A vector on the cone is a nonnegative sum of edges exactly where the least residual is zero.
        _, residual = nnls(edges, np.concatenate([[1.0], direction]))
        worst = max(worst, residual)
    assert worst < 1e-9 if outside else 1e-3 < worst < inf
