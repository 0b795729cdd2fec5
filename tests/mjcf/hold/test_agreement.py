"""Verdicts that don't depend on the simulator's settings."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from holdfast.mjcf import Grasp, HoldSettings, hold_test, settings_agreement, verdict_agreement
from holdfast.mjcf.hold.lift import Lift
from holdfast.mjcf.hold.trials.agreement import variants
from holdfast.mjcf.model.compiled import compiled_model
from holdfast.mjcf.model.tree import task_tree
from holdfast.mjcf.model.xml import to_text
from holdfast.objects import SIX

from ..conftest import limp

SHORT = HoldSettings(directions=((1.0, 0.0, 0.0), (0.0, -1.0, 0.0)), hold_s=0.6)


def test_other_numerical_settings_agree(grasp: Grasp) -> None:
    agreement = settings_agreement(grasp, hold_test(grasp, settings=SHORT))
    assert agreement.held and agreement.agree
    assert len(agreement.variants) == 3


def test_other_numerical_settings_agree_on_a_drop(firm: Grasp) -> None:
    agreement = settings_agreement(limp(firm), hold_test(limp(firm), settings=SHORT))
    assert not agreement.held and agreement.agree


def test_of_a_lift_that_is_known_two_directions_decide(firm: Grasp, monkeypatch: pytest.MonkeyPatch) -> None:
    """Those in which it gives way first; and what was not tried is said."""
    tried = []
    monkeypatch.setattr(Lift, "holds", lambda lift, direction: tried.append(direction) is None)
    weakest = (SIX[3], SIX[5], *SIX[:3], SIX[4])
    settings = replace(SHORT, directions=SIX)
    agreement = verdict_agreement(firm, True, settings=settings, weakest=weakest)
    assert agreement.directions == weakest[:2] and set(tried) == set(weakest[:2])
    tried.clear()
    assert verdict_agreement(firm, True, settings=settings).directions == ()
    assert set(tried) == set(SIX)


def test_variants_change_how_it_is_computed_and_nothing_of_what(firm: Grasp) -> None:
    """Bodies, contacts and servos are the same to the bit; each variant has another option, once."""
    task = firm.configuration.task
    ours = compiled_model(task, SHORT)
    options = []
    for other in variants(SHORT).values():
        theirs = compiled_model(task, other)
        for name in ("body_mass", "body_inertia", "geom_friction", "geom_solref", "geom_solimp", "geom_size"):
            assert np.array_equal(getattr(ours, name), getattr(theirs, name))
        for name in ("actuator_gainprm", "dof_damping", "dof_armature", "eq_solref", "body_gravcomp"):
            assert np.array_equal(getattr(ours, name), getattr(theirs, name))
        options.append((theirs.opt.timestep, theirs.opt.solver, theirs.opt.noslip_iterations))
        assert (other.directions, other.hold_s, other.slip_limit_m) == (
            SHORT.directions,
            SHORT.hold_s,
            SHORT.slip_limit_m,
        )
    own = (ours.opt.timestep, ours.opt.solver, ours.opt.noslip_iterations)
    changed = [tuple(a != b for a, b in zip(own, option, strict=True)) for option in options]
    assert sorted(changed) == [(False, False, True), (False, True, False), (True, False, False)]
    assert min(option[0] for option in options) == 0.5 * own[0]
    assert min(option[2] for option in options) == 0


def test_a_variant_needs_no_model_compiled_with_it(firm: Grasp) -> None:
    """Options that are set afterwards are those of a model's text, and nothing else depends on them."""
    task = firm.configuration.task
    for settings in (SHORT, *variants(SHORT).values(), replace(SHORT, solver="PGS")):
        ours = compiled_model(task, settings)
        text = to_text(task_tree(task, settings, np.eye(4), floats=True)[0])
        theirs = mujoco.MjModel.from_xml_string(text)
        for name in (name for name in dir(theirs.opt) if not name.startswith("_")):
            assert np.array_equal(getattr(ours.opt, name), getattr(theirs.opt, name)), name
        for name in ("actuator_biasprm", "body_invweight0", "dof_M0", "geom_solref", "qpos0"):
            assert np.array_equal(getattr(ours, name), getattr(theirs, name)), name


def test_settings_without_no_slip_passes_are_compared_with_such(firm: Grasp) -> None:
    """And first-order solvers are never given friction that is much stiffer than the normal direction."""
    without = replace(SHORT, noslip_iterations=0, impratio=1000.0)
    others = variants(without)
    assert others["no-slip passes"].noslip_iterations > 0
    for other in others.values():
        assert other.solver == "Newton" or other.impratio <= 10.0
    assert settings_agreement(firm, hold_test(firm, settings=without)).agree


def test_a_verdict_that_differs_is_no_agreement(firm: Grasp) -> None:
    result = hold_test(limp(firm), settings=SHORT)
    claimed = replace(result, directions=hold_test(firm, settings=SHORT).directions, squeeze_slip_m=0.0)
    claimed = replace(claimed, squeeze_rotation_rad=0.0)
    assert claimed.held
    assert not settings_agreement(limp(firm), claimed).agree
