"""Laws that a hold test must obey, whatever the numbers."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import holdfast.mjcf.hold.lift as lift_module
import mujoco
import numpy as np
import pytest
from holdfast.mjcf import (
    DirectionResult,
    Grasp,
    HoldResult,
    HoldSettings,
    Outcome,
    hand_mjcf,
    hold_test,
    hold_test_if_passed,
)
from holdfast.mjcf.hold.hold import passes
from holdfast.mjcf.model import to_text
from holdfast.mjcf.model.tree import task_tree

# Three directions that differ and a shorter time are enough for a law.
SHORT = HoldSettings(directions=((1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, 1.0)), hold_s=0.6)


def with_targets(grasp: Grasp, targets: np.ndarray) -> Grasp:
    return replace(grasp, squeeze=replace(grasp.squeeze, targets=targets))


def same(a: HoldResult, b: HoldResult) -> bool:
    pairs = zip(a.directions, b.directions, strict=True)
    return np.array_equal(a.squeezed_qpos, b.squeezed_qpos) and all(
        x.outcome is y.outcome
        and np.array_equal(x.qpos, y.qpos)
        and np.array_equal(x.slip_curve_m, y.slip_curve_m)
        and np.array_equal(x.rotation_curve_rad, y.rotation_curve_rad)
        for x, y in pairs
    )


def test_a_firm_pinch_holds_the_scalpel_in_all_six_directions(firm: Grasp) -> None:
    result = hold_test(firm)
    assert [direction.outcome for direction in result.directions] == [Outcome.HELD] * 6
    assert result.held
    assert {direction.gravity for direction in result.directions} == set(HoldSettings().directions)
    assert 0.0 < result.slip_m < 0.005
    assert 0.0 < result.rotation_rad < np.deg2rad(10.0)
    assert result.settings == HoldSettings()
    for direction in result.directions:
        assert 0.2 <= direction.times_s[-1] <= 1.0
        assert len(direction.times_s) == len(direction.slip_curve_m) == len(direction.qpos)
        assert direction.slip_m == direction.slip_curve_m.max()
        # At rest, not merely slow: friction that creeps would hold in no longer test.
        assert abs(direction.rotation_curve_rad[-1] - direction.rotation_curve_rad[-6]) < np.deg2rad(0.01)


def test_what_is_at_rest_ends_early_and_changes_nothing(grasp: Grasp) -> None:
    early, whole = (hold_test(grasp, settings=HoldSettings(rest_s=rest_s)) for rest_s in (0.1, None))
    assert all(direction.times_s[-1] == pytest.approx(1.0) for direction in whole.directions)
    assert min(direction.times_s[-1] for direction in early.directions) < 0.7
    for short, long in zip(early.directions, whole.directions, strict=True):
        count = len(short.qpos)
        assert short.outcome is long.outcome
        # Squeezes settle as early, and leave the object where it creeps to at most in the rest of the time.
        apart_m = np.abs(short.slip_curve_m - long.slip_curve_m[:count])
        assert apart_m.max() <= HoldSettings().creep_budget_m_s * HoldSettings().settle_s
        # What it would still have done is no more than it may creep.
        later_m = np.abs(long.slip_curve_m[count - 1 :] - short.slip_curve_m[-1])
        assert later_m.max() <= HoldSettings().creep_budget_m_s * 1.0


def test_what_still_moves_does_not_end_early(firm: Grasp) -> None:
    """A budget that nothing keeps, and one that everything does: it ends after the first swing at once."""
    strict = hold_test(firm, settings=replace(SHORT, creep_budget_m_s=1e-12))
    assert all(direction.times_s[-1] == pytest.approx(SHORT.hold_s) for direction in strict.directions)
    lavish = hold_test(firm, settings=replace(SHORT, creep_budget_m_s=1.0, creep_budget_rad_s=10.0))
    assert all(direction.times_s[-1] == pytest.approx(0.2) for direction in lavish.directions)


def test_a_hand_that_does_not_squeeze_drops_the_object(grasp: Grasp) -> None:
    result = hold_test(with_targets(grasp, grasp.configuration.state.q), settings=SHORT)
    assert not any(direction.held for direction in result.directions)


def test_the_verdict_alone_is_that_of_the_whole_test(grasp: Grasp) -> None:
    """It stops at the first failure: verdicts must not depend on what comes after."""
    heavy = replace(SHORT, object_mass_kg=60.0 * grasp.configuration.task.object.inertia.mass)
    tested = [(grasp, SHORT), (grasp, heavy), (with_targets(grasp, grasp.configuration.state.q), SHORT)]
    verdicts = [passes(tried, settings=settings) for tried, settings in tested]
    assert verdicts == [hold_test(tried, settings=settings).held for tried, settings in tested]
    assert verdicts == [True, False, False]


def test_an_opening_hand_drops_the_object(grasp: Grasp) -> None:
    task = grasp.configuration.task
    opened = np.clip(0.0, *task.hand.limits.T)
    result = hold_test(with_targets(grasp, opened), settings=SHORT)
    assert not any(direction.held for direction in result.directions)
    assert not any(any(direction.touching) for direction in result.directions)


def test_a_dropped_object_ends_the_test_early(firm: Grasp) -> None:
    result = hold_test(with_targets(firm, firm.configuration.state.q), settings=SHORT)
    for direction in result.directions:
        assert direction.outcome in (Outcome.SLIPPED, Outcome.ROTATED)
        assert direction.times_s[-1] < SHORT.hold_s
        assert direction.slip_m > SHORT.slip_limit_m or direction.rotation_rad > SHORT.rotation_limit_rad


def test_a_welded_object_holds(leaning: Grasp, monkeypatch: pytest.MonkeyPatch) -> None:
    weld = '<equality><weld body1="palm" body2="object" solref="0.004 1" />'
    configuration = leaning.configuration
    root, _ = task_tree(configuration.task, SHORT, configuration.state.T_palm_object, floats=True)
    text = to_text(root).replace("<equality>", weld)
    monkeypatch.setattr(lift_module, "compiled_model", lambda *_, **__: mujoco.MjModel.from_xml_string(text))
    assert hold_test(leaning, settings=SHORT).held


def test_without_gravity_the_squeeze_holds(grasp: Grasp) -> None:
    result = hold_test(grasp, settings=replace(SHORT, gravity=0.0))
    assert result.held
    assert result.slip_m < 5e-5  # pads come to rest slowly


@pytest.mark.parametrize("friction", [0.45, 0.6])
def test_twice_the_load_never_makes_a_failed_grasp_hold(grasp: Grasp, friction: float) -> None:
    settings = replace(SHORT, friction=friction)
    once, twice = (
        hold_test(grasp, settings=settings),
        hold_test(grasp, settings=replace(settings, gravity=19.62)),
    )
    for light, heavy in zip(once.directions, twice.directions, strict=True):
        assert light.held or not heavy.held


@pytest.mark.parametrize("friction", [0.3, 0.6])
def test_doubled_friction_never_makes_a_held_grasp_fail(grasp: Grasp, friction: float) -> None:
    rough = hold_test(grasp, settings=replace(SHORT, friction=2.0 * friction))
    smooth = hold_test(grasp, settings=replace(SHORT, friction=friction))
    for a, b in zip(smooth.directions, rough.directions, strict=True):
        assert b.held or not a.held


def test_too_little_friction_drops_the_object(grasp: Grasp) -> None:
    assert not any(d.held for d in hold_test(grasp, settings=replace(SHORT, friction=0.2)).directions)


def test_equal_input_gives_equal_bits_at_any_number_of_workers(firm: Grasp, leaning: Grasp) -> None:
    grasps = [firm, leaning, firm]
    alone = [hold_test(grasp, settings=SHORT) for grasp in grasps]
    for workers in (1, 2):
        with ThreadPoolExecutor(workers) as pool:
            together = list(pool.map(lambda grasp: hold_test(grasp, settings=SHORT), grasps))
        assert all(same(a, b) for a, b in zip(alone, together, strict=True))


def test_directions_do_not_influence_each_other(firm: Grasp) -> None:
    whole = hold_test(firm, settings=SHORT)
    reordered = hold_test(firm, settings=replace(SHORT, directions=SHORT.directions[::-1]))
    for a, b in zip(whole.directions, reordered.directions[::-1], strict=True):
        assert np.array_equal(a.qpos, b.qpos)


def centre_of_hand(grasp: Grasp, joints: np.ndarray) -> np.ndarray:
    """Centre of mass (3,) of the hand's links in the palm frame, by MuJoCo."""
    model = mujoco.MjModel.from_xml_string(hand_mjcf(grasp.configuration.task.hand))
    data = mujoco.MjData(model)
    data.qpos[:] = joints
    mujoco.mj_forward(model, data)
    return np.array(data.subtree_com[0])


def sag_m(grasp: Grasp, entry: DirectionResult) -> float:
    """How far the hand has moved along gravity."""
    first, last = (centre_of_hand(grasp, entry.qpos[k, :-7]) for k in (0, -1))
    return float((last - first) @ entry.gravity)


def test_a_weighty_hand_sags_the_way_gravity_pulls(firm: Grasp) -> None:
    free, weighty = (hold_test(firm, settings=replace(SHORT, hand_weight=w)) for w in (False, True))
    for light, heavy in zip(free.directions, weighty.directions, strict=True):
        assert sag_m(firm, heavy) > sag_m(firm, light) + 5e-5


def test_a_test_until_it_fails_is_the_beginning_of_the_whole_test(grasp: Grasp) -> None:
    """With hardly any friction, little and much: the same verdict, and the same bits as far as it goes."""
    for friction in (0.05, 0.3, 2.0):
        settings = replace(SHORT, friction=friction)
        whole = hold_test(grasp, settings=settings)
        short = hold_test(grasp, settings=settings, until_failed=True)
        assert short.held is whole.held
        assert all(entry.held for entry in short.directions[:-1])
        count = len(short.directions)
        assert count == len(whole.directions) if whole.held else count <= len(whole.directions)
        assert same(short, replace(whole, directions=whole.directions[:count]))
        passed = hold_test_if_passed(grasp, settings=settings)
        assert same(passed, whole) if passed is not None else not whole.held
