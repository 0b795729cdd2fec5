"""Distances between configurations, against their definitions written out."""

import numpy as np
import pytest
from holdfast.geometry import BezierPatch, Cap, Patch, PointRegion
from holdfast.hands import forward_kinematics
from holdfast.solver import solve
from holdfast.solver.contacts.distance import nearest_neighbours, spread_out
from holdfast.solver.contacts.spread import contact_coordinates, spread

from .written_out import distance_written_out as distance


@pytest.fixture(scope="module")
def found(upholding):
    return solve(upholding, candidates=24, seed=2).configurations


def test_nearest_neighbours_are_those_of_the_definition(found):
    states = [c.state for c in found]
    expected = [min(distance(a, b) for b in states if b is not a) for a in states]
    assert nearest_neighbours(states) == pytest.approx(expected, rel=1e-9)


def test_the_spread_is_the_smallest_and_the_median_of_each_kind(found):
    measured = spread(found)
    nearest = [min(distance(a.state, b.state) for b in found if b is not a) for a in found]
    assert measured["smallest"] == pytest.approx(min(nearest), rel=1e-9)
    assert measured["median"] == pytest.approx(np.median(nearest), rel=1e-9)
    for kind, row in (("joints", lambda c: c.state.q), ("contacts", contact_coordinates)):
        apart = [min(np.abs(row(a) - row(b)).max() for b in found if b is not a) for a in found]
        assert measured[f"{kind}_smallest"] == pytest.approx(min(apart))
        assert measured[f"{kind}_median"] == pytest.approx(np.median(apart))
    assert spread(found[:1]) is None


def test_contact_coordinates_say_where_in_its_region_each_contact_lies(upholding, found):
    for configuration in found[:5]:
        x = list(contact_coordinates(configuration))
        params, caps = x[: len(configuration.state.params)], x[len(configuration.state.params) :]
        assert params == list(configuration.state.params)
        frames = forward_kinematics(upholding.hand, configuration.joint_vector)
        for contact, point in zip(upholding.contacts, configuration.contact_points, strict=True):
            cap = contact.hand.region
            assert isinstance(cap, Cap)
            own = frames[contact.hand.link][:3, :3].T @ point.n_hand
            angle = np.arccos(np.clip(own @ cap.axis, -1.0, 1.0))
            assert np.hypot(caps.pop(0), caps.pop(0)) == pytest.approx(angle / cap.half_angle_rad, abs=1e-7)
        assert caps == []


def test_points_have_no_coordinates_and_patches_two(make_task):
    up = np.array([[[-0.02, -0.02, 0.01], [-0.02, 0.02, 0.01]], [[0.02, -0.02, 0.01], [0.02, 0.02, 0.01]]])
    task = make_task(
        ("index/pad", Patch(BezierPatch(up))),
        ("thumb/pad", PointRegion(np.array([0.0, 0.0, -0.01]), np.array([0.0, 0.0, -1.0]))),
    )
    configuration = solve(task, candidates=1).configurations[0]
    assert len(contact_coordinates(configuration)) == 6


def test_each_chosen_configuration_is_the_farthest_from_those_before(found):
    chosen = spread_out(found, 6)
    assert chosen[0] is found[0]
    for k in range(1, 6):
        reach = [min(distance(c.state, d.state) for d in chosen[:k]) for c in found]
        own = min(distance(chosen[k].state, d.state) for d in chosen[:k])
        assert own == pytest.approx(max(reach), rel=1e-9)
    assert spread_out(found, 24) == list(found)
