"""What tasks' contacts carry: known answers, what limits them, and the choice of others."""

from dataclasses import replace
from math import inf

import numpy as np
import pytest
from holdfast.hands import load_hand
from holdfast.objects import ObjectRegion, Task, load_object, load_task
from holdfast.objects.carrying import (
    PLANNED_FRICTION,
    WANTED,
    Carrying,
    Limit,
    best_points,
    carrying,
    contact_places,
    first_that_carries,
    object_load,
    others_that_carry,
    task_load,
    usual_fingertip,
)
from holdfast.objects.carrying.finger_force import usual_force_N

PLATE, MUG, BOX = "family:plate:34", "family:mug:31", "family:box:3"
RIM = {"index/tip": "rim_below", "thumb/tip": "rim_above"}
HANDLE = {"index/tip": "handle_left", "thumb/tip": "handle_right"}


def task(obj, contacts):
    return Task(hand="sa", object=obj, contacts=contacts)


def found(one):
    load = task_load(one)
    assert load is not None
    return carrying(one.contacts, one.hand, load, one.max_normal_force_N)


def test_the_hand_s_fingers_limit_the_forces_and_a_palm_has_no_limit() -> None:
    hand = load_hand("sa")
    places = contact_places(load_task("transportation").contacts, hand)
    assert places[0].largest_N >= hand.rated_force_N
    assert any(place.largest_N == inf for place in contact_places(load_task("holding").contacts, hand))
    limited = contact_places(load_task(BOX).contacts, hand, most_N=7.0)
    assert [place.largest_N for place in limited] == [7.0, 7.0]
    assert hand.rated_force_N <= usual_fingertip(hand).force_N < 2.0 * hand.rated_force_N


@pytest.mark.parametrize(("name", "contacts"), [(PLATE, RIM), ("family:mug:32", HANDLE)])
def test_too_heavy_for_two_fingers(name: str, contacts: dict[str, str]) -> None:
    """The best squeeze plans of 32 candidates each reached 0.46 and 1.16 times the load."""
    answer = found(task(name, contacts))
    assert not answer.is_enough
    best_plan = {PLATE: 0.46, "family:mug:32": 1.16}[name]
    assert best_plan <= answer.multiple < 1.6 * best_plan
    assert answer.multiple < answer.spread
    assert "at most" in str(answer)
    assert "not proved" in str(answer)


def test_a_light_box_is_no_load_and_the_search_ends_early() -> None:
    answer = found(load_task(BOX))
    assert answer.is_enough
    assert answer.multiple > WANTED
    assert answer.limit is None


def test_twice_the_mass_is_half_the_multiple_and_what_would_do_does() -> None:
    one = task(PLATE, RIM)
    load, heavy = task_load(one), task_load(one, mass_kg=2.0 * one.object.inertia.mass)
    assert load is not None
    assert heavy is not None
    points = load.best(contact_places(one.contacts, one.hand))
    assert heavy.multiple(points) == pytest.approx(0.5 * load.multiple(points))
    answer = carrying(one.contacts, one.hand, load)
    assert answer.force_factor == pytest.approx(WANTED / answer.multiple)
    stronger = [replace(p, largest_N=answer.force_factor * p.largest_N) for p in points]
    assert load.multiple(stronger) == pytest.approx(WANTED, rel=1e-6)
    assert answer.limit in (Limit.FORCE, Limit.FRICTION)
    if answer.friction_needed is not None:
        assert replace(load, friction=answer.friction_needed).multiple(points) >= WANTED * (1 - 1e-9)


def test_fingers_on_one_side_are_in_the_wrong_places() -> None:
    answer = found(task(BOX, [("index/tip", "front"), ("thumb/tip", "front")]))
    assert answer.multiple == pytest.approx(0.0, abs=1e-9)
    assert answer.limit is Limit.PLACES
    assert "none of the weight" in str(answer)


def test_where_nothing_is_carried_the_friction_that_would_do_is_little_more_than_the_least() -> None:
    """Below 0.162 no points of these regions balance at all, as `best --for friction` proves."""
    handling = load_task("handling")
    load = task_load(handling, friction=0.1)
    assert load is not None
    answer = carrying(handling.contacts, handling.hand, load)
    assert answer.multiple == 0.0
    assert answer.limit is Limit.FRICTION
    assert answer.friction_needed is not None
    assert 0.162 < answer.friction_needed < 0.25
    assert f"too little friction (friction {answer.friction_needed:.2f} in place of 0.1 would do)" in str(
        answer
    )


def test_points_that_carry_are_found_where_those_of_the_grid_carry_nothing() -> None:
    """By way of what carries with more friction; spread over the regions far more is carried than wanted."""
    lid_lifting = load_task("lid_lifting")
    load = task_load(lid_lifting, friction=0.15)
    assert load is not None
    places = contact_places(lid_lifting.contacts, lid_lifting.hand)
    grid = load.best(places, WANTED, polished=False)
    assert load.multiple(grid) == 0.0
    assert load.multiple(load.best(places, WANTED)) >= WANTED


def test_forces_that_differ_are_said_as_a_factor() -> None:
    few = Carrying(0.5, 1.0, Limit.FORCE, (20.0, 21.0), 0.6, force_factor=3.0)
    assert "63 N a finger in place of 21" in str(few)
    assert "3 times the force of each finger" in str(replace(few, forces_N=(20.0, 300.0, inf)))
    assert "would do" not in str(replace(few, forces_N=(inf, inf)))


def test_a_stand_carries_what_is_turned_or_pressed() -> None:
    assert task_load(load_task("tuning")) is None
    assert task_load(load_task("playing")) is None


def test_a_pose_that_is_held_fixed_is_the_only_one_looked_at() -> None:
    free = task_load(task(PLATE, RIM))
    fixed = task_load(Task(hand="sa", object=PLATE, contacts=RIM, T_palm_object=np.eye(4)))
    assert free is not None
    assert fixed is not None
    assert fixed.R_object_palm is not None
    places = contact_places(task(PLATE, RIM).contacts, load_hand("sa"))
    points = fixed.best(places)
    assert fixed.multiple(points) <= 1.1 * free.multiple(points)


def test_best_points_carry_no_less_than_the_middles() -> None:
    one = load_task("family:handle:2")
    load = object_load(one.object)
    places = contact_places(one.contacts, one.hand)
    middles = [place.at(len(place.points) // 2) for place in places]
    assert load.multiple(best_points(places, load.centre, load.friction, load.gravity)) >= load.multiple(
        middles
    )


def test_the_first_set_that_carries_is_taken_and_the_strongest_where_none_does() -> None:
    hand, obj = load_hand("sa"), load_object(MUG)
    load = object_load(obj)
    handle = task(obj, HANDLE).contacts
    body = task(obj, {"index/tip": "body_left", "thumb/tip": "body_right"}).contacts
    assert first_that_carries(hand, load, [handle, body]) == 1
    assert first_that_carries(hand, replace(load, weight_N=0.1 * load.weight_N), [handle, body]) == 0
    assert first_that_carries(hand, replace(load, weight_N=100.0 * load.weight_N), [handle, body]) == 1


def test_others_are_as_few_as_carry_the_load_and_do_carry_it() -> None:
    one = task(PLATE, RIM)
    load = object_load(one.object)
    regions = [ObjectRegion(name, region) for name, region in one.object.regions.items()]
    others = others_that_carry(one.hand, load, one.contacts, regions)
    assert others is not None
    spared = replace(load, friction=PLANNED_FRICTION * load.friction)
    assert spared.multiple(spared.best(contact_places(others, one.hand), WANTED)) >= WANTED
    assert len({contact.hand.link for contact in others}) == len(others)
    too_heavy = replace(load, weight_N=100.0 * load.weight_N)
    assert others_that_carry(one.hand, too_heavy, one.contacts, regions) is None


def test_a_set_is_chosen_by_what_fingers_press_with_in_middling_postures() -> None:
    # By the handle, where its thumb presses from the side, Shadow held it 0 of 6 times.
    task = load_task("family:mug:14@shadow")
    assert {contact.object.name for contact in task.contacts} == {"body_left", "body_right"}
    one, region = task.hand, task.hand.regions["index/tip"]
    assert usual_force_N(one, region, 0.5) < usual_force_N(one, region)
