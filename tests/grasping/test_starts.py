"""Where grasps begin: the strongest of the configurations that were solved, the same for the same seed."""

import numpy as np
import pytest
from holdfast.grasping import solve_for_starts, strongest_first
from holdfast.mjcf import preset_settings, start_strengths
from holdfast.mjcf.squeeze.climbing.grasp_strength import Strength, StrengthMeasure
from holdfast.objects import load_task
from holdfast.solver import Configuration, Progress, State, solve

TASK = load_task("upholding")
SETTINGS = preset_settings("holdfast", TASK)


@pytest.fixture(scope="module")
def configurations() -> tuple[Configuration, ...]:
    return tuple(solve(TASK, candidates=24, seed=5).configurations)


def same(a: tuple[Configuration, ...], b: tuple[Configuration, ...]) -> bool:
    pairs = zip(a, b, strict=True)
    return all(np.array_equal(x.state.q, y.state.q) for x, y in pairs)


def steepness(configuration: Configuration) -> float:
    """Largest tangent of the angle between the line of two contacts and either normal."""
    a, b = configuration.contact_points
    line = (b.p_object - a.p_object) / np.linalg.norm(b.p_object - a.p_object)
    cosines = [-a.n_object @ line, b.n_object @ line]
    return max(np.inf if c <= 0.0 else float(np.sqrt(1.0 - min(c * c, 1.0)) / c) for c in cosines)


def test_two_fingers_balance_where_their_line_lies_in_both_cones(
    configurations: tuple[Configuration, ...],
) -> None:
    """Nguyen (ICRA 1986): two soft fingers close exactly then. Cones of 42 edges reach 0.85 of the true."""
    mu = SETTINGS.planned_friction * TASK.object.friction
    strengths = start_strengths(configurations, settings=SETTINGS)
    for configuration, strength in zip(configurations, strengths, strict=True):
        steep = steepness(configuration)
        assert strength < 0.0 or steep <= mu * (1.0 + 1e-9)
        assert strength >= 0.0 or steep >= 0.85 * mu
    assert any(strengths < 0.0)
    assert np.corrcoef(strengths, [-steepness(c) for c in configurations])[0, 1] > 0.8


def test_what_stands_out_comes_first_and_none_is_lost(configurations: tuple[Configuration, ...]) -> None:
    ordered = strongest_first(configurations, SETTINGS)
    assert sorted(map(id, ordered)) == sorted(map(id, configurations))
    strengths = start_strengths(configurations, settings=SETTINGS)
    limit = 0.25 * np.median(strengths)
    assert limit < 0.0
    best = sorted((s for s in strengths if s > limit), reverse=True)
    assert 0 < len(best) < len(ordered)
    assert start_strengths(ordered[: len(best)], settings=SETTINGS) == pytest.approx(best, abs=1e-5)
    # What does not stand out stays in the order of the solver.
    places = [next(i for i, c in enumerate(configurations) if c is other) for other in ordered[len(best) :]]
    assert places == sorted(places)
    assert same(strongest_first(configurations, SETTINGS), ordered)


def test_the_solver_is_asked_for_more_than_are_needed_and_gives_the_same_again() -> None:
    starts = solve_for_starts(TASK, count=3, choice=4, settings=SETTINGS, seed=2)
    plain = solve(TASK, candidates=12, seed=2)
    assert same(tuple(starts.result.configurations), tuple(plain.configurations))
    assert same(starts.configurations, strongest_first(tuple(plain.configurations), SETTINGS))
    again = solve_for_starts(TASK, count=3, choice=4, settings=SETTINGS, seed=2)
    assert same(again.configurations, starts.configurations)
    as_found = solve_for_starts(TASK, count=3, choice=1, settings=SETTINGS, seed=2)
    assert same(as_found.configurations, tuple(plain.configurations)[:3])


def test_who_is_asked_to_stop_measures_no_more(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ordering thousands takes seconds, so a stop ends it: what was solved comes as it was found."""
    measured: list[int] = []
    real = StrengthMeasure.at

    def counted(measure: StrengthMeasure, state: State) -> Strength:
        measured.append(1)
        return real(measure, state)

    monkeypatch.setattr(StrengthMeasure, "at", counted)
    starts = solve_for_starts(
        TASK, count=3, choice=4, settings=SETTINGS, seed=2, should_stop=lambda: len(measured) >= 2
    )
    assert len(measured) == 2 < len(starts.configurations)
    assert same(starts.configurations, tuple(starts.result.configurations))


def test_where_more_are_hard_to_find_it_is_content_with_enough() -> None:
    seen: list[Progress] = []
    starts = solve_for_starts(
        TASK, count=2, choice=10_000, settings=SETTINGS, seed=2, on_progress=seen.append
    )
    assert 2 <= len(starts.configurations) < 20_000
    first = next(progress.boxes for progress in seen if progress.found >= 2)
    assert 4 * first <= seen[-1].boxes <= 4 * first + 200


def test_on_a_stand_the_order_of_the_solver_stays() -> None:
    task = load_task("playing")
    settings = preset_settings("holdfast", task)
    starts = solve_for_starts(task, count=4, choice=4, settings=settings, seed=1)
    assert len(starts.result) == 4
    assert same(starts.configurations, tuple(solve(task, candidates=4, seed=1).configurations))


def test_a_turn_begins_where_fingers_have_room(monkeypatch: pytest.MonkeyPatch) -> None:
    """Those that can follow come first, no more are looked for than are needed, and none is lost."""
    task = load_task("tuning")
    settings = preset_settings("holdfast", task)
    asked: list[Configuration] = []

    def follows(configuration: Configuration) -> bool:
        asked.append(configuration)
        return len(asked) in (2, 3, 5)

    monkeypatch.setattr("holdfast.grasping.starts.follows_turn", follows)
    starts = solve_for_starts(task, count=2, choice=4, settings=settings, seed=1)
    found = starts.result.configurations
    assert len(found) == 8 and len(asked) == 3
    assert same(starts.configurations, (found[1], found[2], found[0], *found[3:]))
