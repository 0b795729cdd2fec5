"""Contraction over vertices: bounds hold, are as tight as known answers, and refute what nothing else does.

That no planted root is lost is tested with the other contractors, in `test_native.py`.
"""

from fractions import Fraction
from itertools import product

import numpy as np
import pytest
from holdfast.solver.linear.vertex_bound import VertexBox, least_value, prepare
from holdfast.solver.linear.vertex_program import vertex_program
from holdfast.solver.linear.vertices import contract_by_vertices
from holdfast.solver.polynomial.exact import evaluate
from holdfast.solver.polynomial.parse import parse_polynomial

Array = np.ndarray


def polynomials(names: str, *texts: str):
    return [parse_polynomial(text, names.split(), "test", "equations") for text in texts]


def contracted(names: str, texts: list[str], low: list[float], high: list[float]):
    p = vertex_program(polynomials(names, *texts), len(names.split()))
    lower, upper = np.array(low, dtype=float), np.array(high, dtype=float)
    return contract_by_vertices(p, lower, upper, 1e-6), lower, upper


def bound(p, lower: Array, upper: Array, k: int, sign: float, y: Array) -> float:
    ends, chords = np.empty((len(p.atom_variable), 2)), np.empty((len(p.power_variable), 3))
    box = VertexBox(lower, upper, ends, chords)
    assert prepare(p, box)
    return least_value(p, box, k, sign, y)


def test_the_range_of_what_is_linear_in_each_variable_is_exact():
    """Brackets of one product form: intervals term by term would be far wider."""
    equations = polynomials("x y z", "(x - 1)*(y + 2)*(z - 3) - x*y")
    p = vertex_program(equations, 3)
    lower, upper = np.array([-1.0, -3.0, 0.5]), np.array([2.0, 4.0, 5.0])
    corners = product(*zip(lower.tolist(), upper.tolist(), strict=True))
    values = [float(evaluate(equations[0], [Fraction(v) for v in corner])) for corner in corners]
    assert bound(p, lower, upper, -1, 1.0, np.array([-1.0])) == pytest.approx(min(values), rel=1e-12)
    assert bound(p, lower, upper, -1, 1.0, np.array([1.0])) == pytest.approx(-max(values), rel=1e-12)


def test_bounds_hold_at_exact_points():
    """The least value of a combination lies below its exact value all over the box, roundings included."""
    rng = np.random.default_rng(5)
    equations = polynomials(
        "x y z",
        "0.1*x**3*y - 0.7*y*z + x**5 - 3.3*z**2 + y - 1/3",
        "x*y*z - 1e-8*x + 123.456*y**4 - z**3",
    )
    p = vertex_program(equations, 3)
    for _ in range(300):
        middle = rng.normal(size=3) * 10.0 ** rng.uniform(-2, 2)
        radius = 10.0 ** rng.uniform(-16, 1, 3)
        lower, upper = middle - radius, middle + radius
        y = np.concatenate([rng.normal(size=2), rng.normal(size=len(p.term_start) - 3)])
        k, sign = int(rng.integers(-1, 3)), float(rng.choice([-1.0, 1.0]))
        least = bound(p, lower, upper, k, sign, y)
        for share in rng.choice([0.0, 1.0, 0.5, 0.3], (8, 3)):
            point = [Fraction(v) for v in np.clip(lower + share * (upper - lower), lower, upper).tolist()]
            # Rows beyond the equations are identities, and so zero whatever their weight.
            value = -sum((Fraction(w) * evaluate(e, point) for w, e in zip(y[:2], equations, strict=True)), 0)
            if k >= 0:
                value += Fraction(sign) * point[k]
            assert Fraction(least) <= value


def test_equations_are_combined():
    """x y + z and x y - z can't both be far from zero on the same side, which neither says alone."""
    found, lower, upper = contracted("x y z", ["x*y + z - 1", "x*y - z + 1"], [-2, -2, -9], [2, 2, 9])
    assert found
    assert lower[2] == pytest.approx(1.0, abs=1e-9)
    assert upper[2] == pytest.approx(1.0, abs=1e-9)


def test_a_box_is_refuted_by_all_products_together():
    """x y, y z and z x can't all be -1 in the unit cube; two by two they can."""
    texts = ["x*y + 0.9", "y*z + 0.9", "z*x + 0.9"]
    assert not contracted("x y z", texts, [-1, -1, -1], [1, 1, 1])[0]
    for pair in (texts[:2], texts[1:], texts[::2]):
        assert contracted("x y z", pair, [-1, -1, -1], [1, 1, 1])[0]


def test_a_bound_of_a_linear_system_is_its_solution():
    found, lower, upper = contracted("x y", ["x + y - 3", "x - y - 1"], [-100, -100], [100, 100])
    assert found
    assert np.all(lower <= [2.0, 1.0])
    assert np.all(upper >= [2.0, 1.0])
    assert np.all(upper - lower < 1e-9)


def test_what_has_too_many_products_is_left_alone():
    names = " ".join(f"x{k}" for k in range(12))
    p = vertex_program(polynomials(names, "*".join(names.split()) + " - 1"), 12)
    assert p.equations == 0
    lower, upper = np.full(12, -2.0), np.full(12, 2.0)
    assert contract_by_vertices(p, lower, upper, 0.02)
    assert np.all(lower == -2.0)
    assert np.all(upper == 2.0)


@pytest.mark.parametrize("end", [1e200, 1e308])
def test_a_box_beyond_what_floats_can_square_is_kept(end):
    found, lower, upper = contracted("x y", ["x**4*y - 1", "x*y**3 - 1"], [-end, -end], [end, end])
    assert found
    assert np.all(lower <= 1.0)
    assert np.all(upper >= 1.0)
