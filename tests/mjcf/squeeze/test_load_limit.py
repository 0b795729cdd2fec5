"""What keeps a grasp from carrying its load: what is said to be enough is enough, and less is not."""

from dataclasses import replace

import pytest
from holdfast.mjcf import HoldSettings, LoadLimit, load_limit
from holdfast.mjcf.squeeze.climbing.strengthen import strengthen
from holdfast.objects import load_task
from holdfast.solver import Configuration, solve

TASK = load_task("upholding")


@pytest.fixture(scope="module")
def solved() -> tuple[Configuration, ...]:
    return tuple(solve(TASK, candidates=8, seed=4).configurations)


@pytest.fixture(scope="module")
def strong(solved: tuple[Configuration, ...]) -> Configuration:
    reached = (strengthen(configuration, settings=HoldSettings()) for configuration in solved)
    return next(one for one in reached if load_limit(one) is None)


def limit(configuration: Configuration, settings: HoldSettings) -> LoadLimit:
    found = load_limit(configuration, settings=settings)
    assert found is not None
    return found


def test_efforts_that_are_said_to_do_will_do(strong: Configuration) -> None:
    mass_kg = 40.0 * TASK.object.inertia.mass
    heavy = HoldSettings(object_mass_kg=mass_kg, planned_effort=0.2)
    found = limit(strong, heavy)
    assert 0.0 < found.load_factor < found.wanted == heavy.planned_load
    assert found.servos and set(found.servos) <= set(TASK.hand.independent_names)
    assert found.efforts is not None and found.efforts == pytest.approx(found.wanted / found.load_factor)
    assert "servos of" in str(found) and found.servos[0] in str(found)
    # As much weight less is the same as so much more effort.
    lighter = replace(heavy, object_mass_kg=mass_kg / found.efforts / 1.001)
    assert load_limit(strong, settings=lighter) is None
    still = replace(heavy, object_mass_kg=mass_kg / found.efforts / 0.98)
    assert load_limit(strong, settings=still) is not None


def test_friction_that_is_said_to_do_will_do_and_less_will_not(solved: tuple[Configuration, ...]) -> None:
    enough = [
        (c, found.enough_friction)
        for c in solved
        if (found := load_limit(c, settings=HoldSettings())) is not None and found.enough_friction is not None
    ]
    assert enough
    for configuration, friction in enough:
        assert friction > TASK.object.friction
        assert load_limit(configuration, settings=HoldSettings(friction=friction)) is None
        assert load_limit(configuration, settings=HoldSettings(friction=friction - 0.021)) is not None


def test_where_no_forces_balance_no_servo_is_blamed(solved: tuple[Configuration, ...]) -> None:
    ice = HoldSettings(friction=0.01)
    found = limit(solved[0], ice)
    assert found.load_factor < 1e-3 and found.servos == () and found.efforts is None
    assert "don't balance the weight" in str(found)
    far = replace(found, enough_friction=None)
    assert "it takes other regions" in str(far)
