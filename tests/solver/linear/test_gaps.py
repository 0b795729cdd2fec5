"""Where the relaxation is wrong, and that boxes are split there, be it in a product or in a function."""

from fractions import Fraction

import numpy as np
import pytest
from holdfast.solver.contraction.prune import Box, Pruner
from holdfast.solver.linear.gaps import errors_by_factor, relaxation_errors
from holdfast.solver.polynomial.canonical import CanonicalForm, canonical_form
from holdfast.solver.polynomial.system import PolynomialSystem, SystemBuilder

NETS = [np.random.default_rng(n).normal(size=shape) for n, shape in enumerate([(4, 3), (1, 5), (2, 2)])]


def mixed() -> PolynomialSystem:
    """x y and x^2, and three functions of parameters of their own: columns 0, 1; 2, ..., 7; 8, 9, 10."""
    builder = SystemBuilder()
    x, y = builder.variable("x", -1, 1), builder.variable("y", -1, 1)
    parameters = [builder.variable(f"u{i}", 0, 1) for i in range(6)]
    for n, net in enumerate(NETS):
        builder.bernstein(f"f{n}", parameters[2 * n], parameters[2 * n + 1], net)
    builder.at_least_zero(x * y + x * x)
    return builder.build()


@pytest.fixture
def form() -> CanonicalForm:
    return canonical_form(mixed())


def solution(form: CanonicalForm, exact, rng: np.random.Generator) -> np.ndarray:
    x = np.zeros(form.size)
    x[:2], x[2:8] = rng.uniform(-1, 1, 2), rng.uniform(0, 1, 6)
    for k, i, j in form.products:
        x[k] = x[i] * x[j]
    for (k, i, j), net in zip(form.functions.kij, NETS, strict=True):
        x[k] = float(exact.bernstein(net, Fraction(float(x[i])), Fraction(float(x[j]))))
    return x


def test_the_error_is_the_gap_of_each_product_and_function(form, exact):
    rng = np.random.default_rng(0)
    targets = [*form.products[:, 0], *form.functions.kij[:, 0]]
    for _ in range(20):
        x = solution(form, exact, rng)
        assert relaxation_errors(form, x).max() < 1e-14
        gaps = rng.normal(size=len(targets))
        x[targets] += gaps
        assert relaxation_errors(form, x) == pytest.approx(np.abs(gaps), abs=1e-13)


def test_factors_get_the_errors_of_all_that_they_are_in(form, exact):
    x = solution(form, exact, np.random.default_rng(1))
    kij = np.concatenate([form.products, form.functions.kij])
    x[kij[:, 0]] += [0.5, 0.25, 0.125, 2.0, 4.0]
    expected = np.zeros(form.size)
    for (_, i, j), gap in zip(kij, [0.5, 0.25, 0.125, 2.0, 4.0], strict=True):
        expected[i] += gap
        expected[j] += gap
    assert errors_by_factor(form, x) == pytest.approx(expected, abs=1e-13)


@pytest.mark.parametrize("worst", range(5))
def test_a_box_is_split_in_a_factor_of_what_is_by_far_most_wrong(form, exact, worst):
    system = mixed()
    pruner = Pruner(form, system.inputs)
    kij = np.concatenate([form.products, form.functions.kij])
    x = solution(form, exact, np.random.default_rng(2))
    room = np.full(form.size, 0.1)
    x[kij[:, 0]] += np.where(np.arange(5) == worst, 0.05, 0.0005)
    column, _ = pruner.cut(Box(x - room, x + room, point=x))
    assert column in kij[worst, 1:]


def test_no_split_in_a_parameter_that_has_no_width_left(form, exact):
    system = mixed()
    x = solution(form, exact, np.random.default_rng(3))
    x[form.functions.kij[0, 0]] += 1.0
    room = np.full(form.size, 0.1)
    _, i, j = form.functions.kij[0]
    room[[i]] = 0.0
    pruner = Pruner(form, system.inputs)
    assert pruner.cut(Box(x - room, x + room, point=x))[0] == j
