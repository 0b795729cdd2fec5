"""Settings that can't be used are refused where they are made, and so is what is no grasp."""

from collections.abc import Callable
from dataclasses import fields, replace
from math import inf, nan

import pytest
from holdfast.errors import InputError
from holdfast.mjcf import (
    Grasp,
    HoldSettings,
    Noise,
    grasp_mjcf,
    grasp_quality,
    hold_margin,
    hold_probability,
    hold_test,
    plan_squeeze,
    settings_agreement,
    strengthen,
    trial_mjcf,
)

NUMBERS = [field.name for field in fields(HoldSettings) if field.type in (float, float | None)]


@pytest.mark.parametrize("value", [nan, inf, -1.0, "1", True])
@pytest.mark.parametrize("name", NUMBERS)
def test_every_number_is_finite_and_not_negative(name: str, value: object) -> None:
    with pytest.raises(InputError, match=rf"^HoldSettings\.{name}: must be "):
        HoldSettings(**{name: value})


def test_there_are_numbers_to_check() -> None:
    assert len(NUMBERS) >= 20


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"hold_s": 0.0}, "HoldSettings.hold_s: must be a finite number above 0, not 0.0"),
        ({"planned_effort": 1.5}, "HoldSettings.planned_effort: must be at most 1, not 1.5"),
        ({"noslip_iterations": 2.5}, "noslip_iterations: must be a whole number of at least 0, not 2.5"),
        ({"solver": "newton"}, "HoldSettings.solver: unknown solver 'newton'; did you mean 'Newton'?"),
        ({"must_touch": "some"}, "HoldSettings.must_touch: unknown must touch 'some'"),
        ({"directions": ()}, "HoldSettings.directions: must be a tuple of at least one unit vector"),
        ({"directions": ((0.0, 0.0, 2.0),)}, "directions[0]: must be a unit vector, not (0.0, 0.0, 2.0)"),
        ({"directions": ((0.0, nan, 1.0),)}, "directions[0][1]: must be a finite number, not nan"),
        ({"contact_solref": (0.005,)}, "HoldSettings.contact_solref: must be a tuple of 2 numbers"),
    ],
)
def test_the_message_says_what_is_allowed(changes: dict[str, object], message: str) -> None:
    with pytest.raises(InputError) as caught:
        replace(HoldSettings(), **changes)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    "changes", [{"trials": 0}, {"seed": -1}, {"position_m": nan}, {"friction_share": 1.0}]
)
def test_noise_is_checked_too(changes: dict[str, object]) -> None:
    with pytest.raises(InputError, match=r"^Noise\."):
        replace(Noise(), **changes)


@pytest.mark.parametrize("work", [strengthen, plan_squeeze, grasp_quality, grasp_mjcf, trial_mjcf])
def test_what_is_no_configuration_is_refused(work: Callable[..., object], firm: Grasp) -> None:
    with pytest.raises(InputError, match="configuration: must be a Configuration, as solve gives it"):
        work("upholding")
    with pytest.raises(InputError, match="settings: must be HoldSettings"):
        work(firm.configuration, settings="holdfast")


@pytest.mark.parametrize("work", [hold_test, hold_margin, hold_probability])
def test_what_is_no_grasp_is_refused(work: Callable[..., object], firm: Grasp) -> None:
    with pytest.raises(InputError, match="grasp: must be a Grasp"):
        work(firm.configuration)
    with pytest.raises(InputError, match="settings: must be HoldSettings"):
        work(firm, settings="holdfast")


def test_a_grasp_is_a_configuration_with_a_squeeze(firm: Grasp) -> None:
    with pytest.raises(InputError, match="squeeze: must be a Squeeze"):
        Grasp(firm.configuration, None)
    with pytest.raises(InputError, match="configuration: must be a Configuration"):
        Grasp(firm, firm.squeeze)
    with pytest.raises(InputError, match="load: must be a finite number of at least 0"):
        hold_test(firm, load=nan)
    with pytest.raises(InputError, match="grasp: must be a Grasp"):
        settings_agreement(firm.configuration, hold_test(firm, settings=HoldSettings(hold_s=0.1)))
