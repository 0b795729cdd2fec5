"""An object other than planned: the same as settings say it, and as other ways of building it give."""

from dataclasses import replace

import numpy as np
import pytest
from holdfast.errors import InputError
from holdfast.mjcf import Burden, Disturbance, Grasp, HoldSettings, Placement, hold_disturbed, hold_test
from holdfast.mjcf.hold.hold import passes
from holdfast.mjcf.model import compiled_model
from holdfast.objects import load_task


def test_no_disturbance_is_the_plain_test(firm: Grasp) -> None:
    (found,) = hold_disturbed(firm, Disturbance())
    plain = hold_test(firm)
    assert found.slip_m == plain.slip_m and found.rotation_rad == plain.rotation_rad
    assert found.held == plain.held


def test_each_load_is_as_if_it_were_tried_alone(leaning: Grasp) -> None:
    settings = replace(HoldSettings(), directions=((0.0, 0.0, 1.0), (1.0, 0.0, 0.0)))
    loads = (1.0, 2.0, 4.0)
    found = hold_disturbed(leaning, Disturbance(), settings=settings, loads=loads)
    alone = [hold_test(leaning, settings=settings, load=load) for load in loads]
    assert [result.slip_m for result in found] == [result.slip_m for result in alone]


def test_mass_and_friction_are_as_the_settings_have_them(firm: Grasp) -> None:
    """An oracle: the model compiled from the text of an object of that mass."""
    obj = firm.configuration.task.object
    (found,) = hold_disturbed(firm, Disturbance(Burden(1.6), friction_factor=0.8))
    settings = replace(HoldSettings(), object_mass_kg=1.6 * obj.inertia.mass, friction=0.8 * obj.friction)
    expected = hold_test(firm, settings=settings)
    assert found.slip_m == pytest.approx(expected.slip_m, rel=1e-3)
    assert found.rotation_rad == pytest.approx(expected.rotation_rad, rel=1e-3)
    assert found.slip_m != hold_test(firm).slip_m


def test_the_centre_of_mass_is_moved(firm: Grasp) -> None:
    """An oracle: an object whose centre of mass lies there. Farther off, it turns more."""
    configuration = firm.configuration
    offset = np.array([0.02, 0.0, 0.0])
    task = configuration.task
    moved = tuple(
        replace(part, inertia=replace(part.inertia, centre=part.inertia.centre + offset))
        for part in task.object.parts
    )
    other = task.__class__(
        name=task.name,
        hand=task.hand,
        object=replace(task.object, parts=moved),
        contacts=task.contacts,
        limits=task.limits,
        test=task.test,
    )
    squeezed = replace(firm, configuration=replace(configuration, task=other), known_approach=firm.approach)
    (found,) = hold_disturbed(firm, Disturbance(Burden(com_offset_m=offset)))
    assert found.rotation_rad == pytest.approx(hold_test(squeezed).rotation_rad, rel=1e-3)
    (farther,) = hold_disturbed(firm, Disturbance(Burden(com_offset_m=3.0 * offset)))
    assert farther.rotation_rad > found.rotation_rad


def test_a_placement_is_that_of_trials_with_noise(leaning: Grasp) -> None:
    placement = Placement(np.array([0.004, 0.0, 0.0]), np.eye(3))
    (found,) = hold_disturbed(leaning, Disturbance(placement=placement))
    assert found.held == passes(leaning, placement=placement)
    assert found.squeeze_slip_m != hold_test(leaning).squeeze_slip_m


def test_what_fails_is_not_tried_with_more(firm: Grasp) -> None:
    found = hold_disturbed(firm, Disturbance(friction_factor=0.2), loads=(1.0, 2.0), until_failed=True)
    assert not found[0].held and found[1] is found[0]


@pytest.mark.parametrize(
    ("changes", "name"),
    [({"mass_factor": 0.0}, "mass_factor"), ({"com_offset_m": np.zeros(2)}, "com_offset_m")],
)
def test_misuse_is_named(changes: dict[str, object], name: str) -> None:
    with pytest.raises(InputError, match=name):
        Burden(**changes)  # type: ignore[arg-type]


def test_an_object_whose_centre_of_mass_is_its_origin_can_be_unbalanced() -> None:
    """MuJoCo compiles such a body in a way of its own."""
    task = load_task("family:box:5")
    assert np.abs(task.object.inertia.centre).max() < 1e-9
    plain = compiled_model(task, HoldSettings())
    model = compiled_model(task, HoldSettings(), burden=Burden(1.5, np.array([0.01, 0.0, 0.0])))
    body = model.body("object")
    assert body.ipos == pytest.approx([0.01, 0.0, 0.0])
    assert body.mass[0] == pytest.approx(1.5 * plain.body("object").mass[0])
