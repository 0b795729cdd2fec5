"""Wide contacts: forces that are centred off a contact's point, by what the surfaces and the pad allow."""

from dataclasses import replace

import numpy as np
import pytest
from holdfast.geometry import ConvexSurface, perpendicular
from holdfast.hands import Pad, forward_kinematics
from holdfast.mjcf import HoldSettings, Squeeze, plan_squeeze, preset_settings
from holdfast.mjcf.squeeze.pads import ContactPads, contact_pads
from holdfast.mjcf.squeeze.statics import (
    ForcePoints,
    contact_statics,
    grasp_statics,
    spread_out,
    task_contacts,
)
from holdfast.objects import load_task
from holdfast.solver import Configuration, solve


@pytest.fixture(scope="module")
def carried() -> Configuration:
    """A teapot on the palm, and fingers around it."""
    return solve(load_task("transportation"), candidates=1, seed=3).configurations[0]


@pytest.fixture(scope="module")
def on_the_palm() -> Configuration:
    """Something on the part of the palm that is flat."""
    return solve(load_task("holding"), candidates=1, seed=3).configurations[0]


def pads(curvatures: list[list[float]], turn_rad: float = 0.1) -> ContactPads:
    n = len(curvatures)
    axes = np.tile(np.eye(2), (n, 1, 1))
    return ContactPads(Pad(), np.array(curvatures), axes, np.full((n, 2, 2), np.inf), turn_rad, None, True)


def test_resultants_have_the_wrench_of_the_forces(carried: Configuration) -> None:
    """By the grasp matrix of the points that the resultants act at."""
    points = contact_pads(carried, HoldSettings()).force_points()
    assert len(points.contact) > points.n_contacts == 4
    statics = grasp_statics(carried, points=points)
    rng = np.random.default_rng(0)
    vectors = rng.normal(size=(3, len(points.contact), 4))
    vectors[..., 0] = np.abs(vectors[..., 0])
    summed, centres_m = points.resultants(vectors)
    for vector, total, centre_m in zip(vectors, summed, centres_m, strict=True):
        there = spread_out(task_contacts(carried), ForcePoints(np.arange(4), centre_m))
        at_centres = contact_statics(carried, HoldSettings(), there)
        assert at_centres.G @ total.ravel() == pytest.approx(statics.G @ vector.ravel(), abs=1e-12)
        assert at_centres.T @ total.ravel() == pytest.approx(statics.T @ vector.ravel(), abs=1e-12)


def test_points_stay_on_the_tangent_plane_and_within_reach(carried: Configuration) -> None:
    found = contact_pads(carried, HoldSettings())
    points, contacts = found.force_points(), task_contacts(carried)
    for i, place in zip(points.contact, spread_out(contacts, points), strict=True):
        shift_m = place.p_object - contacts[i].p_object
        assert abs(shift_m @ contacts[i].inward) < 1e-15
        assert np.linalg.norm(shift_m) <= found.largest_reaches_m()[i] + 1e-12
    assert points.offsets_m[:4] == pytest.approx(0.0)


def test_curvature_and_the_turn_that_is_allowed_bound_the_reach() -> None:
    flat, dome, tip, rod = (0, 1, 2, 3)
    found = pads([[0.0, 0.0], [12.0, 12.0], [100.0, 100.0], [0.0, 60.0]])
    reaches_m = found.reaches_m()
    # Where surfaces are as flat as a pad can tell the patch is the limit, on a ball of radius r it is r turn.
    assert reaches_m[flat] == pytest.approx(Pad().patch_m(np.array([10.0]), np.zeros((1, 2)))[0])
    assert reaches_m[tip] == pytest.approx(0.1 / 100.0)
    assert np.all(reaches_m[dome] > reaches_m[tip]) and np.all(reaches_m[dome] <= reaches_m[flat])
    assert reaches_m[rod, 0] > 4.0 * reaches_m[rod, 1]
    assert np.count_nonzero(found.force_points().contact == tip) == 1  # a point
    assert np.count_nonzero(found.force_points().contact == rod) == 3  # a line: both ways along it
    assert np.count_nonzero(found.force_points().contact == flat) == 5
    assert np.all(pads([[0.0, 0.0]], 1e-6).reaches_m() == reaches_m[flat])
    assert np.all(pads([[12.0, 12.0]], 1e-2).reaches_m() == pytest.approx(1e-2 / 12.0))
    assert np.all(found.reaches_m(np.full(4, 50.0)) >= reaches_m)


def test_a_squeeze_of_wide_contacts_balances_the_load(carried: Configuration) -> None:
    """Force and torque of each contact at the centre of its pressure, once more and in another way."""
    settings = replace(preset_settings("holdfast", carried.task), friction=2.0, planned_effort=1.0)
    squeeze = plan_squeeze(carried, settings=settings)
    assert isinstance(squeeze, Squeeze) and squeeze.load_factor > 0.5
    obj, state = carried.task.object, carried.state
    mass_centre = state.R_palm_object @ obj.inertia.centre + state.p_palm_object
    weight = obj.inertia.mass * settings.gravity * squeeze.load_factor
    contacts = task_contacts(carried)
    assert np.abs(squeeze.loaded_centres_m).max() > 1e-3
    reach_m = contact_pads(carried, settings).largest_reaches_m()
    for vector, centres_m, direction in zip(
        squeeze.loaded, squeeze.loaded_centres_m, settings.directions, strict=True
    ):
        force, torque = weight * np.array(direction), np.zeros(3)
        for f, centre_m, contact in zip(vector, centres_m, contacts, strict=True):
            tangents = perpendicular(contact.inward)
            pushed = f[0] * contact.inward + f[1:3] @ tangents
            force = force + pushed
            at = contact.p_object + centre_m @ tangents - mass_centre
            torque = torque + np.cross(at, pushed) + f[3] * contact.inward
        assert np.abs(force).max() < 1e-4 and np.abs(torque).max() < 1e-6
        assert np.all(np.linalg.norm(centres_m, axis=1) <= reach_m + 1e-9)


def test_a_patch_ends_with_the_link_where_the_hand_is_flat(on_the_palm: Configuration) -> None:
    """By signed distances from the link's shapes, half a millimetre below the contact."""
    found, hand = contact_pads(on_the_palm, HoldSettings()), on_the_palm.task.hand
    poses = forward_kinematics(hand, on_the_palm.joint_vector)
    seen = 0
    for i, k, way in np.argwhere(np.isfinite(found.edges_m)):
        point, link = on_the_palm.contact_points[i], on_the_palm.task.contacts[i].hand.link
        surface = ConvexSurface(hand.links[link].shapes)
        along = found.directions[i, k] @ perpendicular(-point.n_object) * (1.0 - 2.0 * way)
        end = point.p_hand - 5e-4 * point.n_hand + found.edges_m[i, k, way] * along
        in_link = (end - poses[link, :3, 3]) @ poses[link, :3, :3]
        # Regions lie off the shapes by a little, which counts as depth.
        assert abs(surface.signed_distances(in_link[None])[0]) < 2e-4
        seen += 1
    assert seen > 0
    endless = replace(found, edges_m=np.full_like(found.edges_m, np.inf))
    forces = np.full(4, 200.0)
    assert np.all(found.spin_arms_m(forces) <= endless.spin_arms_m(forces))
    assert np.all(found.reaches_m(forces) <= endless.reaches_m(forces))
    narrow = replace(found, edges_m=np.minimum(found.edges_m, 0.004))
    assert np.all(narrow.spin_arms_m(forces) < endless.spin_arms_m(forces))
