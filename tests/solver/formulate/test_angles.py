import numpy as np
import pytest
from holdfast.solver.certify.krawczyk import ExistenceTest
from holdfast.solver.contraction.hc4_canonical import Propagator
from holdfast.solver.enclosure.straight_line import StraightLineProgram
from holdfast.solver.formulate.angles import (
    Angle,
    Turn,
    angle_variable,
    multiple,
    negated,
    sum_of,
    turned,
)
from holdfast.solver.polynomial.canonical import canonical_form
from holdfast.solver.polynomial.system import PolynomialSystem, SystemBuilder

DEG = np.pi / 180
LIMITS = [
    (-0.3, 0.3),
    (0.0, 75 * DEG),
    (0.0, 90 * DEG),
    (-15 * DEG, 15 * DEG),
    (4 * DEG, 75 * DEG),
    (0.2, 1.9),
    (-2.0, 2.0),
    (-3.0, 3.0),
    (0.5, 5.0),
    (2.5, 4.0),
    (-np.pi, np.pi / 2),
    (1.0, 1.002),
    (0.3, 0.3),
    (0.0, 0.0),
]


def one_angle(lower: float, upper: float) -> PolynomialSystem:
    builder = SystemBuilder()
    angle_variable(builder, "a", lower, upper)
    return builder.build()


def certified(system: PolynomialSystem, angle: float) -> bool:
    x = np.array([np.cos(angle), np.sin(angle)])
    return ExistenceTest(StraightLineProgram(system)).prove(x) is not None


def refuted(system: PolynomialSystem, angle: float) -> bool:
    """Whether propagation refutes the surroundings, 1e-12 wide, of an angle."""
    form = canonical_form(system)
    lower, upper = form.lower.copy(), form.upper.copy()
    for k, value in enumerate((np.cos(angle), np.sin(angle))):
        lower[k], upper[k] = max(lower[k], value - 1e-12), min(upper[k], value + 1e-12)
        if lower[k] > upper[k]:
            return True
    return not Propagator(form).contract(lower, upper)


@pytest.mark.parametrize("limits", LIMITS)
def test_limits_admit_exactly_their_arc(limits):
    system = one_angle(*limits)
    lower, upper = limits
    inside = [
        lower,
        upper,
        *np.linspace(lower, upper, 41),
        min(lower + 1e-6, upper),
        max(upper - 1e-6, lower),
    ]
    multiples = [k * np.pi / 2 for k in range(-2, 4) if lower <= k * np.pi / 2 <= upper]
    for angle in [*inside, *multiples]:
        assert certified(system, angle), f"{angle} is within the limits"
        assert not refuted(system, angle)
    gap = 2 * np.pi - (upper - lower)
    for share in (1e-6 / gap, 0.01, 0.3, 0.5, 0.7, 0.99, 1 - 1e-6 / gap):
        assert not certified(system, upper + share * gap), f"{share} of the gap is outside"
        assert refuted(system, upper + share * gap)


@pytest.mark.parametrize("limits", [(-np.pi, np.pi), (-4.0, 4.0), (0.0, 2 * np.pi)])
def test_a_joint_without_end_stops_may_be_anywhere(limits):
    system = one_angle(*limits)
    for angle in np.linspace(-np.pi, np.pi, 33):
        assert certified(system, angle)
        assert not refuted(system, angle)


def evaluated(builder: SystemBuilder, angle: Angle, x: np.ndarray) -> tuple[float, float]:
    return angle.cos.evaluate(x), angle.sin.evaluate(x)


def test_sums_multiples_and_offsets_are_those_of_the_angles(values):
    rng = np.random.default_rng(0)
    for _ in range(20):
        ends = np.sort(rng.uniform(-1.5, 1.5, (2, 2)), axis=1)
        a, b = rng.uniform(ends[:, 0], ends[:, 1])
        builder = SystemBuilder()
        A, B = (angle_variable(builder, name, *e) for name, e in zip("ab", ends, strict=True))
        cases = [
            (sum_of(builder, "sum", A, B), a + b),
            (sum_of(builder, "difference", A, negated(B)), a - b),
            (negated(A), -a),
            *((multiple(builder, f"m{n}", A, n, 0.0), n * a) for n in (1, 2, 3, -1, -2)),
            *((multiple(builder, f"o{n}", B, n, 0.4), n * b + 0.4) for n in (1, 2, -1, -3)),
        ]
        system = builder.build()
        x = np.zeros(system.size)
        x[:4] = np.cos(a), np.sin(a), np.cos(b), np.sin(b)
        x = values(system, x)
        for angle, expected in cases:
            assert evaluated(builder, angle, x) == pytest.approx(
                (np.cos(expected), np.sin(expected)), abs=1e-13
            )
            assert angle.lower - 1e-8 <= expected <= angle.upper + 1e-8
        assert np.all((system.lower <= x) & (x <= system.upper))
        assert max(abs(e.evaluate(x)) for e in (*system.equations, *system.redundant)) < 1e-13
        assert min(g.evaluate(x) for g in system.inequalities) > -1e-13


def test_a_sum_at_both_limits_at_once_is_certified():
    """Zero and right angles, where a cosine or a sine is exactly 1."""
    builder = SystemBuilder()
    A, B = angle_variable(builder, "a", 0.0, np.pi / 4), angle_variable(builder, "b", 0.0, np.pi / 4)
    sum_of(builder, "sum", A, B)
    test = ExistenceTest(StraightLineProgram(builder.build()))
    for a in (0.0, np.pi / 4):
        for b in (0.0, np.pi / 4):
            assert test.prove(np.array([np.cos(a), np.sin(a), np.cos(b), np.sin(b), 0.0, 0.0])) is not None


def test_turns_of_one_variable_add_up_and_others_obey_the_addition_theorems(values):
    rng = np.random.default_rng(1)
    for _ in range(20):
        ratios, offsets = rng.uniform(-2.0, 2.0, 3), rng.uniform(-1.0, 1.0, 3)
        builder = SystemBuilder()
        x, y = builder.variable("x", -0.8, 0.9), builder.variable("y", 0.1, 1.4)
        A, B, C = (
            turned(builder, name, Turn(v, float(r), float(c)))
            for name, v, r, c in zip("abc", (x, x, y), ratios, offsets, strict=True)
        )
        free = angle_variable(builder, "free", -0.4, 0.5)
        at = np.array([rng.uniform(-0.8, 0.9), rng.uniform(0.1, 1.4)])
        a, b, c = ratios * at[[0, 0, 1]] + offsets
        before = len(builder.names)
        both = sum_of(builder, "both", A, B)
        assert len(builder.names) == before + 2 and not any("both" in n for n in builder.names[:before])
        cases = [
            (A, a), (both, a + b), (negated(both), -a - b), (sum_of(builder, "a + c", A, C), a + c),
            (sum_of(builder, "c - a", C, negated(A)), c - a), (sum_of(builder, "a + f", A, free), a + 0.3),
            (sum_of(builder, "a + b + c", both, C), a + b + c), (sum_of(builder, "none", A, negated(A)), 0.0),
        ]  # fmt: skip
        system = builder.build()
        full = np.zeros(system.size)
        full[:2] = at
        (ck,), (sk,) = free.cos.variables, free.sin.variables
        full[ck], full[sk] = np.cos(0.3), np.sin(0.3)
        full = values(system, full)
        for angle, expected in cases:
            assert evaluated(builder, angle, full) == pytest.approx(
                (np.cos(expected), np.sin(expected)), abs=1e-13
            )
            assert angle.lower - 1e-8 <= expected <= angle.upper + 1e-8
        assert np.all((system.lower <= full) & (full <= system.upper))
        assert max(abs(e.evaluate(full)) for e in (*system.equations, *system.redundant)) < 1e-13
        assert min(g.evaluate(full) for g in system.inequalities) > -1e-13


def test_a_turn_and_its_opposite_share_their_functions():
    builder = SystemBuilder()
    x = builder.variable("x", 0.0, 1.0)
    angle = turned(builder, "a", Turn(x, 1.0585, 0.2))
    before = len(builder.names)
    back = turned(builder, "b", Turn(x, -1.0585, -0.2))
    assert len(builder.names) == before
    assert back.cos.terms == angle.cos.terms and back.sin.terms == (-angle.sin).terms
    assert sum_of(builder, "none", angle, back).cos.terms == {(): 1.0}


@pytest.mark.parametrize("limits", LIMITS)
def test_a_turn_within_its_limits_is_certified(limits):
    """Ratio 1 and another one; beyond the limits there is nothing to certify."""
    builder = SystemBuilder()
    x = builder.variable("x", limits[0] - 1e-9, limits[1] + 1e-9)
    for ratio in (1.0, 1.0585, -0.8):
        turned(builder, f"{ratio}", Turn(x, ratio, 0.1))
    test = ExistenceTest(StraightLineProgram(builder.build()))
    point = np.zeros(test.system.size)
    for angle in (*limits, *np.linspace(*limits, 11)):
        point[0] = angle
        assert test.prove(point) is not None
    point[0] = limits[1] + 1e-6
    assert test.prove(point) is None
