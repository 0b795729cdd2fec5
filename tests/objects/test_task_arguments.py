"""What `Task` takes in Python is checked as strictly as a task file."""

import holdfast as hf
import numpy as np
import pytest
from holdfast.geometry import PointRegion
from holdfast.objects import load_task

X, ORIGIN = (1.0, 0.0, 0.0), (0.0, 0.0, 0.0)
NAN, INF = float("nan"), float("inf")


def made(**arguments):
    pinch = load_task("upholding")
    return hf.Task(hand=pinch.hand, object=pinch.object, contacts=pinch.contacts, **arguments)


def turn(**fields):
    usual = {"parts": (), "hinge_point": ORIGIN, "hinge_axis": X, "friction_torque_Nm": 0.1, "angle_rad": 1.0}
    return hf.TurnTest(**{**usual, **fields})


@pytest.mark.parametrize(
    ("field", "arguments"),
    [
        ("name", {"name": 3}),
        ("name", {"name": "../x"}),
        ("test", {"test": "lift"}),
        ("test.parts.0", {"test": hf.LiftTest(("lid",))}),
        ("test.parts", {"test": hf.LiftTest("lid")}),
        ("test.directions", {"test": hf.LiftTest(directions=())}),
        ("test.directions.1", {"test": hf.LiftTest(directions=(X, ORIGIN))}),
        ("test.directions.0", {"test": hf.LiftTest(directions=((1.0, NAN, 0.0),))}),
        ("test.directions.0", {"test": hf.LiftTest(directions=("down",))}),
        ("test.hinge_axis", {"test": turn(hinge_axis=ORIGIN)}),
        ("test.hinge_point", {"test": turn(hinge_point=(0.0, INF, 0.0))}),
        ("test.friction_torque_Nm", {"test": turn(friction_torque_Nm=-1.0)}),
        ("test.angle_rad", {"test": turn(angle_rad=90.0)}),
        ("test.contacts.0", {"test": hf.PressTest((2,), 1.0)}),
        ("test.contacts.1", {"test": hf.PressTest((0, 0), 1.0)}),
        ("test.contacts", {"test": hf.PressTest((), 1.0)}),
        ("test.force_N", {"test": hf.PressTest((0,), "3")}),
        ("support", {"support": "table"}),
        ("support.normal", {"support": PointRegion(np.zeros(3), np.zeros(3))}),
        ("T_palm_object", {"T_palm_object": np.eye(3)}),
        ("T_palm_object", {"T_palm_object": 2.0 * np.eye(4)}),
        ("T_palm_object", {"T_palm_object": np.diag([1.0, 1.0, -1.0, 1.0])}),
        ("T_palm_object", {"T_palm_object": NAN * np.eye(4)}),
        ("T_palm_object", {"T_palm_object": "here"}),
        ("limits.index_abduction", {"limits": {"index_abduction": 0.2}}),
        ("limits.index_abduction", {"limits": {"index_abduction": (NAN, 0.2)}}),
        ("limits.index_abduction", {"limits": {"index_abduction": (0.2, -0.2)}}),
        ("limits", {"limits": ["all"]}),
        ("limits", {"limits": np.full((13, 2), INF)}),
    ],
)
def test_what_a_task_cannot_be_made_of_is_refused_by_its_name(field, arguments):
    with pytest.raises(hf.InputError) as caught:
        made(**arguments)
    assert (caught.value.source, caught.value.field) == ("Task", field)


def test_numbers_of_other_types_are_taken_and_directions_become_unit_vectors():
    task = made(test=hf.LiftTest(directions=np.array([[0, 0, -2]])), T_palm_object=np.eye(4).tolist())
    assert task.test == hf.LiftTest(directions=((0.0, 0.0, -1.0),))
    assert np.array_equal(task.T_palm_object, np.eye(4))
    press = made(test=hf.PressTest((np.int64(1),), np.float32(2.0)))
    assert press.test == hf.PressTest((1,), 2.0)


def test_a_test_that_is_right_is_left_to_the_last_digit():
    for name in ("upholding", "lid_lifting", "tuning", "playing"):
        task = load_task(name)
        again = hf.Task(hand=task.hand, object=task.object, contacts=task.contacts, test=task.test)
        assert again.test == task.test


@pytest.mark.parametrize("load", [hf.load_task, hf.load_hand, hf.load_object])
@pytest.mark.parametrize("value", [None, 3, b"sa", {"name": "sa"}])
def test_what_is_neither_a_name_nor_a_path_is_refused_as_such(load, value):
    with pytest.raises(hf.InputError, match=r"must be (a|the) name"):
        load(value)


@pytest.mark.parametrize("figure", ["mass_kg", "friction", "scale"])
@pytest.mark.parametrize("value", ["0.1", True, NAN, 10**400, [1.0]])
def test_figures_of_a_mesh_must_be_numbers(figure, value):
    corners = 0.05 * np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]
    with pytest.raises(hf.InputError, match=figure):
        hf.load_object((corners, faces), **{figure: value})
