"""Closed linkages become trees whose joints move as those of the closed model, or are refused."""

import mujoco
import numpy as np
import pytest
from holdfast.errors import InputError
from holdfast.geometry import PointRegion
from holdfast.hands import load_hand
from holdfast.objects import Contact, ObjectRegion, Task, load_object
from holdfast.solver import solve

CRANK = '<position joint="crank" kp="5" kv="0.1" forcerange="-2 2"/>'
PIN = '<connect body1="pad" body2="crank" anchor="0 -0.02 0"/>'
WIDE = 'range="-1.3 1.3"'
COUPLER = '<joint name="coupler" axis="1 0 0" pos="0 0 0.05" range="-0.8 0"/>'


def gripper(
    *,
    drawn_in: float = 0.0,
    crank: str = 'range="-0.2 0.8"',
    spring: str = "",
    rest: str = PIN,
    drive: str = CRANK,
    coupler: str = "",
) -> str:
    """A finger that a crank closes, and a rod beside it: a parallelogram, unless it is drawn in.

    With a coupler the pin is on a link of its own, which a spring of the rod keeps at its stop.
    """
    y = 0.02 - drawn_in
    link = f'<body name="link">{coupler}<geom size="0.003" pos="0 0 0.05" mass="0.002"/></body>'
    end = link if coupler else ""
    return f"""<mujoco><compiler angle="radian"/><worldbody><body name="palm"><geom size="0.02" mass="0.3"/>
    <body name="crank" pos="0 0 0.02"><joint name="crank" axis="1 0 0" {crank}/>
      <geom type="capsule" size="0.004" fromto="0 0 0.01 0 0 0.05" mass="0.01"/>{end}</body>
    <body name="rod" pos="0 {y} 0.02"><joint name="rod" axis="1 0 0" range="-1 1.2" {spring}/>
      <geom type="capsule" size="0.004" fromto="0 0 0.01 0 0 0.05" mass="0.01"/>
      <body name="pad" pos="0 {0.02 - y} 0.05"><joint name="pad" axis="1 0 0" range="-1 1"/>
        <geom type="box" size="0.01 0.011 0.015" pos="0 -0.005 0.015" mass="0.01"/></body></body>
    </body></worldbody><equality>{rest}</equality><actuator>{drive}</actuator></mujoco>"""


def imported(tmp_path, text, more=""):
    (tmp_path / "hand.xml").write_text(text)
    (tmp_path / "hand.yaml").write_text(f"import: hand.xml\npalm: palm\n{more}")
    return load_hand(tmp_path / "hand.yaml")


def test_a_parallelogram_turns_by_ones(tmp_path):
    hand = imported(tmp_path, gripper())
    assert hand.independent_names == ("crank",)
    assert hand.expand(np.array([0.5])) == pytest.approx([0.5, 0.5, -0.5], abs=0.0)
    note = next(note for note in hand.notes if "loop of crank" in note)
    assert "rod follows by 1, pad follows by -1; they leave it open by 0.00" in note or "e-" in note
    # The crank is no finger of its own: it stays at the other side of the loop, which bears the pad.
    assert {name.partition("/")[0] for name in hand.regions} - {"palm"} == {"finger_1"}


def test_other_linkages_move_as_in_mujoco(tmp_path):
    text = gripper(drawn_in=0.004)
    hand = imported(tmp_path, text)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    assert hand.axes[1].coupling.ratio != 1.0
    for q in np.linspace(*hand.limits[0], 7):
        data.qpos[:] = hand.expand(np.array([q]))
        mujoco.mj_forward(model, data)
        pin = data.efc_pos[data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY]
        assert np.abs(pin).max() < 2e-3


def test_a_joint_that_a_spring_keeps_at_its_stop_stands_still(tmp_path):
    pin = PIN.replace('body2="crank"', 'body2="link"')
    text = gripper(spring='stiffness="0.05" springref="2.6"', rest=pin, coupler=COUPLER)
    hand = imported(tmp_path, text)
    assert [link.name for link in hand.links] == ["palm", "crank", "rod", "pad"]
    assert any("coupler stands still" in note for note in hand.notes)
    assert np.abs(hand.expand(np.array([0.6])) - [0.6, 0.6, -0.6]).max() < 0.01


def test_a_crank_without_limits_turns_as_far_as_the_loop_follows(tmp_path):
    hand = imported(tmp_path, gripper(crank="", drawn_in=0.004))
    lower, upper = hand.limits[0]
    assert -np.pi < lower < 0.0 < upper < np.pi
    assert any("where it closes" in note for note in hand.notes)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (gripper(drive=""), r"none of its joints is driven \(crank, rod, pad\)"),
        (
            gripper(drive=CRANK + '<position joint="rod" kp="1"/>'),
            r"more than one of its joints is driven \(crank, rod\)",
        ),
        (gripper(drawn_in=-0.02, crank=WIDE), r"not follow 'crank' in straight lines .* by 2\.7 mm.*'pad'"),
        (gripper(rest=PIN.replace("connect", "weld").replace('anchor="0 -0.02 0"', "")), "does not close"),
    ],
)
def test_what_no_straight_lines_stand_for_is_refused(tmp_path, text, words):
    with pytest.raises(InputError, match=words):
        imported(tmp_path, text)


def test_what_carries_the_hand_about_closes_no_loop(tmp_path):
    """Environments weld a palm, or a finger, to a body that the program moves."""
    mocap = '<body name="mocap" mocap="true" pos="0 0 0.1"/>'
    text = gripper().replace("</worldbody>", mocap + "</worldbody>")
    for body in ("palm", "crank"):
        welded = text.replace("<equality>", f'<equality><weld body1="mocap" body2="{body}"/>')
        hand = imported(tmp_path, welded)
        assert hand.independent_names == ("crank",)
        said = any("ties the hand to what is left out" in note for note in hand.notes)
        assert said == (body == "crank")  # the palm itself is fixed anyway


def test_the_hand_file_may_say_how_the_joints_follow(tmp_path):
    coupled = "coupled: {rod: {to: crank}, pad: {to: crank, ratio: -1}}\nactuator: "
    servo = "{effort: 1, stiffness: 10, damping: 0.1, armature: 0.001}\n"
    hand = imported(tmp_path, gripper(drive="", drawn_in=0.012), coupled + servo)
    assert hand.expand(np.array([0.3])) == pytest.approx([0.3, 0.3, -0.3])


@pytest.mark.parametrize("drawn_in", [0.0, 0.004])
def test_what_the_pad_of_a_linkage_touches_is_found(tmp_path, drawn_in):
    # Not long ago rounding alone refuted the second: a row said that 4e-16 times a product is zero.
    hand = imported(tmp_path, gripper(drawn_in=drawn_in))
    (tmp_path / "ball.yaml").write_text(
        "name: ball\nsphere: {radius: 0.02}\nmass: 0.1\nfriction: 0.6\nregions:\n"
        "  top: {point: [0, 0, 0.02], normal: [0, 0, 1]}\n"
    )
    ball = load_object(tmp_path / "ball.yaml")
    region = PointRegion(np.array([0.0, 0.0, 0.02]), np.array([0.0, 0.0, 1.0]))
    pairs = [Contact(hand.regions["finger_1/pad"], ObjectRegion("top", region))]
    assert solve(Task(hand=hand, object=ball, contacts=pairs), candidates=1).configurations
