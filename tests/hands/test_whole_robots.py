"""Models of whole robots: the hand in them is found, or the field that names it is."""

import warnings
from itertools import pairwise

import pytest
from holdfast.errors import InputError, InputWarning
from holdfast.hands import load_hand

from .test_odd_models import BALL, INERTIAL, LIMIT, written


def link(name: str) -> str:
    return f'<link name="{name}">{INERTIAL + BALL}</link>'


def joint(parent: str, child: str, at: str, kind: str = "revolute") -> str:
    return (
        f'<joint name="to_{child}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{at}"/><axis xyz="0 1 0"/>{LIMIT}</joint>'
    )


def arm(side: str, y: float, joints: int = 3, *, hand: bool = True) -> str:
    """An arm of a torso, of links 0.3 m long, with a hand of two fingers on its last one."""
    names = ["torso", *(f"{side}_{i}" for i in range(joints))]
    text = "".join(link(name) for name in names[1:])
    text += joint("torso", names[1], f"0 {y} 0.2")
    text += "".join(joint(a, b, "0 0 0.3") for a, b in pairwise(names[1:]))
    for finger, x in (("thumb", 0.03), ("index", -0.03)) if hand else ():
        text += link(f"{side}_{finger}") + joint(names[-1], f"{side}_{finger}", f"{x} 0 0.1")
    return text


def robot(*arms: str, rest: str = "") -> str:
    """A base with a wheel on either side, and a torso on three joints of its own."""
    wheels = "".join(
        link(w) + joint("base", w, f"0 {y} 0") for w, y in (("left_wheel", 0.2), ("right_wheel", -0.2))
    )
    column = "".join(link(name) for name in ("base", "lift", "turn", "torso"))
    joints = (
        joint("base", "lift", "0 0 0.3")
        + joint("lift", "turn", "0 0 0.3")
        + joint("turn", "torso", "0 0 0.3")
    )
    return f'<robot name="r">{column}{joints}{wheels}{"".join(arms)}{rest}</robot>'


HEAD = link("head") + joint("torso", "head", "0 0 0.4")


def test_the_only_hand_of_a_robot_is_taken(tmp_path):
    hand = load_hand(written(tmp_path, robot(arm("right", -0.2), rest=HEAD), name="r.urdf"))
    assert [one.name for one in hand.links] == ["right_2", "right_thumb", "right_index"]
    assert any("whole robot: the palm is right_2" in note for note in hand.notes)


def test_of_several_hands_one_has_to_be_named(tmp_path):
    text = robot(arm("right", -0.2), arm("left", 0.2), rest=HEAD)
    with pytest.raises(InputError, match=r"2 hands; name one of their palms .*: right_2, left_2"):
        load_hand(written(tmp_path, text, name="r.urdf"))
    named = load_hand(written(tmp_path, text, {"palm": "left_2"}, name="r.urdf"))
    assert [one.name for one in named.links] == ["left_2", "left_thumb", "left_index"]


def test_an_arm_that_hangs_down_beside_the_body_is_an_arm(tmp_path):
    """Up to a shoulder and down again: its hand is as near to the body as a finger is to a palm."""
    hanging = arm("right", -0.1).replace('xyz="0 0 0.3"', 'xyz="0 0 -0.15"')
    eyes = "".join(link(e) + joint("torso", e, f"0 {y} 0.4") for e, y in (("left_eye", 0.03), ("head", 0.0)))
    hand = load_hand(written(tmp_path, robot(hanging, rest=eyes), name="r.urdf"))
    assert [one.name for one in hand.links] == ["right_2", "right_thumb", "right_index"]


@pytest.mark.parametrize("hand", [False, True])
def test_an_arm_alone_is_warned_of_and_one_with_a_gripper_is_not(tmp_path, hand):
    text = f'<robot name="r">{link("torso")}{arm("right", 0.0, 4, hand=hand)}</robot>'
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", InputWarning)
        loaded = load_hand(written(tmp_path, text, name="r.urdf"))
    said = [str(one.message) for one in caught if issubclass(one.category, InputWarning)]
    if hand:
        assert (loaded.links[0].name, said) == ("right_3", [])
    else:
        assert (
            loaded.links[0].name == "torso"
            and "torso was taken for the palm, and what it carries is 0.9 m" in said[0]
        )


def test_fingers_with_branches_are_no_arms(tmp_path):
    """A linkage far out on a finger, or a long finger with few joints, leaves the palm where it is."""
    finger = (
        link("far") + joint("index", "far", "0 0 0.04") + link("rod") + joint("index", "rod", "0 0.01 0.04")
    )
    text = (
        f'<robot name="r">{link("palm")}{link("thumb")}{joint("palm", "thumb", "0.03 0 0.1")}{link("index")}'
        f"{joint('palm', 'index', '-0.03 0 0.1')}{finger}</robot>"
    )
    assert load_hand(written(tmp_path, text, name="r.urdf")).links[0].name == "palm"


def chain(turn: str) -> str:
    """An arm of five joints without branches, whose last one turns so far."""
    names = [f"link_{i}" for i in range(6)]
    last = joint(names[-2], names[-1], "0.02 0 0.05").replace(LIMIT, turn)
    joints = "".join(joint(a, b, "0 0 0.15") for a, b in pairwise(names[:-1]))
    return f'<robot name="r">{"".join(link(name) for name in names)}{joints}{last}</robot>'


def test_the_hand_of_an_arm_may_be_one_jaw(tmp_path):
    hand = load_hand(written(tmp_path, chain(LIMIT), name="r.urdf"))
    assert [one.name for one in hand.links] == ["link_4", "link_5"]
    assert any("a gripper of one jaw, link_5: the palm is link_4" in note for note in hand.notes)
    for ends in ('lower="-3" upper="3"', 'lower="-0.7" upper="0.7"'):
        wrist = f'<limit {ends} effort="1" velocity="1"/>'
        with pytest.warns(InputWarning, match="link_0 was taken for the palm"):
            assert load_hand(written(tmp_path, chain(wrist), name="r.urdf")).links[0].name == "link_0"


def test_hands_on_slides_are_hands_of_a_robot(tmp_path):
    """As where a program moves each of two hands about: nothing of such an arm is long."""

    def carried(side: str) -> str:
        names = ["torso", f"{side}_x", f"{side}_y", f"{side}_palm"]
        slides = "".join(
            joint(a, b, "0 0 0", "prismatic").replace('lower="-0.3" upper="1.2"', 'lower="-1" upper="1"')
            for a, b in pairwise(names)
        )
        fingers = "".join(link(f"{side}_{k}") + joint(names[-1], f"{side}_{k}", f"{k} 0 0.1") for k in (1, 2))
        return "".join(link(name) for name in names[1:]) + slides + fingers

    text = f'<robot name="r">{link("torso")}{carried("left")}{carried("right")}</robot>'
    with pytest.raises(InputError, match=r"2 hands; name one of their palms .*: left_palm, right_palm"):
        load_hand(written(tmp_path, text, name="r.urdf"))


def test_of_arms_that_stand_side_by_side_a_gripper_has_to_be_named(tmp_path):
    """As in scenes with two arms, where what else stands about is no hand."""

    def stands(side: str) -> str:
        return arm(side, 0.0).replace('parent link="torso"', 'parent link="world"')

    text = f'<robot name="r">{stands("left")}{stands("right")}{link("table")}</robot>'
    with pytest.raises(InputError, match=r"on the world stand 2 hands; name one .*: left_2, right_2"):
        load_hand(written(tmp_path, text, name="r.urdf"))
