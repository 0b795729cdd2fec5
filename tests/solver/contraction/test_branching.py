"""The choice of the column to split."""

import numpy as np
import pytest
from holdfast.solver.contraction.branching import column_to_split, cut_value
from holdfast.solver.contraction.hc4_canonical import Propagator
from holdfast.solver.polynomial.canonical import canonical_form
from holdfast.solver.polynomial.system import SystemBuilder


def test_a_cut_leaves_no_sliver():
    assert cut_value(0.0, 1.0, 0.4) == 0.4
    assert cut_value(0.0, 1.0, -5.0) == 0.3
    assert cut_value(-2.0, 2.0, 9.0) == pytest.approx(0.8)


def test_prefers_the_column_whose_halves_propagation_narrows():
    """Two products are equally wrong; that of a factor on which others hang is the one to split."""
    builder = SystemBuilder()
    x, y, z, w = (builder.variable(name, -1.0, 1.0) for name in "xyzw")
    lone = builder.variable("lone", -1.0, 1.0)
    builder.equate(x - z)  # so half of x's range is half of z's and of w's
    builder.equate(x - w)
    builder.at_least_zero(x * y + lone * y + z * w + 2.0)
    form = canonical_form(builder.build())
    point = np.zeros(form.size)
    pairs = {(i, j): k for k, i, j in form.products.tolist()}
    for k in pairs.values():
        point[k] = 0.5
    scores = np.zeros(form.size)
    scores[0] = scores[4] = 1.0  # x and lone
    chosen = column_to_split(form, Propagator(form), form.lower, form.upper, point, scores)
    assert chosen == 0
    # Only columns with a score are asked.
    scores[0] = 0.0
    assert column_to_split(form, Propagator(form), form.lower, form.upper, point, scores) == 4


def test_a_half_without_solutions_counts_for_nothing():
    """Where half of a column is refuted at once, it is split before one whose halves both remain."""
    builder = SystemBuilder()
    x, y, z = (builder.variable(name, 0.0, 1.0) for name in "xyz")
    builder.at_least_zero(x * y - 0.6)
    builder.at_least_zero(x * z)
    form = canonical_form(builder.build())
    point = np.full(form.size, 0.5)
    scores = np.where(np.arange(form.size) < 3, 1.0, 0.0)
    scores[1] = 0.0
    assert column_to_split(form, Propagator(form), form.lower, form.upper, point, scores) == 0
