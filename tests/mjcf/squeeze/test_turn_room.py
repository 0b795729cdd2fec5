"""Room on the way of a turn: what does not turn stays, what turns goes along."""

from dataclasses import replace

import numpy as np
import pytest
from holdfast.mjcf import NotHoldable, Obstacle, follows_turn, plan_squeeze
from holdfast.mjcf.squeeze.turn_path import squeeze_trajectory
from holdfast.mjcf.squeeze.turn_room import in_the_way, why_not_followed
from holdfast.solver import Configuration


def fist(configuration: Configuration) -> Configuration:
    """The same with every joint closed."""
    upper = configuration.task.limits[:, 1]
    return replace(configuration, state=replace(configuration.state, q=upper))


def nearer(configuration: Configuration, by_m: float) -> Configuration:
    """The same with the object closer to the palm."""
    state, key = configuration.state, configuration.contact_points[0].p_object
    shift = by_m * key / np.linalg.norm(key)
    return replace(configuration, state=replace(state, p_palm_object=state.p_palm_object - shift))


def test_a_turn_that_is_made_has_room(tuning: Configuration) -> None:
    assert in_the_way(squeeze_trajectory(tuning)) is None
    assert follows_turn(tuning)


def test_links_that_run_into_something_are_named(tuning: Configuration) -> None:
    start, *way = squeeze_trajectory(tuning)
    found = in_the_way([start, *way[:3], fist(way[3]), *way[4:]])
    assert found is not None
    task = tuning.task
    parts = {f"object/{part.name}" for part in task.object.parts}
    assert set(found) <= parts | {link.name for link in task.hand.links}


def test_what_does_not_turn_is_where_it_was_at_the_beginning(tuning: Configuration) -> None:
    way = squeeze_trajectory(tuning)
    # Only the states behind the first say where the key is, only the first where the rest of the guitar is.
    found = in_the_way([nearer(way[0], 0.04), *way[1:]])
    assert found is not None and found[1] in {f"object/{part.name}" for part in tuning.task.obstacles}


def test_beyond_the_angle_that_is_asked_for_nothing_counts(tuning: Configuration) -> None:
    way = squeeze_trajectory(tuning)
    assert in_the_way([*way[:-1], fist(way[-1])]) is None


def test_a_turn_without_room_is_not_holdable(tuning: Configuration, monkeypatch: pytest.MonkeyPatch) -> None:
    way = squeeze_trajectory(tuning)
    barred = [*way[:2], fist(way[2]), *way[3:]]
    monkeypatch.setattr("holdfast.mjcf.squeeze.plan.squeeze_trajectory", lambda _: barred)
    assert plan_squeeze(tuning) == NotHoldable(Obstacle.ROOM, 0.0)


def test_what_a_slide_may_lead_past_is_not_refused(tuning: Configuration) -> None:
    """The test lets contacts slide by 5 mm: less than that in the way proves nothing of the turn."""
    way = squeeze_trajectory(tuning)
    leaning = (
        [nearer(way[0], by_m), *way[1:]]
        for by_m in np.arange(1e-3, 0.04, 1e-3)
        if in_the_way([nearer(way[0], by_m), *way[1:]]) is not None
    )
    near = next(leaning)
    assert why_not_followed(near, slip_limit_m=5e-3) is None
    assert why_not_followed(near, slip_limit_m=1e-4) is Obstacle.ROOM
