from dataclasses import replace

import numpy as np
import pytest
from holdfast.geometry import MassProperties, Sphere
from holdfast.hands import Axis, Hand, Link
from holdfast.retraction.pairs import collision_model, overlapping_links

INERTIA = MassProperties(0.1, np.zeros(3), 1e-4 * np.eye(3))


def test_only_joined_links_are_left_out_of_the_sa_hand(task):
    joined = {(link.parent, i) for i, link in enumerate(task.hand.links) if link.parent >= 0}
    assert overlapping_links(task.hand) == joined


def test_links_that_can_collide_are_watched(task):
    model = collision_model(task)
    watched = {model.name(pair) for pair in model.pairs}
    # These overlap in a good part of the range, the last also in its middle, but not in the open hand.
    for names in (
        ("palm", "thumb_distal"),
        ("thumb_medial", "index_proximal"),
        ("thumb_distal", "index_proximal"),
    ):
        assert names in watched
    n_links, n_parts = len(task.hand.links), len(task.object.parts)
    assert len(watched) == n_links * (n_links - 1) // 2 - (n_links - 1) + n_links * n_parts


def test_overlap_by_construction_is_found_by_computation():
    # Two balls fixed side by side on the palm overlap in every pose; a third does not.
    def ball(name, parent, x):
        T = np.eye(4)
        T[0, 3] = x
        return Link(name, parent, T, (), (Sphere(np.zeros(3), 0.01),), INERTIA)

    links = (ball("palm", -1, 0.0), ball("a", 0, 0.05), ball("b", 0, 0.06), ball("c", 0, 0.1))
    assert overlapping_links(Hand("toy", links, {})) == {(0, 1), (0, 2), (0, 3), (1, 2)}


@pytest.mark.parametrize(
    ("lower", "upper", "is_left_out"),
    [
        (0.0272, 0.0332, True),  # nearly half of the range, 3 mm deep
        (0.016, 0.046, False),  # half of the range, but 14 mm deep
        (0.028, 0.048, False),  # 2 mm deep, in a tenth of the range
    ],
)
def test_links_about_a_knuckle_are_left_out_where_hulls_alone_meet(lower, upper, is_left_out):
    """Balls of 20 and 10 mm, the second on a knuckle without shapes and sliding away from the first."""
    slide = Axis("slide", "prismatic", np.array([1.0, 0.0, 0.0]), lower, upper, None, None)
    balls = [(Sphere(np.zeros(3), radius),) for radius in (0.02, 0.01)]
    links = (
        Link("palm", -1, np.eye(4), (), balls[0], INERTIA),
        Link("knuckle", 0, np.eye(4), (), (), INERTIA),
        Link("near", 1, np.eye(4), (slide,), balls[1], INERTIA),
    )
    assert overlapping_links(Hand("toy", links, {})) == {(0, 1), (1, 2)} | (
        {(0, 2)} if is_left_out else set()
    )


def test_only_contacts_of_the_task_are_intended(task):
    model = collision_model(task)
    intended = {model.name(pair) for pair in model.pairs if pair.intended}
    # The grips are on the handle: the blade may not be touched, not even by a finger with a contact.
    assert intended == {("index_distal", "object/handle"), ("thumb_distal", "object/handle")}


def test_contact_belongs_to_the_part_that_carries_it(slot_task):
    model = collision_model(slot_task)
    assert [model.name(pair) for pair in model.pairs if pair.intended] == [("index_distal", "object/floor")]


def test_model_is_built_once_per_task(task):
    assert collision_model(task) is collision_model(task)
    assert collision_model(replace(task)) is not collision_model(task)
