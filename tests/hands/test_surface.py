"""How far regions lie off their links."""

import numpy as np
import pytest
from holdfast.geometry import Box, Cap, Capsule, Hull, PointRegion, Sphere, mass_properties
from holdfast.geometry.transforms import pose, rotation_exp
from holdfast.hands import Hand, HandRegion, Link, builtin_hands, hand_placement, load_hand

BOX = Box(
    pose(rotation_exp(np.array([0.3, -0.2, 0.5])), np.array([0.01, 0, 0])), np.array([0.01, 0.02, 0.03])
)


def off(shapes, region):
    inertia = mass_properties([Sphere(np.zeros(3), 0.01)], 1.0)
    hand = Hand("h", (Link("palm", -1, np.eye(4), (), tuple(shapes), inertia),), {})
    return hand_placement(hand, HandRegion("r", 0, region)).farthest_m


def point(*p):
    return PointRegion(np.array(p, dtype=float), np.array([0.0, 0.0, 1.0]))


def cap(radius):
    return Cap(np.array([0.01, 0, 0]), radius, np.array([1.0, 0, 0]), 1.0)


@pytest.mark.parametrize(("radius", "expected"), [(0.02, 0.0), (0.0215, 0.0015), (0.018, 0.002)])
def test_a_cap_over_and_under_a_ball(radius, expected):
    assert off([Sphere(np.array([0.01, 0, 0]), 0.02)], cap(radius)) == pytest.approx(expected, abs=1e-12)


def test_a_capsule_counts_its_ends_and_its_side():
    capsule = Capsule(np.zeros(3), np.array([0.05, 0, 0]), 0.01)
    assert off([capsule], point(0.02, 0.013, 0)) == pytest.approx(0.003)
    assert off([capsule], point(0.05 + 0.006, 0.008, 0)) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(
    "local", [(0.01, 0.005, -0.02), (0.004, 0.0, 0.03), (0.013, 0.024, 0.0), (0.0, 0.0, 0.0)]
)
def test_a_box_agrees_with_the_hull_of_its_corners_and_with_its_definition(local):
    p = (BOX.T_link_box @ np.array([*local, 1.0]))[:3]
    beyond = np.abs(local) - BOX.half_extents
    expected = abs(np.linalg.norm(np.maximum(beyond, 0)) + min(beyond.max(), 0.0))
    assert off([BOX], point(*p)) == pytest.approx(expected, abs=1e-12)
    signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T
    corners = signs * BOX.half_extents @ BOX.T_link_box[:3, :3].T + BOX.T_link_box[:3, 3]
    if np.count_nonzero(beyond > 0) < 2:
        assert off([Hull.from_points(corners)], point(*p)) == pytest.approx(expected, abs=1e-12)


def test_several_shapes_count_as_their_union():
    shapes = [Sphere(np.zeros(3), 0.02), Sphere(np.array([0.03, 0, 0]), 0.02)]
    assert off(shapes, point(0.05, 0, 0)) == pytest.approx(0.0, abs=1e-12)
    assert off(shapes, point(0.02, 0, 0)) == pytest.approx(0.01)  # on one ball, inside the other


def test_a_link_without_shapes_has_no_surface():
    assert off([], point(0, 0, 0)) == np.inf


@pytest.mark.parametrize("name", builtin_hands())
def test_regions_of_the_built_in_hands_are_on_their_links(name):
    hand = load_hand(name)
    for region in hand.regions.values():
        placement = hand_placement(hand, region)
        assert placement.farthest_m < 3e-5 and placement.normal_rad < 0.1, region.name
