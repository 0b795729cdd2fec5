"""What is measured of given grasps against what is known of boxes, and grasps that are found near them."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from holdfast.geometry import pose
from holdfast.objects import load_object, load_task
from holdfast.pipeline.verify.balance import Carried, carried_multiples
from holdfast.pipeline.verify.faults import find_faults
from holdfast.pipeline.verify.flat_contact import contact_corners, middle_of
from holdfast.pipeline.verify.judge import Judge, JudgeSettings
from holdfast.pipeline.verify.measured import HandAtObject, Measured
from holdfast.pipeline.verify.nearby import NearbyVerdict, find_nearby
from holdfast.pipeline.verify.reading import Interpreter, NearObject, choose_reading
from holdfast.pipeline.verify.reading.joint_names import match_joints
from holdfast.pipeline.verify.reading.joint_orders import joint_orders
from holdfast.pipeline.verify.scaled import scaled_object
from holdfast.solver import solve

from .made import block, file_of, gripper


def between_pads(opening: float, aside: float = 0.0) -> Measured:
    """The block between pads that are 2 `opening` apart, shifted by `aside` along their way."""
    return HandAtObject(gripper(), block()).measure(
        np.array([-opening, opening]), pose(np.eye(3), np.array([aside, 0.0, 0.09]))
    )


def test_pads_that_just_touch_have_nothing_wrong() -> None:
    given = between_pads(0.01)
    assert {touch.finger for touch in given.touches} == {"left", "right"}
    assert [touch.distance_m for touch in given.touches] == pytest.approx([0.0, 0.0], abs=1e-9)
    assert not given.sunk and not given.beyond_limits and not given.astray
    # Both touch in the middle of what pad and block share.
    for touch in given.touches:
        assert touch.point[1:] == pytest.approx([0.0, 0.09], abs=1e-6)


@pytest.mark.parametrize("opening", [0.008, 0.013])
def test_depths_and_gaps_are_those_of_the_widths(opening: float) -> None:
    given = between_pads(opening)
    assert [touch.distance_m for touch in given.touches] == pytest.approx(2 * [opening - 0.01], abs=1e-9)
    assert given.depth_m == pytest.approx(max(0.0, 0.01 - opening), abs=1e-9)


def test_what_is_wrong_is_named() -> None:
    judge = Judge(gripper(), JudgeSettings(presets=(), nearby=False))

    def kinds(joints: list[float]) -> set[str]:
        T = pose(np.eye(3), np.array([0.0, 0.0, 0.09]))
        return {fault.kind for fault in judge.judge(block(), np.array(joints), T, "g").faults}

    assert kinds([-0.01, 0.01]) == set()
    assert kinds([-0.008, 0.008]) == {"penetration"}
    assert "finger off" in kinds([-0.012, 0.012])
    assert "coupling" in kinds([-0.01, 0.04])
    assert "joint limits" in kinds([-0.06, 0.06])
    assert "no contact" in kinds([-0.04, 0.04])


NOTHING = Carried(0.0, 0.0, 0.0)


def test_a_finger_that_is_near_is_amiss_where_it_is_needed_or_the_file_lists_it() -> None:
    """One pad touches the block, and the other stands 2 mm off it."""
    hand, obj = gripper(), block()
    both, one = between_pads(0.01), between_pads(0.011, aside=0.001)
    assert [touch.distance_m for touch in one.touches] == pytest.approx([0.0, 0.002], abs=1e-9)

    def off(given: Measured, carried: Carried, meant: set[str] | None) -> list[str]:
        gaps = {touch.finger: touch.distance_m for touch in given.touches if touch.distance_m > 1e-3}
        touching = [touch for touch in given.touches if touch.distance_m <= 1e-3]
        found = find_faults(hand, obj, given, touching, carried, gaps, meant)
        return [str(fault) for fault in found if fault.kind == "finger off"]

    links = {hand.links[touch.link].name for touch in one.touches}
    stands_off = f"{one.touches[1].finger} is 2 mm off the object"
    assert off(one, NOTHING, None) == [stands_off]
    # Were there others that carry the object, it would have no part in the grasp, unless the file says so.
    much = Carried(2.0, 3.0, 4.0)
    assert off(one, much, None) == []
    assert off(one, much, links) == [stands_off]
    assert off(one, much, {hand.links[one.touches[0].link].name, "unknown"}) == []
    assert off(both, much, links) == []
    # Others that carry something are not enough where they carry less than the weight, and with it much more.
    assert off(one, Carried(0.3, 3.0, 1.0), None) == [stands_off]
    assert off(one, Carried(0.4, 3.0, 1.0), None) == []
    assert off(one, Carried(1.1, 3.0, 4.0), None) == []
    far = between_pads(0.04)
    assert off(far, NOTHING, links) == [
        f"{finger} is more than 6 mm off the object" for finger in ("left", "right")
    ]


def test_a_lid_is_held_where_its_pot_would_not_be_carried() -> None:
    hand, lid = gripper(), block().parts[0]
    mesh = trimesh.creation.box((1.0, 1.0, 0.5))
    mesh.apply_translation([3.0, 0.0, -0.5])
    pot = load_object(mesh).parts[0]
    obj = replace(block(), parts=(lid, replace(pot, name="pot")))
    T = pose(np.eye(3), np.array([0.0, 0.0, 0.09]))
    given = HandAtObject(hand, obj).measure(np.array([-0.01, 0.01]), T)
    whole = carried_multiples(hand, obj, given, given.touches)
    alone = carried_multiples(hand, obj, given, given.touches, touched_alone=True)
    assert whole[0] < 1e-3 and alone == carried_multiples(hand, block(), given, given.touches)
    assert find_faults(hand, obj, given, given.touches, Carried(*whole, whole[0]), {}) == ()


def test_opposed_pads_carry_and_one_alone_does_not() -> None:
    hand, obj, given = gripper(), block(), between_pads(0.01)
    least, most = carried_multiples(hand, obj, given, given.touches)
    assert 1.0 < least <= most
    assert carried_multiples(hand, obj, given, given.touches[:1]) == (0.0, 0.0)


def test_a_gripper_closes_on_what_is_between() -> None:
    hand, obj = gripper(), block()
    T = pose(np.eye(3), np.array([0.0, 0.0, -0.09]))
    file = file_of(T[None], None)
    reading = choose_reading(file, Interpreter(file, hand), NearObject(hand, obj), {"frame": "base"})
    assert reading.states.joints[0] == pytest.approx([-0.01, 0.01], abs=1e-5)


def test_an_object_of_another_size_has_that_size_and_its_inertia() -> None:
    obj, factor = load_object(trimesh.creation.box((0.02, 0.03, 0.05))), np.array([1.0, 2.0, 0.5])
    scaled = scaled_object(obj, factor)
    exact = load_object(trimesh.creation.box((0.02, 0.06, 0.025)))
    assert scaled.mesh.extents == pytest.approx(exact.mesh.extents)
    assert scaled.inertia.mass == pytest.approx(exact.inertia.mass)
    assert scaled.inertia.inertia == pytest.approx(exact.inertia.inertia, rel=1e-9)
    heavy = scaled_object(obj, factor, keeps_mass=True)
    assert heavy.inertia.mass == pytest.approx(obj.inertia.mass)


def test_orders_are_permutations_and_no_two_alike() -> None:
    hand = load_task("upholding").hand
    orders = joint_orders(hand, len(hand.axes))
    assert len(orders) > 3
    assert len({tuple(order) for order in orders.values()}) == len(orders)
    for order in orders.values():
        assert sorted(order) == list(range(len(hand.axes)))
    with_wrist = joint_orders(hand, len(hand.axes) + 2)["hand"]
    assert with_wrist.tolist() == [-1, -1, *range(len(hand.axes))]
    assert joint_orders(hand, 3) == {}


def test_joints_are_found_by_their_names_with_prefixes() -> None:
    hand = gripper()
    names = ["LEFT_SLIDE", "robot0:right_slide", "wrist"]
    assert match_joints(hand, names) == {"LEFT_SLIDE": 0, "robot0:right_slide": 1}


def test_the_middle_of_a_contact_is_that_of_what_is_shared() -> None:
    square = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 0.0)])
    other = square * [1, 1, -1] + [1.0, 0.5, 0.0]
    corner = np.array([1.0, 1.0, 0.0])
    up = np.array([0.0, 0.0, 1.0])
    corners = contact_corners(square, other, up, corner)
    assert {tuple(c) for c in corners.round(9) + 0.0} == {
        (x, y, 0.0) for x in (0.0, 1.0) for y in (-0.5, 1.0)
    }
    assert middle_of(corners, up) == pytest.approx([0.5, 0.25, 0.0])


@pytest.mark.parametrize(("turn", "length"), [(0.0, 2.0), (0.5 * np.pi, 5e-4)])
def test_edges_share_a_length_side_by_side_and_a_point_where_they_cross(turn: float, length: float) -> None:
    roof = np.array([[x, y, -abs(y)] for x in (-1.0, 1.0) for y in (-0.1, 0.0, 0.1)])
    c, s = np.cos(turn), np.sin(turn)
    other = np.array([[c * x - s * y, s * x + c * y, abs(y)] for x in (-3.0, 3.0) for y in (-0.1, 0.0, 0.1)])
    corners = contact_corners(
        roof, other, np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0]) * (turn == 0.0)
    )
    assert np.ptp(corners, axis=0).max() == pytest.approx(length, abs=1e-9)


def test_a_link_presses_on_all_places_that_it_is_as_near_to() -> None:
    """Pads of 20 x 20 mm on a block of 20 mm: each touches over a face, not in its middle alone."""
    given = between_pads(0.01)
    for touch in given.touches:
        assert len(touch.places) == len(touch.normals) >= 4
        assert np.ptp(touch.places, axis=0).max() > 0.01
        assert touch.places.mean(axis=0) == pytest.approx(touch.on_object, abs=1e-6)


def test_a_certified_grasp_is_found_near_one_that_is_off() -> None:
    task = load_task("upholding")
    found = solve(task, candidates=1, budget_s=60.0).configurations[0]
    T = found.state.T_palm_object.copy()
    T[:3, 3] += 1e-3 * found.contact_points[0].n_object  # one finger sinks in by 1 mm, the other stands off
    given = HandAtObject(task.hand, task.object).measure(found.joint_vector, T)
    assert given.depth_m > 5e-4
    nearby = find_nearby(task.hand, task.object, given, "near")
    assert nearby.verdict is NearbyVerdict.FOUND, nearby.reason
    assert nearby.grasp is not None
    configuration = nearby.grasp.configuration
    assert configuration.certified
    wanted = {task.hand.links[contact.hand.link].name for contact in task.contacts}
    assert {contact.hand.name for contact in configuration.task.contacts} == wanted
    touches = {touch.link for touch in given.touches}
    for contact, point in zip(configuration.task.contacts, configuration.contact_points, strict=True):
        assert contact.hand.link in touches
        assert point.gap_m < 1e-9


def test_fewer_than_two_fingers_at_the_object_are_not_tried() -> None:
    given = between_pads(0.04, aside=0.03)
    nearby = find_nearby(gripper(), block(), given, "near")
    assert nearby.verdict is NearbyVerdict.NOT_TRIED
    assert nearby.grasp is None


def test_where_the_solver_proves_that_there_is_none_that_is_said() -> None:
    """Flat pads that can't turn don't lie on a wedge whose faces lean, wherever on them."""
    corners = [
        [side * width, y, z]
        for z, width in ((-0.02, 0.004), (0.02, 0.04))
        for side in (-1, 1)
        for y in (-0.03, 0.03)
    ]
    wedge = load_object(trimesh.convex.convex_hull(np.array(corners)))
    given = HandAtObject(gripper(), wedge).measure(
        np.array([-0.0385, 0.0385]), pose(np.eye(3), np.array([0.0, 0.0, 0.08]))
    )
    assert find_nearby(gripper(), wedge, given, "near").verdict is NearbyVerdict.UNDECIDED
    nearby = find_nearby(gripper(), wedge, given, "near", prove_s=60.0)
    assert nearby.verdict is NearbyVerdict.NONE
    assert "proved" in nearby.reason and nearby.grasp is None
