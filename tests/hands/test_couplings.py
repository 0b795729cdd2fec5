import numpy as np
import pytest
from holdfast.errors import InputError
from holdfast.hands.hand_file import HandFile, build_hand

BALL = [{"sphere": {"centre": [0, 0, 0], "radius": 0.01}}]
SERVO = {"effort": 1, "stiffness": 1, "damping": 0.1, "armature": 0.001}


def chain(*axes):
    links = [{"name": f"l{i}", "mass": 0.1, "shapes": BALL} for i in range(len(axes) + 1)]
    joints = [
        {"type": "revolute", "parent": f"l{i}", "child": f"l{i + 1}", "position": [0.1, 0, 0], "axes": [axis]}
        for i, axis in enumerate(axes)
    ]
    return build_hand(HandFile(name="chain", palm="l0", links=links, joints=joints), "chain")


def free(name, limits=(-1.0, 1.0)):
    return {"name": name, "direction": [0, 0, 1], "limits": list(limits), "actuator": SERVO}


def coupled(name, to, ratio, offset_deg=0.0, limits=(-9.0, 9.0)):
    limits = [max(limits[0], -6.0), min(limits[1], 6.0)]
    how = {"to": to, "ratio": ratio, "offset_deg": offset_deg}
    return {"name": name, "direction": [0, 0, 1], "limits": limits, "coupled": how}


def test_coupled_joints_follow_their_master():
    hand = chain(free("a"), coupled("b", "a", 0.5, 10.0), free("c"))
    assert hand.joint_names == ("a", "b", "c")
    assert hand.independent_names == ("a", "c")
    assert hand.expand(np.array([0.4, -0.3])) == pytest.approx([0.4, 0.2 + np.deg2rad(10), -0.3])


def test_chains_of_couplings_in_any_order():
    hand = chain(coupled("a", "b", 2.0, 5.0), coupled("b", "c", -0.5, 1.0), free("c"))
    c = 0.3
    b = -0.5 * c + np.deg2rad(1)
    assert hand.expand(np.array([c])) == pytest.approx([2 * b + np.deg2rad(5), b, c])


@pytest.mark.parametrize("ratio", [0.5, -2.0])
def test_limits_keep_coupled_joints_within_theirs(ratio):
    hand = chain(free("a", (-1.0, 1.0)), coupled("b", "a", ratio, 3.0, limits=(-0.25, 0.4)))
    (lower, upper) = hand.limits[0]
    ends = hand.expand(np.array([lower]))[1], hand.expand(np.array([upper]))[1]
    assert sorted(ends) == pytest.approx([-0.25, 0.4])
    assert -1.0 <= lower < upper <= 1.0


def test_limits_that_exclude_each_other_are_refused():
    with pytest.raises(InputError, match=r"'a'.*exclude each other"):
        chain(free("a", (-0.1, 0.1)), coupled("b", "a", 1.0, limits=(0.2, 0.3)))


@pytest.mark.parametrize(
    "axes",
    [
        [free("x"), coupled("a", "a", 1.0)],
        [free("x"), coupled("a", "b", 1.0), coupled("b", "a", 1.0)],
        [free("x"), coupled("a", "b", 1.0), coupled("b", "c", 1.0), coupled("c", "b", 1.0)],
    ],
)
def test_circles_are_refused(axes):
    with pytest.raises(InputError, match="circle"):
        chain(*axes)


def slide(name, limits, **more):
    return {"name": name, "direction": [1, 0, 0], "limits": limits, **more}


def with_slides(*axes):
    links = [{"name": f"l{i}", "mass": 0.1, "shapes": BALL} for i in range(len(axes) + 1)]
    joints = [
        {
            "type": "revolute" if axis["limits"][1] > 0.5 else "prismatic",
            "parent": f"l{i}",
            "child": f"l{i + 1}",
            "position": [0, 0, 0],
            "axes": [axis],
        }
        for i, axis in enumerate(axes)
    ]
    return build_hand(HandFile(name="slides", palm="l0", links=links, joints=joints), "slides")


def test_ratios_may_be_written_as_fractions():
    hand = chain(free("a"), coupled("b", "a", "2/3"), coupled("c", "a", "-1/3", 1.0))
    assert hand.expand(np.array([0.3])) == pytest.approx([0.3, 0.2, -0.1 + np.deg2rad(1)], abs=1e-15)
    assert hand.coupling_matrix[1, 0] == 2.0 / 3.0


def test_slides_follow_slides_with_an_offset_in_metres():
    hand = with_slides(
        slide("a", [-0.05, 0.05], actuator=SERVO),
        slide("b", [-0.1, 0.1], coupled={"to": "a", "ratio": 0.777, "offset": 0.01}),
    )
    assert hand.expand(np.array([0.02])) == pytest.approx([0.02, 0.02 * 0.777 + 0.01])


def test_a_slide_can_not_follow_an_angle():
    with pytest.raises(InputError, match=r"joints\.b\.coupled\.to: 'a' is revolute, and 'b' is not"):
        with_slides(
            slide("a", [-1.0, 1.0], actuator=SERVO),
            slide("b", [-0.1, 0.1], coupled={"to": "a", "ratio": 0.1}),
        )


def test_a_slide_has_no_offset_in_degrees():
    with pytest.raises(InputError, match="limits in m, and no angles"):
        with_slides(
            slide("a", [-0.1, 0.1], actuator=SERVO),
            slide("b", [-0.1, 0.1], coupled={"to": "a", "offset_deg": 5.0}),
        )
