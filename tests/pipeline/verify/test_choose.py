"""Grasps whose numbers are known are read rightly, with each fault; what can't be told is asked."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from holdfast.errors import InputError
from holdfast.geometry import pose, rotation_from_quaternion
from holdfast.hands import load_hand
from holdfast.objects import Task, load_object, load_task
from holdfast.pipeline.formats import GraspFile, Question
from holdfast.pipeline.verify.measured import HandAtObject
from holdfast.pipeline.verify.reading import Interpreter, NearObject, States, choose_reading
from holdfast.pipeline.verify.reading.alike import touch_alike
from holdfast.pipeline.verify.reading.hand_frames import hand_frames
from holdfast.pipeline.verify.reading.joint_orders import joint_orders
from holdfast.pipeline.verify.reading.own_hand import OwnHand
from holdfast.solver import Configuration, solve

from .made import block, file_of, gripper

SCALE = 2.0


@pytest.fixture(scope="module")
def grasps() -> tuple[Task, list[Configuration]]:
    """Three-finger grasps of the scalpel, certified; clear or not is no matter here."""
    task = load_task("handling")
    return task, list(solve(task, candidates=2, budget_s=60.0).configurations)


def written(task: Task, found: list[Configuration], fault: str) -> GraspFile:
    hand = task.hand
    Ts = np.array([np.linalg.inv(c.state.T_palm_object) for c in found])
    joints = np.array([c.joint_vector for c in found])
    scale = SCALE
    if fault == "frame":
        Ts = Ts @ hand_frames(hand)["tcp"]
    if fault == "length":
        Ts = Ts.copy()
        Ts[:, :3, 3] *= 1e3
    if fault == "angle":
        joints = np.degrees(joints)
    if fault == "joint_order":
        joints = joints[:, joint_orders(hand, joints.shape[1])["thumb_last"]]
    if fault == "scale":
        scale = 1.0 / SCALE
    file = file_of(Ts, joints, scale=scale)
    if fault == "quaternion":
        for grasp in file.grasps:
            pose_ = grasp.grasp.pose
            assert pose_ is not None and pose_.quaternion is not None
            pose_.quaternion[:] = np.roll(pose_.quaternion, -1)
    return file


@pytest.mark.parametrize(
    ("fault", "answer"),
    [
        ("", ""),
        ("frame", "tcp"),
        ("length", "mm"),
        ("angle", "deg"),
        ("joint_order", "thumb_last"),
        ("scale", "divided"),
        ("quaternion", "xyzw"),
    ],
)
def test_the_reading_differs_in_what_was_planted_alone(
    grasps: tuple[Task, list[Configuration]], fault: str, answer: str
) -> None:
    task, found = grasps
    file = written(task, found, fault)
    interpreter = Interpreter(file, task.hand, loaded_at=np.full(3, SCALE))
    reading = choose_reading(file, interpreter, NearObject(task.hand, task.object))
    assert dict(reading.found) == ({fault: answer} if fault else {})
    assert reading.fits
    # What the file states is named where hands are at the object only against it.
    assert reading.against == (("angle",) if fault == "angle" else ())
    for state, configuration in zip(reading.states.T_palm_object, found, strict=True):
        assert state == pytest.approx(configuration.state.T_palm_object, abs=1e-9)
    for joints, configuration in zip(reading.states.joints, found, strict=True):
        assert joints == pytest.approx(configuration.joint_vector, abs=1e-9)


def test_an_answer_that_is_given_is_taken(grasps: tuple[Task, list[Configuration]]) -> None:
    task, found = grasps
    file = written(task, found, "quaternion")
    interpreter = Interpreter(file, task.hand, loaded_at=np.full(3, SCALE))
    near = NearObject(task.hand, task.object)
    assert choose_reading(file, interpreter, near, {"quaternion": "xyzw"}).fits
    wrong = Interpreter(file, task.hand, loaded_at=np.full(3, SCALE))
    with pytest.raises(InputError, match="makes no difference"):
        choose_reading(file, wrong, near, {"direction": "object_in_hand", "joint_length": "mm"})


def test_what_geometry_cannot_tell_is_asked() -> None:
    """A ball is off the middle of the jaws by 5 mm, to one side or the other as the pose is meant."""
    hand, ball = gripper(), load_object(_ball(0.02))
    T = pose(np.diag([-1.0, 1.0, -1.0]), np.array([0.0, 0.005, 0.09]))
    file = file_of(
        T[None],
        np.array([[-0.02, 0.02]]),
        unsettled=(Question.of("direction"),),
        settled={"quaternion": "wxyz", "length": "m"},
    )
    near = NearObject(hand, ball)
    with pytest.raises(InputError, match="--direction hand_in_object or object_in_hand"):
        choose_reading(file, Interpreter(file, hand), near)
    reading = choose_reading(file, Interpreter(file, hand), near, {"direction": "object_in_hand"})
    assert reading.fits


def test_readings_in_which_the_same_touches_are_left_open() -> None:
    """In the other order of the quaternion the gripper is turned by half a turn about its approach."""
    hand, obj = gripper(), block()
    R = rotation_from_quaternion(np.array([0.194, 0.68, -0.194, 0.68]))
    file = file_of(pose(R, -0.09 * R[:, 2])[None], np.array([[-0.01, 0.01]]))
    near, interpreter = NearObject(hand, obj), Interpreter(file, hand)
    reading = choose_reading(file, interpreter, near, {"frame": "base"})
    assert reading.answers["quaternion"] == "wxyz"
    assert reading.left_open == {"quaternion": ("wxyz", "xyzw")}
    other = interpreter.states({**reading.answers, "quaternion": "xyzw"})
    assert touch_alike(near, reading.states, other)
    # Turned by half a turn about the jaws' way its jaws come from the other side: another grasp.
    aside = replace(other, T_palm_object=other.T_palm_object @ pose(np.diag([1.0, -1.0, -1.0]), np.zeros(3)))
    assert not touch_alike(near, reading.states, aside)
    apart = replace(other, joints=np.array([[-0.02, 0.02]]))
    assert not touch_alike(near, apart, apart)


def test_hands_that_are_nowhere_near_are_said_to_be_so() -> None:
    hand, ball = gripper(), load_object(_ball(0.02))
    T = pose(np.eye(3), np.array([3.0, 4.0, 5.0]))
    file = file_of(T[None], np.array([[-0.02, 0.02]]), unsettled=(), settled={})
    assert not choose_reading(file, Interpreter(file, hand), NearObject(hand, ball)).fits


def test_a_file_of_another_hand_is_refused() -> None:
    hand = gripper()
    file = file_of(np.eye(4)[None], np.zeros((1, 22)))
    with pytest.raises(InputError, match="22 numbers, and hand gripper has 2"):
        Interpreter(file, hand)


def test_poses_alone_need_a_gripper(grasps: tuple[Task, list[Configuration]]) -> None:
    task, _ = grasps
    file = file_of(np.eye(4)[None], None)
    with pytest.raises(InputError, match="how it closes"):
        choose_reading(file, Interpreter(file, task.hand), NearObject(task.hand, task.object))


def _ball(radius: float) -> trimesh.Trimesh:
    return trimesh.creation.icosphere(subdivisions=3, radius=radius)


def test_a_gripper_that_stands_open_in_every_grasp_is_closed_and_its_rail_found() -> None:
    """As ACRONYM has it: the jaws of the file's frame open along another axis than the model's."""
    hand, obj = gripper(), block()
    frame = hand_frames(hand)["base+90"]
    places = [pose(np.eye(3), np.array([0.0, y, 0.088])) for y in (-0.02, 0.0, 0.025)]
    Ts = np.array([np.linalg.inv(T) @ frame for T in places])
    file = file_of(Ts, np.tile([-0.045, 0.045], (3, 1)))
    reading = choose_reading(file, Interpreter(file, hand), NearObject(hand, obj))
    assert dict(reading.found) == {"frame": "base+90"}
    assert reading.states.joints == pytest.approx(np.tile([-0.01, 0.01], (3, 1)), abs=1e-5)
    # Alike elsewhere it holds things of one width, as deep as the file says.
    assert not Interpreter(file_of(Ts, np.tile([-0.008, 0.008], (3, 1))), hand).is_open
    assert Interpreter(file_of(Ts, np.tile([-45.0, 45.0], (3, 1))), hand).is_open


@pytest.mark.parametrize(("aside", "moved"), [(0.0, 0.0), (0.003, 0.003), (0.008, 0.0)])
def test_an_object_beside_the_middle_of_jaws_is_moved_there_and_by_no_more(
    aside: float, moved: float
) -> None:
    hand, obj = gripper(), block()
    T = pose(np.eye(3), np.array([aside, 0.0, 0.09]))
    file = file_of(np.linalg.inv(T)[None], None)
    fixed = {"quaternion": "wxyz", "length": "m", "frame": "base"}
    reading = choose_reading(file, Interpreter(file, hand), NearObject(hand, obj), fixed)
    assert reading.moved_m == pytest.approx(moved, abs=1e-5)
    assert reading.states.T_palm_object[0, :3, 3] == pytest.approx([aside - moved, 0.0, 0.09], abs=1e-5)
    if aside < 0.004:
        assert reading.states.joints[0] == pytest.approx([-0.01, 0.01], abs=1e-5)


def test_a_hand_that_runs_into_itself_is_seen_as_the_judgement_sees_it() -> None:
    """The deepest pair of the hand's own bodies, at random joints, against what is measured of a grasp."""
    hand = load_hand("sa")
    away = pose(np.eye(3), np.array([0.0, 0.0, 5.0]))
    at = HandAtObject(hand, load_object("scalpel"))
    q = np.random.default_rng(3).uniform(hand.limits[:, 0], hand.limits[:, 1], size=(12, len(hand.limits)))
    joints = np.array([hand.expand(row) for row in q])
    own = OwnHand(hand)
    states = States(joints, np.tile(away, (len(q), 1, 1)), np.ones((len(q), 3)))
    depths = own.depths(states)
    measured = np.array([at.measure(row, away).depth_m for row in joints])
    assert np.allclose(depths[depths > 1e-4], measured[depths > 1e-4], atol=1e-5)
    assert np.array_equal(depths > 1e-4, measured > 0.0)
    assert (depths > 2e-3).any() and (depths < 1e-4).any()
    said = own.log_likelihood(states)
    assert np.all(said[depths < 5e-4] == 0.0) and np.all(said[depths > 1e-3] < -0.9)
