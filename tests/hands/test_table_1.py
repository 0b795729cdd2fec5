"""The built-in hands against Table 1 of the paper."""

import re

import numpy as np
import pytest
from holdfast.geometry import Sphere
from holdfast.hands import builtin_hands, load_hand
from holdfast.pipeline.cli.catalogue import entries
from holdfast.retraction.bodies import Bodies, Body, build_piece, hand_bodies
from holdfast.retraction.distance import measure

# Degrees of freedom and finger structures: little, ring, middle, index, thumb, as printed.
TABLE_1 = {
    "dist": (16, None, "URR", "URR", "URR", "URR"),
    "robonaut": (12, "RRRR", "RRRR", "URR", "URR", "UR"),
    "lms": (16, None, "URR", "URR", "URR", "URR"),
    "ultralight": (10, "RRR", "RRR", "RRR", "RRR", "URR"),
    "gifu2": (16, "URR", "URR", "URR", "URR", "URR"),
    "shadow": (18, "RURR", "URR", "URR", "URR", "UUR"),
    "dlr2": (13, None, "URR", "URR", "URR", "RURR"),
    "ubh3": (20, "URR", "URR", "URR", "URR", "URR"),
    "mai": (16, None, "URR", "URR", "URR", "URR"),
    "sa": (13, None, "URR", "URR", "URR", "RURR"),
    "twendy_one": (13, None, "URR", "URR", "URR", "RUR"),
}
FINGERS = ("little", "ring", "middle", "index", "thumb")


def structure(hand, finger):
    """Kinds of the joints from the palm to the tip of a finger, read from the links."""
    link = hand.links[hand.regions[f"{finger}/tip"].link]
    kinds = ""
    while link.parent >= 0:
        kinds = {0: "", 1: "R", 2: "U"}[len(link.axes)] + kinds
        link = hand.links[link.parent]
    return kinds


def test_every_design_is_built_in():
    assert set(TABLE_1) == set(builtin_hands())


@pytest.mark.parametrize("name", TABLE_1)
def test_degrees_of_freedom_and_structures_are_those_of_the_table(name):
    hand = load_hand(name)
    freedoms, *structures = TABLE_1[name]
    assert len(hand.independent) == freedoms
    for finger, expected in zip(FINGERS, structures, strict=True):
        if expected is None:
            assert f"{finger}/tip" not in hand.regions
        else:
            assert structure(hand, finger) == expected


@pytest.mark.parametrize("name", TABLE_1)
def test_the_list_states_the_degrees_of_freedom(name):
    (entry,) = [entry for entry in entries("hand") if entry.name == name]
    assert re.search(r"\b(\d+) degrees of freedom", entry.description)[1] == str(TABLE_1[name][0])


@pytest.mark.parametrize("name", TABLE_1)
def test_coupled_joints_turn_by_the_same_angle(name):
    """The paper: a rotation about an axis of A produces an identical rotation about an axis of B."""
    hand = load_hand(name)
    assert set(np.unique(hand.coupling_matrix)) <= {0.0, 1.0}
    assert not hand.coupling_offset.any()


@pytest.mark.parametrize("name", TABLE_1)
def test_tips_and_pads_lie_on_the_links(name):
    """Points of a region are within 0.15 mm of the surface of the link that carries it."""
    hand = load_hand(name)
    bodies = hand_bodies(hand)
    rng = np.random.default_rng(0)
    for region in hand.regions.values():
        points, _ = region.region.sample(20, rng)
        dots = [Body(f"{i}", None, (build_piece(Sphere(p, 1e-6)),)) for i, p in enumerate(points)]
        both = Bodies([bodies[region.link], *dots])
        n = len(bodies[region.link].pieces)
        pairs = np.array([(a, n + i) for i in range(len(dots)) for a in range(n)])
        gaps = measure(both.place(np.tile(np.eye(4), (len(both.bodies), 1, 1))), pairs).distance_m
        nearest = gaps.reshape(len(dots), n).min(axis=1)
        assert np.abs(nearest).max() < 1.5e-4, region.name


@pytest.mark.parametrize("name", TABLE_1)
def test_sources_of_the_dimensions_are_stated(name):
    hand = load_hand(name)
    assert name == "sa" or {"dimensions", "actuator"} <= set(hand.sources)
