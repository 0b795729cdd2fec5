"""From a configuration to a grasp: what is promised of it, and what a refusal says."""

from dataclasses import replace

import numpy as np
import pytest
from holdfast.grasping import ReadyGrasp, Refusal, Trial, clear, make_grasp, squeeze_grasp, try_hold
from holdfast.mjcf import HoldSettings, NotHoldable, fingers_first, hold_test, preset_settings
from holdfast.objects import load_task
from holdfast.retraction import (
    ClearConfiguration,
    RetractionFailure,
    RetractionSettings,
    compute_clearance_by_mujoco,
)
from holdfast.solver import Configuration, ContactManifold, solve

TASK = load_task("upholding")


@pytest.fixture(scope="module")
def configurations() -> tuple[Configuration, ...]:
    return tuple(solve(TASK, candidates=4, seed=2).configurations)


@pytest.fixture(scope="module")
def made(configurations: tuple[Configuration, ...]) -> list[ReadyGrasp | Refusal]:
    return [make_grasp(configuration) for configuration in configurations]


@pytest.fixture(scope="module")
def grasp(made: list[ReadyGrasp | Refusal]) -> ReadyGrasp:
    return next(one for one in made if isinstance(one, ReadyGrasp))


def test_a_grasp_is_certified_clear_and_on_its_contacts(made: list[ReadyGrasp | Refusal]) -> None:
    grasps = [one for one in made if isinstance(one, ReadyGrasp)]
    assert len(grasps) >= 3
    for one in grasps:
        configuration, clearing = one.configuration, one.clearing
        assert configuration.certified and clearing is not None and clearing.is_clear
        assert clearing.configuration is configuration and clearing.approach is one.approach
        assert ContactManifold(TASK).error_m(configuration.state) < 1e-9
        # By another library than the one that retraction relies on.
        table = compute_clearance_by_mujoco(TASK, configuration.state)
        assert all(pair.distance_m > -1.1e-4 for pair in table.pairs)
        assert one.approach.waypoints[-1] == pytest.approx(configuration.state.q)
        assert len(str(one)) < 200 and "certified" in str(one)


def test_without_settings_the_task_s_own_directions_count() -> None:
    task = load_task("transportation")
    (configuration, *_) = solve(task, candidates=1, seed=1).configurations
    grasp = squeeze_grasp(configuration)
    assert isinstance(grasp, ReadyGrasp)
    assert grasp.squeeze.settings == preset_settings("holdfast", task)
    assert grasp.squeeze.settings.directions != HoldSettings().directions


def test_the_same_configuration_gives_the_same_grasp(
    configurations: tuple[Configuration, ...], made: list[ReadyGrasp | Refusal]
) -> None:
    again, first = make_grasp(configurations[0]), made[0]
    assert isinstance(again, ReadyGrasp) and isinstance(first, ReadyGrasp)
    assert np.array_equal(again.configuration.state.q, first.configuration.state.q)
    assert np.array_equal(again.squeeze.targets, first.squeeze.targets)


def test_clearing_alone_leaves_what_is_clear_where_it_is(grasp: ReadyGrasp) -> None:
    clearing = clear(grasp.configuration)
    assert clearing.configuration is grasp.configuration
    assert (clearing.status, clearing.route, clearing.moved, clearing.restarts) == (
        "clear",
        "unmoved",
        0.0,
        0,
    )
    assert not clearing.strengthened and clearing.before_m == clearing.after_m


def test_the_turns_add_up(made: list[ReadyGrasp | Refusal]) -> None:
    for one in made:
        clearing = one.clearing
        assert clearing is not None and 1 <= len(clearing.outcomes) <= 4
        assert all(isinstance(outcome, ClearConfiguration) for outcome in clearing.outcomes[:-1])
        cleared = [outcome for outcome in clearing.outcomes if isinstance(outcome, ClearConfiguration)]
        assert clearing.moved == sum(outcome.moved for outcome in cleared)
        retracted = any(outcome.status == "retracted" for outcome in cleared)
        assert clearing.status == ("retracted" if retracted else "clear" if clearing.is_clear else "failed")


def test_what_cannot_be_cleared_is_refused_for_that_reason(
    configurations: tuple[Configuration, ...],
) -> None:
    wide = RetractionSettings(margin_m=0.5, restarts=1)
    refusal = make_grasp(configurations[0], retraction=wide)
    assert isinstance(refusal, Refusal) and isinstance(refusal.reason, RetractionFailure)
    assert refusal.clearing is not None and refusal.clearing.approach is None
    assert refusal.clearing.status == "failed" and refusal.clearing.route is None
    assert refusal.quality is None and str(refusal).startswith("not clear: ")


def test_what_no_forces_hold_is_refused_for_that_reason(grasp: ReadyGrasp) -> None:
    """A load of some hundred times the weight: the servos are too weak for it."""
    heavy = replace(preset_settings("holdfast", TASK), object_mass_kg=400.0 * TASK.object.inertia.mass)
    refusal = squeeze_grasp(grasp.configuration, settings=heavy)
    assert isinstance(refusal, Refusal) and isinstance(refusal.reason, NotHoldable)
    assert refusal.quality is not None and str(refusal).startswith("no squeeze: ")


def test_a_trial_is_the_hold_test(grasp: ReadyGrasp) -> None:
    trial = try_hold(grasp)
    expected = hold_test(grasp.grasp)
    assert trial.result.settings == grasp.squeeze.settings
    assert trial.held == expected.held and trial.result.slip_m == expected.slip_m
    assert trial.margin is None and trial.agreement is None and trial.robustness is None
    assert len(str(trial)) < 100


def test_extras_are_for_what_held_unless_asked_for(grasp: ReadyGrasp) -> None:
    """A load that no squeeze holds, in one direction and for a moment."""
    heavy = replace(
        grasp.squeeze.settings, gravity=2000.0, directions=((0.0, 0.0, 1.0),), hold_s=0.1, margin_cap=2.0
    )
    failed = try_hold(grasp, settings=heavy, margin=True, agreement=True)
    assert not failed.held and failed.margin is None and failed.agreement is None
    asked = try_hold(grasp, settings=heavy, margin=True, of_failed=True)
    assert asked.margin is not None and asked.margin < 1.0


def test_a_squeeze_that_moves_the_object_gives_way_to_one_that_does_not() -> None:
    """Of grasps that one finger first would push off, some are kept by another squeeze; none gets worse."""
    settings = replace(
        preset_settings("holdfast", TASK),
        timestep_s=0.004,
        noslip_iterations=0,
        impratio=1000.0,
        hold_s=0.5,
        directions=((0.0, 0.0, -1.0), (1.0, 0.0, 0.0)),
    )
    changed = 0
    for configuration in solve(TASK, candidates=3, seed=9303).configurations:
        grasp = make_grasp(configuration, settings=settings)
        assert isinstance(grasp, ReadyGrasp)
        trial = try_hold(grasp, settings=settings, fingers=True)
        chosen = trial.grasp.squeeze
        plain = hold_test(grasp.grasp, settings=settings)
        assert trial.held or not plain.held
        # What is held narrowly is strained beyond what is thought safe; what was not tried is not known.
        assert (trial.strain is None) is not trial.held
        assert not trial.is_narrow or (trial.strain is not None and trial.strain >= 1.0)
        assert Trial(trial.grasp, trial.result).strain is None
        assert trial.result.held == hold_test(trial.grasp.grasp, settings=settings).held
        changed += chosen is not grasp.squeeze
        if chosen is grasp.squeeze:
            assert chosen.rule == ""
            continue
        assert chosen.rule and trial.held and not trial.is_narrow
        order = fingers_first(grasp.grasp, settings=settings)
        assert not plain.held or not all(entry.kept for entry in order)
        assert chosen.load_factor >= 1.0 - 1e-5 or chosen.load_factor >= grasp.squeeze.load_factor - 1e-9
    assert changed > 0
