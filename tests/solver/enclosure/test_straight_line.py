"""Enclosures of values and derivatives against rational arithmetic."""

from fractions import Fraction
from math import comb

import numpy as np
import pytest
from holdfast.solver.enclosure.straight_line import StraightLineProgram
from holdfast.solver.polynomial.polynomial import total
from holdfast.solver.polynomial.system import BernsteinFunction, PolynomialSystem, SystemBuilder

Array = np.ndarray


class Dual:
    """A rational number with its gradient."""

    def __init__(self, value: Fraction, slope: list[Fraction]):
        self.value, self.slope = value, slope

    def __add__(self, other: "Dual") -> "Dual":
        return Dual(self.value + other.value, [a + b for a, b in zip(self.slope, other.slope, strict=True)])

    def __mul__(self, other: "Dual") -> "Dual":
        slope = [a * other.value + self.value * b for a, b in zip(self.slope, other.slope, strict=True)]
        return Dual(self.value * other.value, slope)


def constant(c: float | Fraction, m: int) -> Dual:
    return Dual(Fraction(c), [Fraction(0)] * m)


def run(system: PolynomialSystem, point: list[Fraction]) -> tuple[list[Dual], list[Dual], list[Dual]]:
    """All variables, equations and inequalities at a point of the inputs, with gradients by the inputs."""
    m = len(system.inputs)
    x = [constant(0, m) for _ in range(system.size)]
    for a, (k, value) in enumerate(zip(system.inputs, point, strict=True)):
        x[k] = Dual(value, [Fraction(int(a == b)) for b in range(m)])

    def polynomial(p) -> Dual:
        out = constant(0, m)
        for monomial, c in p.terms.items():
            term = constant(c, m)
            for i in monomial:
                term = term * x[i]
            out = out + term
        return out

    def power(base: Dual, n: int) -> Dual:
        out = constant(1, m)
        for _ in range(n):
            out = out * base
        return out

    def bernstein(f: BernsteinFunction) -> Dual:
        out = constant(0, m)
        di, dj = (s - 1 for s in f.coefficients.shape)
        minus = constant(-1, m)
        rest_i, rest_j = constant(1, m) + minus * x[f.i], constant(1, m) + minus * x[f.j]
        for p in range(di + 1):
            for q in range(dj + 1):
                c = Fraction(float(f.coefficients[p, q])) * comb(di, p) * comb(dj, q)
                out = out + constant(c, m) * power(x[f.i], p) * power(rest_i, di - p) * power(
                    x[f.j], q
                ) * power(rest_j, dj - q)
        return out

    for k, value in system.definitions.items():
        x[k] = bernstein(value) if isinstance(value, BernsteinFunction) else polynomial(value)
    return x, [polynomial(e) for e in system.equations], [polynomial(g) for g in system.inequalities]


def sample_system(rng: np.random.Generator, degree: tuple[int, int]) -> PolynomialSystem:
    builder = SystemBuilder()
    a, b, c = (builder.variable(name, -3, 3) for name in "abc")
    u, v = builder.variable("u", 0, 1), builder.variable("v", 0, 1)
    d = builder.define("d", a * b * float(rng.normal()) + c * float(rng.normal()) + 0.1)
    f = builder.bernstein("f", u, v, rng.normal(size=(degree[0] + 1, degree[1] + 1)))
    e = builder.define("e", d * f - a * a * float(rng.normal()))
    builder.equate(e * e + d * 0.3 - float(rng.normal()))
    builder.equate(a * b * c * float(rng.normal()) + f * u)
    builder.equate(v - f * f * f)
    builder.at_least_zero(e - a * a * a)
    builder.at_least_zero(f + 0.25)
    return builder.build()


def member(lower: Array, upper: Array, rng: np.random.Generator) -> list[Fraction]:
    share = rng.choice([0.0, 1.0, 0.5, 0.3125], len(lower))
    return [
        Fraction(float(lo)) + Fraction(float(s)) * (Fraction(float(hi)) - Fraction(float(lo)))
        for lo, hi, s in zip(lower, upper, share, strict=True)
    ]


@pytest.mark.parametrize("degree", [(1, 1), (2, 3), (3, 3), (1, 4), (0, 2)])
def test_values_and_derivatives_are_enclosed(degree):
    rng = np.random.default_rng(10 * degree[0] + degree[1])
    system = sample_system(rng, degree)
    program = StraightLineProgram(system)
    for _ in range(12):
        width = 10.0 ** rng.uniform(-17, 0, 5) * (rng.uniform(size=5) < 0.8)
        lower, upper = system.lower.copy(), system.upper.copy()
        lower[:5] = rng.uniform([-2, -2, -2, 0, 0], [2, 2, 2, 1, 1])
        upper[:5] = lower[:5] + width
        out = program.enclose(lower, upper)
        x, equations, inequalities = run(system, member(lower[:5], upper[:5], rng))
        for k, exact in enumerate(x):
            assert Fraction(out.lower[k]) <= exact.value <= Fraction(out.upper[k])
        for k, exact in enumerate(equations):
            assert Fraction(out.value_lower[k]) <= exact.value <= Fraction(out.value_upper[k])
            for j, slope in enumerate(exact.slope):
                assert Fraction(out.slope_lower[k, j]) <= slope <= Fraction(out.slope_upper[k, j])
        for k, exact in enumerate(inequalities):
            assert Fraction(out.slack_lower[k]) <= exact.value


def test_at_a_point_the_enclosures_are_narrow():
    rng = np.random.default_rng(3)
    system = sample_system(rng, (3, 3))
    x = np.append(rng.uniform(0.1, 0.9, 5), np.zeros(3))
    out = StraightLineProgram(system).enclose(x, x)
    assert np.all(out.upper - out.lower < 1e-13)
    assert np.all(out.value_upper - out.value_lower < 1e-13)
    assert np.all(out.slope_upper - out.slope_lower < 1e-12)


def test_derivatives_agree_with_differences():
    rng = np.random.default_rng(4)
    system = sample_system(rng, (3, 2))
    program = StraightLineProgram(system)
    x, h = np.append(rng.uniform(0.1, 0.9, 5), np.zeros(3)), 1e-6
    slope = program.enclose(x, x).slope_lower
    for j, k in enumerate(system.inputs):
        step = np.zeros(8)
        step[k] = h
        difference = (
            program.enclose(x + step, x + step).value_lower - program.enclose(x - step, x - step).value_lower
        )
        assert slope[:, j] == pytest.approx(difference / (2 * h), abs=1e-8)


def test_a_system_without_equations():
    builder = SystemBuilder()
    x = builder.variable("x", -1, 1)
    builder.define("y", x * x)
    out = StraightLineProgram(builder.build()).enclose(np.array([0.5, 0.0]), np.array([0.75, 0.0]))
    assert out.value_lower.shape == (0,) and out.slope_lower.shape == (0, 1)
    assert (out.lower[1], out.upper[1]) == pytest.approx((0.25, 0.5625))


def test_sums_of_large_and_small_are_rounded_outward():
    """Thirty ones that are each lost beside 2^54, when nothing is done about it."""
    builder = SystemBuilder()
    large = builder.variable("large", 0, 2.0**60)
    ones = [builder.variable(f"x{i}", 0, 2) for i in range(30)]
    builder.equate(total([large, *ones]))
    lower = np.array([2.0**54, *[1.0] * 30])
    out = StraightLineProgram(builder.build()).enclose(lower, lower)
    assert out.value_lower[0] <= 2.0**54 + 30 <= out.value_upper[0]
