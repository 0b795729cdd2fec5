"""What Newton's method proves from within a box lies in that box, and solves the system."""

import numpy as np
import pytest
from holdfast.solver.certify.krawczyk import ExistenceTest
from holdfast.solver.certify.newton_in_box import solve_in_box
from holdfast.solver.enclosure.straight_line import StraightLineProgram
from holdfast.solver.polynomial.system import PolynomialSystem, SystemBuilder


def sphere_and_plane(least_z: float = -2.0) -> PolynomialSystem:
    """The circle x^2 + y^2 + z^2 = 1, x + y + z = 1, with w = x y and z at least some value."""
    builder = SystemBuilder()
    x, y, z = (builder.variable(name, -2, 2) for name in "xyz")
    builder.define("w", x * y)
    builder.equate(x * x + y * y + z * z - 1.0)
    builder.equate(x + y + z - 1.0)
    builder.at_least_zero(z - least_z)
    return builder.build()


def box_around(system: PolynomialSystem, x: list[float], radius: float) -> tuple[np.ndarray, np.ndarray]:
    lower, upper = system.lower.copy(), system.upper.copy()
    lower[:3], upper[:3] = np.array(x) - radius, np.array(x) + radius
    return lower, upper


@pytest.mark.parametrize("seed", range(20))
def test_what_is_proved_lies_in_the_box_and_solves_the_system(seed):
    rng = np.random.default_rng(seed)
    system = sphere_and_plane()
    test = ExistenceTest(StraightLineProgram(system))
    a, b = np.array([1, -1, 0]) / np.sqrt(2), np.array([1, 1, -2]) / np.sqrt(6)
    angle = rng.uniform(0, 2 * np.pi)
    solution = 1 / 3 + np.sqrt(2 / 3) * (a * np.cos(angle) + b * np.sin(angle))
    lower, upper = box_around(system, solution + rng.uniform(-0.04, 0.04, 3), 0.05)
    proved = solve_in_box(test, rng.uniform(lower, upper), lower, upper)
    assert proved is not None
    x, y, z, w = proved.middle
    assert x * x + y * y + z * z == pytest.approx(1.0, abs=1e-12)
    assert x + y + z == pytest.approx(1.0, abs=1e-12)
    assert w == pytest.approx(x * y, abs=1e-12)
    assert np.all(proved.lower >= lower)
    assert np.all(proved.upper <= upper)


def test_nothing_is_proved_in_a_box_without_a_solution():
    system = sphere_and_plane()
    lower, upper = box_around(system, [0.9, 0.9, 0.9], 0.3)
    assert (
        solve_in_box(ExistenceTest(StraightLineProgram(system)), 0.5 * (lower + upper), lower, upper) is None
    )


def test_inequalities_hold_as_well():
    system = sphere_and_plane(least_z=0.5)
    lower, upper = box_around(system, [1.0, 0.0, 0.3], 0.5)
    proved = solve_in_box(
        ExistenceTest(StraightLineProgram(system)), np.array([1.0, 0.0, 0.0, 0.0]), lower, upper
    )
    assert proved is not None
    assert proved.lower[2] >= 0.5


def test_a_solution_beyond_a_cut_in_a_defined_variable_does_not_count():
    system = sphere_and_plane()
    test = ExistenceTest(StraightLineProgram(system))
    lower, upper = box_around(system, [1.0, 0.0, 0.0], 0.05)
    assert solve_in_box(test, 0.5 * (lower + upper), lower, upper) is not None
    lower[3] = 0.5  # x y is near zero here
    assert solve_in_box(test, 0.5 * (lower + upper), lower, upper) is None
