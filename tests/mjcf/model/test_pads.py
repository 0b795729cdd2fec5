"""Contacts of a squeeze in a model: what files say, and what a pad does when it is pressed."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from holdfast.mjcf import Grasp, HoldSettings, PressedPads, trial_mjcf
from holdfast.mjcf.hold.lift import Lift
from holdfast.mjcf.model import compiled_model


def test_the_text_and_the_compiled_model_have_the_same_contacts(firm: Grasp) -> None:
    task, settings = firm.configuration.task, firm.squeeze.settings
    text = trial_mjcf(firm.configuration, settings=settings, pads=firm.squeeze.pads)
    written = mujoco.MjModel.from_xml_string(text)
    compiled = compiled_model(task, settings, firm.squeeze.pads)
    assert written.ngeom == compiled.ngeom
    touches = compiled.geom_contype > 0
    for name in ("geom_priority", "geom_friction", "geom_solimp"):
        ours, theirs = getattr(compiled, name)[touches], getattr(written, name)[touches]
        assert theirs == pytest.approx(ours, rel=1e-9), name
    # The same springs in N/m: the text's begin in the grasp, where bent fingers weigh otherwise.
    assert _springs(written)[touches] == pytest.approx(_springs(compiled)[touches], rel=1e-9)
    assert {0, 1, 2} == set(compiled.geom_priority[touches].tolist())


def _springs(model: mujoco.MjModel) -> np.ndarray:
    """Stiffness (n_geoms,) of contacts with the object, times a share that is the same in both models."""
    weights = model.body_invweight0[model.geom_bodyid, 0] + model.body_invweight0[model.body("object").id, 0]
    solref = model.geom_solref[:, 0]
    return np.where(solref < 0.0, -solref / weights, solref)


def test_fingers_resist_spin_by_their_arm_and_what_else_touches_by_the_smallest(firm: Grasp) -> None:
    task, settings = firm.configuration.task, firm.squeeze.settings
    mu = settings.sliding_friction(task.object)
    pads = PressedPads(np.array([10.0, 20.0]), np.array([1e-3, 1e-3]), np.array([2e-3, 3e-3]))
    model = compiled_model(task, settings, pads)
    for contact, arm_m in zip(task.contacts, pads.spin_arms_m, strict=True):
        body = model.body(task.hand.links[contact.hand.link].name).id
        of_link = model.geom_friction[model.geom_bodyid == body]
        assert of_link[:, 1] == pytest.approx(mu * arm_m) and of_link[:, 0] == pytest.approx(mu)
    of_object = model.geom_friction[model.geom_bodyid == model.body("object").id]
    assert of_object[:, 1] == pytest.approx(mu * 2e-3)


def test_contacts_press_in_simulation_as_planned(grasp: Grasp) -> None:
    lift = Lift(grasp, replace(grasp.squeeze.settings, timestep_s=0.004))
    lift.squeeze()
    assert lift.simulation.normal_forces() == pytest.approx(grasp.squeeze.preload[:, 0], rel=0.1)


def test_without_soft_pads_contacts_are_as_the_settings_have_them(firm: Grasp) -> None:
    stiff = HoldSettings(soft_pads=False)
    model = compiled_model(firm.configuration.task, stiff, firm.squeeze.pads)
    ours = model.geom_priority == 2
    assert model.geom_solref[ours] == pytest.approx(np.tile(stiff.contact_solref, (ours.sum(), 1)))
