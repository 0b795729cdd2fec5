"""Solutions of a polynomial system and of its canonical form are the same points."""

import json
from fractions import Fraction

import numpy as np
import pytest
from holdfast.check_proof.propagation import propagate
from holdfast.check_proof.system import LoggedSystem
from holdfast.solver.contraction.hc4_canonical import Propagator
from holdfast.solver.polynomial.canonical import CanonicalForm, canonical_form
from holdfast.solver.polynomial.polynomial import Polynomial
from holdfast.solver.polynomial.system import PolynomialSystem, SystemBuilder
from holdfast.solver.proof.log import form_data


def extend(form: CanonicalForm, x: list[Fraction]) -> list[Fraction]:
    """All columns at a point of the system; products come after their factors."""
    out = [*x, *[Fraction(0)] * (form.size - len(x))]
    for k, i, j in form.products:
        out[k] = out[i] * out[j]
    return out


def rows_hold(form: CanonicalForm, x: list[Fraction]) -> list[bool]:
    rows = form.rows
    out = []
    for r in range(len(rows.lower)):
        entries = range(rows.start[r], rows.start[r + 1])
        total = sum((Fraction(float(rows.value[t])) * x[rows.column[t]] for t in entries), Fraction(0))
        out.append(
            bool(
                (rows.lower[r] == -np.inf or Fraction(float(rows.lower[r])) <= total)
                and (rows.upper[r] == np.inf or total <= Fraction(float(rows.upper[r])))
            )
        )
    return out


def sample_system(rng: np.random.Generator, x: list[Fraction]) -> PolynomialSystem:
    """Equations up to degree 5, an inequality, definitions of both kinds, all true at the dyadic point x."""
    builder = SystemBuilder()
    variables = [builder.variable(f"x{i}", -2.0, 2.0) for i in range(4)]
    u, v = builder.variable("u", 0.0, 1.0), builder.variable("v", 0.0, 1.0)
    variables.append(builder.define("d", variables[0] * variables[1] - variables[2] * 0.5))
    variables.append(builder.bernstein("f", u, v, rng.integers(-8, 9, (3, 4)) / 4))
    for degree in (1, 2, 3, 4, 5):
        terms = {
            tuple(sorted(int(i) for i in rng.integers(0, 8, rng.integers(1, degree + 1)))): float(c)
            for c in rng.integers(-4, 5, 4)
        }
        value = sum(
            (Fraction(c) * np.prod([x[i] for i in m], dtype=object) for m, c in terms.items()), Fraction(0)
        )
        assert Fraction(float(value)) == value
        builder.equate(Polynomial(terms) - float(value))
        builder.at_least_zero(Polynomial(terms) - float(value) + 0.25)
    return builder.build()


def dyadic_point(rng: np.random.Generator) -> list[Fraction]:
    return [
        *(Fraction(int(k), 4) for k in rng.integers(-7, 8, 4)),
        *(Fraction(int(k), 2) for k in rng.integers(0, 3, 2)),
        Fraction(0),
        Fraction(0),
    ]


def solved_system(exact, seed: int) -> tuple[PolynomialSystem, list[Fraction]]:
    rng = np.random.default_rng(seed)
    x = dyadic_point(rng)
    exact.define(sample_system(np.random.default_rng(seed + 1000), x), x)  # fills the definitions
    system = sample_system(np.random.default_rng(seed + 1000), x)
    assert all(exact.polynomial(e, x) == 0 for e in system.equations)
    return system, x


@pytest.mark.parametrize("seed", range(20))
def test_a_solution_extends_to_a_point_of_every_row_and_of_the_box(exact, seed):
    system, x = solved_system(exact, seed)
    form = canonical_form(system)
    full = extend(form, x)
    assert all(rows_hold(form, full))
    assert exact.within(full, form.lower, form.upper)
    for f, (k, i, j) in enumerate(form.functions.kij):
        m, n = form.functions.degree[f] + 1
        start = form.functions.start[f]
        net = form.functions.coefficients[start : start + m * n].reshape(m, n)
        assert full[k] == exact.bernstein(net, full[i], full[j])


@pytest.mark.parametrize("seed", range(20))
def test_a_point_that_misses_an_equation_misses_a_row(exact, seed):
    system, x = solved_system(exact, seed)
    form = canonical_form(system)
    rng = np.random.default_rng(seed)
    for _ in range(10):
        moved = list(x)
        moved[int(rng.integers(0, 4))] += Fraction(int(rng.integers(1, 9)), 64)
        exact.define(system, moved)
        misses = [exact.polynomial(e, moved) != 0 for e in system.equations]
        fails = [exact.polynomial(e, moved) < 0 for e in system.inequalities]
        held = rows_hold(form, extend(form, moved))
        assert held.count(False) == sum(misses) + sum(fails)


def test_columns_are_shared_and_powers_are_squares_of_squares():
    builder = SystemBuilder()
    x, y = builder.variable("x", -1, 2), builder.variable("y", 0, 3)
    builder.equate(x * x * x * x + x * x * y - 1.0)
    builder.equate(x * x - y * x)
    form = canonical_form(builder.build())
    products = {tuple(triple) for triple in form.products.tolist()}
    square = next(k for k, i, j in products if (i, j) == (0, 0))
    assert any((i, j) == (square, square) for _, i, j in products)
    assert len({(i, j) for _, i, j in products}) == len(products)
    assert form.lower[square] == 0.0
    assert form.upper[square] == pytest.approx(4.0)


def test_equations_are_equalities_and_redundant_ones_have_a_little_room():
    builder = SystemBuilder()
    x = builder.variable("x", -1, 2)
    builder.equate(x - 1.0)
    builder.imply(x * 3.0 - 3.0)
    builder.at_least_zero(x - 0.5)
    rows = canonical_form(builder.build()).rows
    assert rows.lower[0] == rows.upper[0] == 1.0
    assert 0.0 < 3.0 - rows.lower[1] < 1e-11
    assert 0.0 < rows.upper[1] - 3.0 < 1e-11
    assert (rows.lower[2], rows.upper[2]) == (0.5, np.inf)


def test_a_system_without_products_or_functions():
    builder = SystemBuilder()
    builder.equate(builder.variable("x", -1, 2) - 1.0)
    form = canonical_form(builder.build())
    assert form.size == 1 and form.products.shape == (0, 3) and form.functions.kij.shape == (0, 3)


@pytest.mark.parametrize("kind", ["equate", "imply", "at_least_zero"])
def test_a_constant_row_counts_only_where_it_is_false(kind):
    # Implied equations follow from the others, so a constant one is zero but for rounding.
    for constant, is_false in ((-1.0, kind != "imply"), (-1e-16, False), (0.0, False)):
        builder = SystemBuilder()
        x = builder.variable("x", -1, 1)
        builder.equate(x - 0.5)
        getattr(builder, kind)(Polynomial.constant(constant))
        form = canonical_form(builder.build())
        assert len(form.rows.lower) == 1 + is_false
        assert Propagator(form).contract(form.lower.copy(), form.upper.copy()) is not is_false
        with np.errstate(all="ignore"):
            logged = LoggedSystem(json.loads(json.dumps(form_data(form))))
            propagate(logged, logged.box)
        assert logged.box.is_empty is is_false


def test_a_false_row_without_any_variable_refutes():
    for constant, is_false in ((-1.0, True), (0.0, False)):
        builder = SystemBuilder()
        builder.equate(Polynomial.constant(constant))
        form = canonical_form(builder.build())
        assert Propagator(form).contract(form.lower.copy(), form.upper.copy()) is not is_false
