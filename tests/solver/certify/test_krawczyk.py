"""A certified box holds a root; no certificate where there is none to be had."""

from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest
from holdfast.solver.certify.krawczyk import ExistenceTest, ProvedBox
from holdfast.solver.enclosure.straight_line import StraightLineProgram
from holdfast.solver.polynomial.polynomial import Polynomial
from holdfast.solver.polynomial.system import SystemBuilder

Equations = Callable[..., list[Polynomial]]


def system_of(equations: Equations, **ranges: tuple[float, float]) -> SystemBuilder:
    builder = SystemBuilder()
    variables = [builder.variable(name, *ends) for name, ends in ranges.items()]
    for equation in equations(*variables):
        builder.equate(equation)
    return builder


def prove(builder: SystemBuilder, *x: float) -> ProvedBox | None:
    system = builder.build()
    return ExistenceTest(StraightLineProgram(system)).prove(
        np.append(np.array(x), np.zeros(system.size - len(x)))
    )


def ends(box: ProvedBox, k: int) -> tuple[Fraction, Fraction]:
    return Fraction(float(box.lower[k])), Fraction(float(box.upper[k]))


def assert_narrow(box: ProvedBox) -> None:
    assert np.all(box.upper - box.lower < 1e-12)
    assert np.all((box.lower <= box.middle) & (box.middle <= box.upper))


def circle_and_line(x, y):
    return [x * x + y * y - 1.0, x - y]


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_circle_and_line(sign):
    box = prove(system_of(circle_and_line, x=(-2, 2), y=(-2, 2)), sign * 0.6, sign * 0.8)
    assert box is not None
    assert_narrow(box)
    for k in (0, 1):  # the root's coordinates are both 1 / sqrt 2, with the sign
        low, high = sorted(abs(e) for e in ends(box, k))
        assert np.sign(box.lower[k]) == sign
        assert low**2 < Fraction(1, 2) < high**2
    assert box.held.size == 0


def test_a_cubic():
    box = prove(system_of(lambda x: [x * x * x - x * 2.0 - 5.0], x=(0, 3)), 2.0)
    assert box is not None
    assert_narrow(box)
    low, high = ends(box, 0)
    assert low**3 - 2 * low - 5 < 0 < high**3 - 2 * high - 5


@pytest.mark.parametrize("start", [(0.9, 0.9), (0.9, -0.9), (-0.9, 0.9), (-0.9, -0.9)])
def test_crossing_ellipses(start):
    builder = system_of(
        lambda x, y: [x * x + y * y * 4.0 - 4.0, x * x * 4.0 + y * y - 4.0], x=(-2, 2), y=(-2, 2)
    )
    box = prove(builder, *start)
    assert box is not None
    for k in (0, 1):
        low, high = sorted(abs(e) for e in ends(box, k))
        assert low**2 < Fraction(4, 5) < high**2
        assert np.sign(box.middle[k]) == np.sign(start[k])


@pytest.mark.parametrize("seed", range(10))
def test_a_planted_dyadic_root_lies_in_its_box(seed):
    rng = np.random.default_rng(seed)
    n = 5
    root = rng.integers(-16, 17, n) / 8
    builder = SystemBuilder()
    variables = [builder.variable(f"x{i}", -4, 4) for i in range(n)]
    for _ in range(n):
        value = Polynomial()
        for _ in range(4):
            i, j = rng.integers(0, n, 2)
            value = value + variables[i] * variables[j] * float(rng.integers(-4, 5)) + variables[i] * 1.0
        builder.equate(value - value.evaluate(root))  # exact: dyadic
    box = prove(builder, *(root + 1e-4 * rng.normal(size=n)))
    assert box is not None
    assert np.all((box.lower <= root) & (root <= box.upper))
    assert np.all(box.upper - box.lower < 1e-10)


def test_definitions_are_part_of_the_box():
    builder = SystemBuilder()
    x, y = builder.variable("x", -2, 2), builder.variable("y", -2, 2)
    p = builder.define("p", x * y)
    s = builder.define("s", x + y)
    builder.equate(p - 0.5)
    builder.equate(s - 2.0)  # x and y are 1 +- 1 / sqrt 2
    box = prove(builder, 0.3, 1.7)
    assert box is not None
    low, high = ends(box, 0)
    assert (1 - high) ** 2 < Fraction(1, 2) < (1 - low) ** 2
    for k, value in ((2, Fraction(1, 2)), (3, Fraction(2))):
        low, high = ends(box, k)
        assert low <= value <= high


def test_underdetermined_systems_hold_some_inputs():
    builder = system_of(lambda x, y, z: [x * x + y * y + z * z - 1.0], x=(-2, 2), y=(-2, 2), z=(-2, 2))
    box = prove(builder, 0.3, 0.5, 0.9)
    assert box is not None
    assert_narrow(box)
    assert len(box.held) == 2
    (solved,) = set(range(3)) - set(box.held.tolist())
    assert np.all(box.lower[box.held] == box.upper[box.held])
    rest = sum(Fraction(float(box.lower[k])) ** 2 for k in box.held)
    low, high = ends(box, solved)
    assert low**2 + rest < 1 < high**2 + rest


def test_no_equations_no_doubt():
    builder = SystemBuilder()
    x = builder.variable("x", -1, 1)
    builder.at_least_zero(x - 0.25)
    assert prove(builder, 0.5) is not None
    assert prove(builder, 0.2) is None


@pytest.mark.parametrize(
    ("equations", "start"),
    [
        (lambda x, y: [x * x + y * y - 1.0, x - 1.5], (1.2, 0.1)),  # the line misses the circle
        (lambda x, y: [x * x + y * y - 1.0, x - 1.0], (1.0, 0.0)),  # it touches it: a double root
        (lambda x, y: [x * x, y - 0.5], (0.0, 0.5)),
        (lambda x, y: [x * x + 1e-13, y], (0.0, 0.0)),  # no root, though the residual is tiny
        (lambda x, y: [x - y, x * 2.0 - y * 2.0], (0.3, 0.3)),  # dependent equations
        (lambda x, y: [x - 0.5, y - 0.25, x - y - 0.25], (0.5, 0.25)),  # more equations than inputs
        (lambda x, y: [x - y, Polynomial.constant(1.0)], (0.3, 0.3)),
    ],
)
def test_no_certificate(equations, start):
    assert prove(system_of(equations, x=(-2, 2), y=(-2, 2)), *start) is None


@pytest.mark.parametrize("size", [1e3, 1e6, 1e12])
def test_no_certificate_where_newton_seems_to_settle_beside_a_missed_root(size):
    """Parabolas size x^2 + x + c: of two that differ by next to nothing, one meets zero and one does not.

    Residual and Newton step are tiny at either, so only the test over a box tells them apart.
    """
    for share in (1.01, 1.5, 4.0):
        c = share / (4.0 * size)
        discriminant = 1 - 4 * Fraction(size) * Fraction(c)
        assert discriminant < 0
        for start in (0.0, -0.5 / size, -0.4 / size):
            builder = system_of(lambda x, y, c=c: [x * x * size + x + c, y], x=(-1, 1), y=(-1, 1))
            assert prove(builder, start, 0.0) is None
    builder = system_of(lambda x, y: [x * x * size + x - 1.0 / size, y], x=(-1, 1), y=(-1, 1))
    assert prove(builder, 0.6 / size, 0.0) is not None


def test_a_root_outside_the_box_does_not_count():
    assert prove(system_of(circle_and_line, x=(-2, 0.7), y=(-2, 2)), 0.7, 0.7) is None
    assert prove(system_of(circle_and_line, x=(-2, 0.708), y=(-2, 2)), 0.7, 0.7) is not None
    builder = SystemBuilder()
    x = builder.variable("x", -2, 2)
    builder.define("y", x * x, upper=1.9)  # a bound of a defined variable counts as well
    builder.equate(x * x - 2.0)
    assert prove(builder, 1.4) is None


def test_a_root_that_violates_an_inequality_does_not_count():
    for bound, expected in ((0.7, True), (0.7071067811, True), (0.7071067812, False), (0.8, False)):
        builder = system_of(circle_and_line, x=(-2, 2), y=(-2, 2))
        builder.at_least_zero(Polynomial.variable(0) - bound)
        assert (prove(builder, 0.7, 0.7) is not None) is expected


def test_roots_as_near_as_a_millionth_are_told_apart():
    gap = 2.0**-20
    builder = system_of(lambda x: [x * x - x * gap], x=(-1, 1))  # roots 0 and gap
    for root in (0.0, gap):
        box = prove(builder, root + 0.1 * gap)
        assert box is not None
        assert box.lower[0] <= root <= box.upper[0]
        assert box.upper[0] - box.lower[0] < 0.1 * gap


def test_refining_finds_the_nearest_point_of_a_curve():
    system = system_of(lambda x, y: [x * x + y * y - 1.0], x=(-2, 2), y=(-2, 2)).build()
    x = ExistenceTest(StraightLineProgram(system)).refine(np.array([0.6 * 1.001, 0.8 * 1.001]))
    assert x == pytest.approx([0.6, 0.8], abs=1e-9)


def test_refining_gives_up_where_newton_does_not_settle():
    system = system_of(lambda x: [x * x + 1.0], x=(-2, 2)).build()
    assert ExistenceTest(StraightLineProgram(system)).refine(np.array([0.3])) is None
