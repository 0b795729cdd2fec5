"""Which links may touch the object in a test."""

import pytest
from holdfast.mjcf import Grasp
from holdfast.mjcf.squeeze.potential_contacts import potential_contacts
from holdfast.retraction import compute_clearance_by_mujoco

from ..conftest import solve


def test_potential_contacts_are_those_that_mujoco_finds_near(firm: Grasp) -> None:
    c, within_m = firm.configuration, 0.01
    links = [link.name for link in c.task.hand.links]
    table = compute_clearance_by_mujoco(c.task, c.state).pairs
    expected = {p.a for p in table if p.b.startswith("object/") and p.distance_m <= within_m}
    contacts = potential_contacts(c, within_m)
    assert {links[touch.link] for touch in contacts} == expected
    for touch in contacts:
        gap = (touch.p_object - touch.p_hand) @ touch.inward
        assert gap <= within_m
        # The normal points from the link into the object: that way lie both points, `gap` apart.
        assert touch.p_hand + gap * touch.inward == pytest.approx(touch.p_object, abs=1e-6)


def test_a_link_that_cannot_move_drives_no_turn() -> None:
    configuration = solve("tuning")
    moves = configuration.task.hand.tree.moves.any(axis=1)
    contacts = potential_contacts(configuration, 1.0)
    assert contacts and all(moves[touch.link] for touch in contacts)
    assert any(not moves[touch.link] for touch in potential_contacts(solve("playing"), 10.0))
