"""Systems with cosines and sines: no contractor and no row loses a point that is known to many digits."""

from collections.abc import Iterator
from fractions import Fraction

import numpy as np
import pytest
from holdfast.solver.contraction.hc4_canonical import Propagator
from holdfast.solver.contraction.prune import Box, Pruner
from holdfast.solver.interval import COSINE, SINE
from holdfast.solver.linear.gaps import errors_by_factor, relaxation_errors
from holdfast.solver.linear.relaxation import Relaxation
from holdfast.solver.polynomial.canonical import CanonicalForm, canonical_form
from holdfast.solver.polynomial.system import PolynomialSystem, SystemBuilder

from ...exact import Exact

Array = np.ndarray
SEEDS = range(8)


def planted(seed: int) -> tuple[PolynomialSystem, list[Fraction]]:
    """Two angles, turns of them by ratios of all kinds, products of those, and where they come to lie."""
    rng = np.random.default_rng(seed)
    builder = SystemBuilder()
    x, y = (builder.variable(name, -1.5, 1.7) for name in "xy")
    u = builder.variable("u", -2.0, 2.0)
    root = [Fraction(float(v)) for v in rng.uniform(-1.4, 1.6, 3)]
    pairs = []
    for k, angle in enumerate((x, x, y)):
        ratio, offset = float(rng.choice([1.0, 1.05851325, 0.87, -1.13, 2.3])), float(rng.uniform(-1, 1))
        pairs.append(
            [
                builder.trig(f"{name} {k}", angle, kind, ratio, offset)
                for name, kind in (("cos", COSINE), ("sin", SINE))
            ]
        )
        builder.imply(pairs[-1][0] * pairs[-1][0] + pairs[-1][1] * pairs[-1][1] - 1.0)
    (c0, s0), (c1, s1), (c2, s2) = pairs
    p = builder.define("p", c0 * 0.7 + c1 * 0.4 + u * s2)
    q = builder.define("q", s0 * 0.7 + s1 * 0.4 + u * c2)
    # Where they lie, as inputs of their own, whose exact values are no floats.
    ends = [builder.variable(name, -9.0, 9.0) for name in ("at p", "at q")]
    builder.equate(p - ends[0])
    builder.equate(q - ends[1])
    builder.at_least_zero(p + 9.0)
    system = builder.build()
    exact = [*root, *[Fraction(0)] * (system.size - 3)]
    Exact.define(system, exact)
    exact[-2:] = exact[-4:-2]
    return system, exact


def extended(form: CanonicalForm, x: list[Fraction]) -> list[Fraction]:
    out = [*x, *[Fraction(0)] * (form.size - len(x))]
    for k, i, j in form.products:
        out[k] = out[i] * out[j]
    return out


def boxes(form: CanonicalForm, root: list[Fraction], count: int, seed: int) -> Iterator[tuple[Array, Array]]:
    """From a point to the whole box, with sides on the solution itself."""
    rng = np.random.default_rng(seed)
    low, high = Exact.ends(root)
    for _ in range(count):
        size = 10.0 ** rng.uniform(-14, 0.7, (2, form.size)) * (rng.uniform(size=(2, form.size)) < 0.8)
        yield np.maximum(low - size[0], form.lower), np.minimum(high + size[1], form.upper)


@pytest.mark.parametrize("seed", SEEDS)
def test_propagation_keeps_the_solution(seed, keeping):
    system, x = planted(seed)
    form = canonical_form(system)
    assert len(form.trig.ki) == 6
    root, propagator = extended(form, x), Propagator(form)
    keeping.check(root, boxes(form, root, 60, seed), propagator.contract)
    assert keeping.narrowed > 30


@pytest.mark.parametrize("seed", SEEDS)
def test_rows_of_the_relaxation_hold_at_the_solution(seed):
    system, x = planted(seed)
    form = canonical_form(system)
    root, relaxation = extended(form, x), Relaxation(form)
    for lower, upper in boxes(form, root, 25, 100 + seed):
        rows, names = relaxation.build(lower, upper)
        assert names.tolist() == list(range(len(form.rows.lower) + 4 * len(form.products) + 24))
        for r in range(len(form.rows.lower), len(rows.lower)):
            entries = range(rows.start[r], rows.start[r + 1])
            total = sum(Fraction(float(rows.value[t])) * root[rows.column[t]] for t in entries)
            assert rows.lower[r] == -np.inf or Fraction(rows.lower[r]) <= total
            assert rows.upper[r] == np.inf or total <= Fraction(rows.upper[r])


@pytest.mark.parametrize("seed", SEEDS)
def test_linear_programs_keep_the_solution(seed):
    system, x = planted(seed)
    form = canonical_form(system)
    root, pruner = extended(form, x), Pruner(form, system.inputs)
    low, high = Exact.ends(root)
    narrowed = 0
    for lower, upper in boxes(form, root, 12, 200 + seed):
        pruned = pruner.prune(Box(lower.copy(), upper.copy()), tightened=3)
        assert pruned is not None, "a box with a solution was refuted"
        assert np.all(pruned.lower <= low) and np.all(high <= pruned.upper), "a solution was cut off"
        narrowed += np.any(pruned.upper - pruned.lower < 0.5 * (upper - lower))
    assert narrowed > 6


def test_errors_of_cosines_count_for_the_angle():
    form = canonical_form(planted(0)[0])
    x = 0.5 * (form.lower + form.upper)
    k, i = form.trig.ki[0]
    errors = relaxation_errors(form, x)
    assert len(errors) == len(form.factors) == len(form.products) + 6
    angle = form.trig.ratio[0] * x[i] + form.trig.offset[0]
    expected = abs(x[k] - (np.cos, np.sin)[form.trig.kind[0]](angle))
    assert errors[len(form.products)] == pytest.approx(expected, abs=1e-15)
    assert errors_by_factor(form, x)[i] > 0.0
    x[k] += 0.25
    moved = relaxation_errors(form, x)[len(form.products)]
    assert abs(abs(moved - errors[len(form.products)]) - 0.25) < 1e-12 or moved < 0.25


def test_propagation_goes_from_the_cosine_to_the_angle():
    """cos(1.0585 x + 0.1) = 0.4 and nothing else is enough to know x."""
    builder = SystemBuilder()
    x = builder.variable("x", 0.0, 2.0)
    builder.equate(builder.trig("c", x, COSINE, 1.0585, 0.1) - 0.4)
    form = canonical_form(builder.build())
    lower, upper = form.lower.copy(), form.upper.copy()
    assert Propagator(form).contract(lower, upper, least_gain=1e-9)
    assert upper[0] - lower[0] < 1e-11
    assert lower[0] <= (np.arccos(0.4) - 0.1) / 1.0585 <= upper[0]
