"""What a test found out: its verdict, creep within its budget, and how it prints."""

from dataclasses import replace
from enum import Enum

import numpy as np
import pytest
from holdfast.grasping import ReadyGrasp, Trial
from holdfast.grasping.firm_squeeze import Leaning
from holdfast.mjcf import (
    DirectionResult,
    Grasp,
    HoldResult,
    HoldSettings,
    Outcome,
    hold_test,
    plan_squeeze,
    whole_strain,
)
from holdfast.solver import Configuration

from ..conftest import limp

SHORT = HoldSettings(directions=((1.0, 0.0, 0.0), (0.0, -1.0, 0.0)), hold_s=0.6)


def test_creep_stays_within_the_budget(grasp: Grasp) -> None:
    result = hold_test(grasp)
    assert result.is_at_rest
    assert result.creep_m_s <= HoldSettings().creep_budget_m_s
    for direction in result.directions:
        late = direction.times_s >= direction.times_s[-1] - 0.1 - 1e-9
        change = abs(direction.slip_curve_m[-1] - direction.slip_curve_m[late][0])
        assert direction.creep_m_s == pytest.approx(change / 0.1)


def test_without_the_no_slip_solver_it_creeps_beyond_the_budget(leaning: Grasp) -> None:
    slow = replace(SHORT, hold_s=2.0)
    soft = replace(slow, noslip_iterations=0, impratio=1.0)
    firmly, softly = hold_test(leaning, settings=slow), hold_test(leaning, settings=soft)
    assert firmly.is_at_rest
    assert softly.creep_m_s > 10.0 * firmly.creep_m_s
    assert not softly.is_at_rest


def test_a_squeeze_that_moves_the_object_elsewhere_is_no_hold(firm: Grasp) -> None:
    kept = hold_test(firm, settings=SHORT)
    assert kept.kept_place and kept.held
    for shoved in (
        replace(kept, squeeze_slip_m=1.01 * SHORT.slip_limit_m),
        replace(kept, squeeze_rotation_rad=1.01 * SHORT.rotation_limit_rad),
        replace(kept, squeeze_slip_m=float("nan")),
    ):
        assert not shoved.kept_place and not shoved.held


def test_a_squeeze_that_moves_the_object_a_little_holds_but_is_not_firm(firm: Grasp) -> None:
    kept = hold_test(firm, settings=SHORT)
    assert kept.is_firm
    moved = replace(kept, squeeze_slip_m=SHORT.firm_limit_m)
    assert moved.held and not moved.is_firm
    assert replace(kept, squeeze_slip_m=0.99 * SHORT.firm_limit_m).is_firm


def test_a_load_that_takes_much_of_a_limit_leaves_a_hold_that_is_not_firm(firm: Grasp) -> None:
    kept = hold_test(firm, settings=SHORT)
    *others, last = kept.directions
    turn_limit = SHORT.rotation_limit_rad
    assert turn_limit is not None
    for moved, is_firm in (
        (replace(last, slip_m=1.01 * SHORT.firm_share * SHORT.slip_limit_m), False),
        (replace(last, slip_m=0.99 * SHORT.firm_share * SHORT.slip_limit_m), True),
        (replace(last, rotation_rad=1.01 * SHORT.firm_share * turn_limit), False),
    ):
        result = replace(kept, directions=(*others, moved))
        assert result.held and result.is_firm is is_firm
    assert replace(kept, directions=(*others, moved), settings=replace(SHORT, firm_share=1.0)).is_firm


def test_a_squeeze_that_was_chosen_has_to_leave_room(firm: Grasp) -> None:
    kept = hold_test(firm, settings=SHORT)
    for share, chosen_is_firm in ((1.01 * SHORT.firm_share, False), (0.99 * SHORT.firm_share, True)):
        moved = replace(kept, squeeze_slip_m=share * SHORT.firm_limit_m)
        assert Leaning().is_firm(moved)
        assert Leaning(is_chosen=True).is_firm(moved) is chosen_is_firm


def test_a_press_is_narrow_where_it_presses_little_harder_than_asked(firm: Grasp) -> None:
    kept = hold_test(firm, settings=SHORT)
    for reached, is_narrow in (
        (1.01, True),
        (0.99 / SHORT.firm_share, True),
        (1.01 / SHORT.firm_share, False),
    ):
        trial = Trial(ReadyGrasp(firm), replace(kept, kind="press", reached=reached))
        assert trial.is_firmness_known and trial.is_narrow is is_narrow
        assert trial.strain is not None and (trial.strain >= 1.0 or not is_narrow)
    careless = replace(trial.result, settings=replace(SHORT, fingers_first=False), reached=1.01)
    assert not Trial(ReadyGrasp(firm), careless).is_narrow


def test_what_fails_near_its_limits_is_a_near_miss_and_nothing_else_is(firm: Grasp) -> None:
    kept = hold_test(firm, settings=SHORT)
    assert kept.held and not kept.is_near_miss
    times, first = SHORT.near_limit, kept.directions[0]

    def with_first(**changes: object) -> HoldResult:
        return replace(kept, directions=(replace(first, **changes), *kept.directions[1:]))

    slipped = {"outcome": Outcome.SLIPPED, "slip_m": 0.99 * times * SHORT.slip_limit_m}
    near = [
        with_first(**slipped),
        with_first(outcome=Outcome.ROTATED, rotation_rad=0.99 * times * SHORT.rotation_limit_rad),
        with_first(outcome=Outcome.LET_GO, touching=(True, False)),
        replace(kept, squeeze_slip_m=0.99 * times * SHORT.slip_limit_m),
    ]
    far = [
        with_first(outcome=Outcome.SLIPPED, slip_m=1.01 * times * SHORT.slip_limit_m),
        with_first(outcome=Outcome.LET_GO, touching=(False, False)),
        with_first(outcome=Outcome.UNSTABLE),
        replace(kept, squeeze_rotation_rad=1.01 * times * SHORT.rotation_limit_rad),
        replace(with_first(**slipped), directions=()),
        replace(with_first(**slipped), settings=replace(SHORT, near_limit=1.0)),
    ]
    for result in [*near, *far]:
        assert result.is_near_miss == (result in near)
        assert not result.held or not result.directions


def test_a_turn_or_a_press_fails_narrowly_where_it_comes_to_most_of_what_is_asked(
    playing: Configuration, tuning: Configuration
) -> None:
    short = replace(HoldSettings(), hold_s=0.3)
    for configuration, asked, outcome in (
        (tuning, "angle_rad", Outcome.SHORT),
        (playing, "force_N", Outcome.WEAK),
    ):
        grasp = Grasp(configuration, plan_squeeze(configuration))
        result = hold_test(grasp, settings=short)
        assert result.held and result.reached is not None and result.reached >= 1.0
        for share, is_near in ((0.8, True), (0.6, False)):  # of what is asked that is reached
            test = replace(
                configuration.task.test,
                **{asked: getattr(configuration.task.test, asked) * result.reached / share},
            )
            task = replace(configuration.task, test=test)
            other = replace(grasp, configuration=replace(configuration, task=task))
            missed = hold_test(other, settings=short)
            assert missed.directions[0].outcome is outcome
            assert missed.reached == pytest.approx(share, rel=1e-6)
            assert missed.is_near_miss is is_near and not missed.held


def test_strain_is_the_largest_share_of_what_is_thought_safe() -> None:
    normals, settings = np.array([8.0, 5.0, 20.0]), HoldSettings()
    weak = settings.planned_force_N / 5.0
    assert whole_strain(0.0, normals, [], settings) == pytest.approx(weak)
    assert whole_strain(0.6 * settings.firm_limit_m, normals, [0.5], settings) == pytest.approx(0.6)
    assert whole_strain(0.0, normals, [0.1, 0.7], settings) == 0.7
    lost = whole_strain(0.0, np.array([0.0, 5.0]), [], settings)
    assert lost == whole_strain(0.0, normals, [float("nan"), 0.2], settings)
    assert np.isfinite(lost) and lost > 100.0
    assert whole_strain(0.0, np.array([0.0]), [0.1], replace(settings, planned_force_N=0.0)) == 0.1


def test_limits_on_the_grasp_itself_decide(firm: Grasp) -> None:
    settings = HoldSettings(directions=((0.0, 0.0, 1.0),), hold_s=0.2)
    result = hold_test(firm, settings=settings)
    assert result.held
    for sunk in (replace(result, penetration_m=0.002), replace(result, gap_m=0.003)):
        assert sunk.held
        strict = replace(settings, penetration_limit_m=0.001, gap_limit_m=0.002)
        assert not replace(sunk, settings=strict).held


def test_a_result_prints_as_a_line_in_the_words_of_its_test(
    firm: Grasp, playing: Configuration, tuning: Configuration
) -> None:
    short = replace(SHORT, hold_s=0.3)
    held, dropped = hold_test(firm, settings=short), hold_test(limp(firm), settings=short)
    assert str(held) == f"held in 2 of 2 directions, slip {1e3 * held.slip_m:.2f} mm, turn " + (
        f"{np.rad2deg(held.rotation_rad):.2f} deg"
    )
    assert str(dropped).startswith("not held: ") and "held in 0 of 2 directions" in str(dropped)
    moved = replace(held, squeeze_slip_m=1.0)
    assert str(moved).startswith("not held: the squeeze moved the object too far; held in 2 of 2 directions")
    lines = {"turned by ": tuning, "pressed with ": playing}
    for beginning, configuration in lines.items():
        result = hold_test(Grasp(configuration, plan_squeeze(configuration)))
        assert result.held and str(result).startswith(beginning)
        failed = str(hold_test(Grasp(configuration, plan_squeeze(configuration)), load=50.0))
        assert failed.startswith(f"not {beginning.split()[0]}: ")
    for shown in (held, dropped, *held.directions, firm, firm.squeeze, firm.approach):
        assert "\n" not in repr(shown) and len(repr(shown)) < 150


def test_a_test_that_ended_early_prints_what_it_came_to(firm: Grasp) -> None:
    lost = hold_test(limp(firm), settings=SHORT, until_failed=True)
    assert len(lost.directions) == 1 and "held in 0 of 1 directions tried" in str(lost)
    moved = replace(lost, directions=(), squeeze_slip_m=0.0123)
    assert str(moved) == (
        "not held: the squeeze moved the object too far; no direction tried, in the squeeze slip 12.30 mm, "
        f"turn {np.rad2deg(moved.squeeze_rotation_rad):.2f} deg"
    )
    assert str(moved) in moved._repr_html_() and str(moved) in repr(moved)
    assert np.isnan([moved.slip_m, moved.rotation_rad, moved.creep_m_s, moved.creep_rad_s]).all()
    assert not moved.is_at_rest


def test_a_result_is_a_table_in_notebooks(firm: Grasp) -> None:
    result = hold_test(firm, settings=replace(SHORT, hold_s=0.3))
    page = result._repr_html_()
    assert page.count("<tr>") == 1 + len(result.directions)
    assert str(result) in page
    assert "&lt;" in replace(result, kind="lift", directions=(odd(result.directions[0]),))._repr_html_()


def odd(direction: DirectionResult) -> DirectionResult:
    """The direction with an outcome that HTML would misread."""

    class Odd(Enum):
        TAG = "<b>"

    return replace(direction, outcome=Odd.TAG)
