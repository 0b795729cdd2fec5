"""What published models have and MuJoCo refuses, or reads otherwise than their authors moved them."""

import contextlib

import mujoco
import numpy as np
import pytest
import trimesh
from holdfast.errors import InputError
from holdfast.geometry import invert
from holdfast.hands import load_hand
from holdfast.hands.kinematics import forward_kinematics

from .test_import import body_pose, mujoco_model
from .test_odd_models import BALL, INERTIAL, LIMIT, SECOND, check_motion, imported, mjcf, urdf, written

MESH = '<collision><geometry><mesh filename="{}"/></geometry></collision>'


def note_of(hand, words: str) -> str:
    (found,) = [note for note in hand.notes if words in note]
    return found


def test_of_what_stands_twice_in_a_urdf_the_first_is_taken(tmp_path, capfd):
    twice = LIMIT.replace("1.2", "0.1") + '<axis xyz="1 0 0"/>'
    named = BALL.replace("<collision>", '<collision name="ball">')
    text = urdf(one=INERTIAL + named + INERTIAL, two=INERTIAL + named + named).replace(
        f"{LIMIT}</joint>", f"{LIMIT}{twice}</joint>"
    )
    hand = imported(tmp_path, text)
    assert [axis.upper for axis in hand.axes] == [1.2, 1.2]
    assert np.allclose([axis.direction for axis in hand.axes], [0, 1, 0])
    told = note_of(hand, "more than once")
    for what in ("inertial of one", "limit of bend", "axis of bend", "limit of follow", "axis of follow"):
        assert what in told
    assert "".join(capfd.readouterr()) == ""  # MuJoCo has nothing to say of names


def test_moments_of_inertia_that_mujoco_takes_for_none(tmp_path):
    grain = INERTIAL.replace("0.05", "1.6e-7").replace("1e-5", "4e-15")
    hand = imported(tmp_path, urdf(two=grain + BALL))
    assert "two" in note_of(hand, "inertia that no body has")


@pytest.mark.parametrize(
    ("named", "where"),
    [
        ("/someone/hand/meshes/w.stl", "meshes/w.stl"),
        ("file:/someone/hand/meshes/w.stl", "meshes/w.stl"),
        ("file:///someone/hand/meshes/w.stl", "parts/w.stl"),
        ("../../../../meshes/w.stl", "meshes/w.stl"),
    ],
)
def test_a_mesh_that_is_named_from_someone_elses_folder_is_found(tmp_path, named, where):
    (tmp_path / where).parent.mkdir()
    trimesh.creation.box((0.02, 0.02, 0.02)).export(tmp_path / where)
    hand = imported(tmp_path, urdf(two=INERTIAL + MESH.format(named)))
    assert len(hand.links[2].shapes) == 1
    (tmp_path / "again").mkdir()
    (tmp_path / where).rename(tmp_path / "again" / "v.stl")
    with pytest.raises(InputError, match="below the folder"):
        imported(tmp_path, urdf(two=INERTIAL + MESH.format(named)))


def test_settings_sensors_and_key_frames_stop_no_hand(tmp_path):
    rest = (
        '<option noslip_stepations="3"/><size njmax="1" fast="1"/><visual><map blur="1"/></visual>'
        '<keyframe><key qpos="1 2 3 4 5 6 7 8 9"/></keyframe><sensor><touch site="nowhere"/></sensor>'
        '<statistic mood="1"/><custom><numeric name="n" data="1" size="1000000"/></custom>'
    )
    assert load_hand(written(tmp_path, mjcf(rest=rest))).notes == load_hand(written(tmp_path, mjcf())).notes


def test_attributes_that_mujoco_does_not_know_are_left_out_and_told(tmp_path):
    text = mjcf(one='<geom size="0.01" pos="0 0 0.01" mass="0.03" fuzzy="1 2"/>').replace(
        '<joint name="follow"', '<joint glow="a&gt;b" name="follow"'
    )
    hand = imported(tmp_path, text)
    assert note_of(hand, "does not know").endswith("left out: glow of joint, fuzzy of geom")
    with pytest.raises(InputError, match=r"unrecognized attribute: .a\d."):
        many = " ".join(f'a{i}="1"' for i in reversed(range(30)))
        imported(tmp_path, mjcf(one=f"<geom size='0.01' mass='0.1' {many}/>"))


FINGER = """<mujoco model="finger"><compiler angle="radian" meshdir="parts"/>
<default><default class="f"><joint range="-0.2 1.4"/>
<default class="end"><geom size="0.009"/></default></default></default>
<asset><mesh name="wedge" vertex="0 0 0 0.01 0 0 0 0.01 0 0 0 0.02"/><mesh file="nail.stl"/></asset>
<worldbody><body name="root" childclass="f"><inertial pos="0 0 0" mass="0.03" diaginertia="1e-9 1e-9 -1"/>
<joint name="bend" axis="0 1 0"/><geom size="0.008" type="capsule" fromto="0 0 0 0 0 0.04"/>
<body name="tip" pos="0 0 0.042"><joint name="curl" axis="0 1 0"/><geom class="end" pos="0 0 0.01"/>
<geom type="mesh" mesh="wedge"/><geom type="mesh" mesh="nail"/></body></body></worldbody></mujoco>"""
PALM = (
    '<mujoco><compiler angle="radian"/>{}<worldbody><body name="palm"><geom size="0.03" mass="0.3"/>{}</body>'
    "</worldbody></mujoco>"
)
ATTACHED = '<asset><model name="finger" file="parts/finger.xml"/></asset>'


def test_models_that_attach_others_move_as_in_mujoco(tmp_path):
    place = (
        '<frame pos="{0} 0 0.02" euler="0 0.1 {0}"><attach model="finger" body="root" prefix="{1}_"/></frame>'
    )
    text = PALM.format(ATTACHED, place.format("-0.03", "a") + place.format("0.03", "b"))
    parts = tmp_path / "parts"
    (parts / "parts").mkdir(parents=True)
    (parts / "finger.xml").write_text(FINGER, "utf-8")
    trimesh.creation.box((0.01, 0.01, 0.002)).export(parts / "parts" / "nail.stl")
    hand = imported(tmp_path, text)
    assert hand.joint_names == ("a_bend", "a_curl", "b_bend", "b_curl")
    assert [len(link.shapes) for link in hand.links] == [1, 1, 3, 1, 3]
    assert "root" in note_of(hand, "inertia that no body has")
    assert np.linalg.eigvalsh(hand.links[1].inertia.inertia).min() > 1e-8
    (parts / "finger.xml").write_text(FINGER.replace("1e-9 1e-9 -1", "1e-6 1e-6 1e-6"), "utf-8")
    (parts / "nail.stl").write_bytes((parts / "parts" / "nail.stl").read_bytes())
    plain = text.replace("parts/finger.xml", "finger.xml")
    (parts / "plain.xml").write_text(plain, "utf-8")
    with contextlib.chdir(parts):
        check_motion(hand, mujoco_model(parts / "plain.xml")[0], "palm")


@pytest.mark.parametrize(
    ("attached", "words"),
    [
        ("../../secret.xml", "must be a path below the folder"),
        ("none.xml", "none.xml: no such file"),
        ("model.xml", "more than 100 files are included or attached"),
        ("robot.urdf", "is attached, and has to be MJCF"),
    ],
)
def test_what_can_not_be_attached_is_refused(tmp_path, attached, words):
    (tmp_path / "robot.urdf").write_text("<robot name='r'/>", "utf-8")
    with pytest.raises(InputError, match=words):
        load_hand(
            written(
                tmp_path,
                PALM.format(
                    ATTACHED.replace("parts/finger.xml", attached), '<attach model="finger" body="root"/>'
                ),
            )
        )


def test_what_is_attached_again_and_again_is_counted(tmp_path):
    """Ten times in each of nine files would be a thousand million bodies."""
    body = '<attach model="finger" body="palm" prefix="{}"/>'
    for i in range(9):
        text = PALM.format(
            ATTACHED.replace("parts/finger", f"m{i + 1}"), "".join(body.format(f"p{k}_") for k in range(10))
        )
        (tmp_path / f"m{i}.xml").write_text(text, "utf-8")
    (tmp_path / "m9.xml").write_text(PALM.format("", ""), "utf-8")
    with pytest.raises(InputError, match="attach: makes more than 50000 elements"):
        load_hand(written(tmp_path, (tmp_path / "m0.xml").read_text("utf-8")))


def test_replicated_fingers_move_as_in_mujoco(tmp_path):
    finger = '<body name="one"><joint name="bend" axis="0 1 0" range="-1 1"/><geom size="0.01"/></body>'
    text = PALM.format(
        "", f'<replicate count="3" euler="0 0 2" sep="_"><frame pos="0.03 0 0">{finger}</frame></replicate>'
    )
    hand = imported(tmp_path, text)
    assert hand.joint_names == ("bend_0", "bend_1", "bend_2")
    check_motion(hand, mujoco_model(tmp_path / "model.xml")[0], "palm")


CURVED = '<equality><joint joint1="follow" joint2="bend" polycoef="0.01 1.35 {} 0.07 0.01"/></equality>'


def test_a_straight_line_stands_for_a_joint_that_follows_on_a_curve(tmp_path):
    hand = imported(tmp_path, mjcf(rest=CURVED.format(-0.36)))
    bend, follow = hand.axes
    assert follow.coupling is not None
    at = np.linspace(bend.lower, bend.upper, 100)
    curve = np.polynomial.polynomial.polyval(at, [0.01, 1.35, -0.36, 0.07, 0.01])
    off = np.degrees(np.abs(follow.coupling.ratio * at + follow.coupling.offset - curve).max())
    assert 0.5 < off < 5.0
    assert f"it is off by {off:.2g} degrees at most" in note_of(hand, "follows bend on a curve")
    # The hand keeps all of the driven joint's range.
    ends = [follow.coupling.ratio * end + follow.coupling.offset for end in (bend.lower, bend.upper)]
    assert (follow.lower, follow.upper) == pytest.approx(ends)
    with pytest.raises(
        InputError, match=r"something else than offset [+] ratio .* say in coupled how 'follow'"
    ):
        imported(tmp_path, mjcf(rest=CURVED.format(3.0)))


TIED = """<tendon><fixed name="t" stiffness="{}" springlength="0.2"><joint joint="bend" coef="0.4"/>
  <joint joint="follow" coef="-0.4"/></fixed></tendon>
  <equality><tendon tendon1="t" polycoef="{}"/></equality>"""


def test_a_spring_leads_a_joint_that_an_equality_would_lead_out_of_its_limits(tmp_path):
    """As MuJoCo moves links that weigh next to nothing: there its equalities are weaker than springs."""
    hand = imported(tmp_path, mjcf(rest=TIED.format(3.0, "0.8 1 0 0 0")))
    follow = hand.axes[1]
    assert (follow.coupling.ratio, follow.coupling.offset) == pytest.approx((1.0, -0.5))
    assert "follows by the spring of their tendon" in note_of(hand, "can't follow bend")
    possible = imported(tmp_path, mjcf(rest=TIED.format(3.0, "0.1 1 0 0 0")))
    assert possible.axes[1].coupling.offset == pytest.approx(-0.25)
    with pytest.raises(InputError, match=r"the limits of 'bend' .* exclude each other"):
        imported(tmp_path, mjcf(rest=TIED.format(0.0, "0.8 1 0 0 0")))


def test_the_fingers_of_an_arm_collide_as_drawn_where_they_do_not_collide(tmp_path):
    drawn = BALL.replace("collision", "visual")
    arm = (
        f'<link name="base">{INERTIAL + BALL}</link><joint name="turn" type="revolute"><parent link="base"/>'
        f'<child link="palm"/>{LIMIT}</joint>'
    )
    bare = dict.fromkeys(("palm", "one", "two"), INERTIAL + drawn)
    hand = imported(
        tmp_path, urdf(**bare, extra=arm + SECOND.replace("collision", "visual")), {"palm": "palm"}
    )
    assert [len(link.shapes) for link in hand.links] == [1, 1, 1, 1]
    assert note_of(hand, "the hand's links have no collision elements")


def test_hinges_that_turn_somewhat_more_than_once_around_do_so_once(tmp_path):
    far = LIMIT.replace("-0.3", "-3.05").replace("1.2", "6.81")
    hand = imported(tmp_path, urdf(follow=far))
    assert (hand.axes[1].lower, hand.axes[1].upper) == (-3.05, 2.0 * np.pi)
    assert note_of(hand, "more than once around").startswith("follow: ")
    with pytest.raises(InputError, match=r"limits.follow: .* are they in degrees"):
        imported(tmp_path, urdf(follow=LIMIT.replace("1.2", "90")))


@pytest.mark.parametrize("kind", ["fixed", "revolute"])
def test_the_world_needs_no_link_of_its_own(tmp_path, kind):
    stands = f'<joint name="stands" type="{kind}"><parent link="world"/><child link="palm"/>{LIMIT}</joint>'
    assert [link.name for link in imported(tmp_path, urdf(extra=stands)).links] == ["palm", "one", "two"]


def test_of_meshes_of_the_same_name_the_first_is_taken(tmp_path):
    for name, side in (("a", 0.02), ("b", 0.05)):
        trimesh.creation.box((side, side, side)).export(tmp_path / f"{name}.stl")
    twice = '<asset><mesh name="part" file="a.stl"/><mesh name="part" file="b.stl"/></asset>'
    hand = imported(tmp_path, mjcf(two='<geom type="mesh" mesh="part" mass="0.03"/>', rest=twice))
    assert np.ptp(hand.links[2].shapes[0].vertices, axis=0) == pytest.approx([0.02] * 3)
    assert note_of(hand, "meshes of the same name") == (
        "meshes of the same name, of which the first was taken: part"
    )


@pytest.mark.parametrize(("ends", "absent"), [('lower="0.5"', "upper"), ('upper="-0.5"', "lower")])
def test_limits_that_exclude_each_other_are_not_none(tmp_path, ends, absent):
    follow = f'<limit {ends} effort="1" velocity="1"/>'
    with pytest.raises(
        InputError, match=rf"joint follow.limit: the lower limit .* for {absent} is not there"
    ):
        imported(tmp_path, urdf(follow=follow))


def test_limits_the_wrong_way_round_are_turned(tmp_path):
    hand = imported(tmp_path, urdf(follow='<limit lower="1" upper="-0.5" effort="1" velocity="1"/>'))
    assert (hand.axes[1].lower, hand.axes[1].upper) == (-0.5, 1.0)
    assert note_of(hand, "limits the wrong way round") == (
        "limits the wrong way round, turned: follow (1 to -0.5)"
    )


@pytest.mark.parametrize("kind", ["fixed", "revolute"])
def test_a_hand_cut_off_its_robot_stands_on_a_wrist_that_is_not_there(tmp_path, kind):
    stands = f'<joint name="stands" type="{kind}"><parent link="wrist"/><child link="palm"/>{LIMIT}</joint>'
    hand = imported(tmp_path, urdf(extra=stands + SECOND))
    assert note_of(hand, "link wrist, on which all others hang, is not in the model")
    assert [link.name for link in hand.links] == ["palm", "one", "two", "other"]
    assert hand.links[0].shapes
    # A slip of the pen leaves the link that it means hanging on nothing.
    with pytest.raises(InputError, match=r"joint bend.parent: unknown link 'plam'.*'palm'"):
        imported(tmp_path, urdf().replace('parent link="palm"', 'parent link="plam"'))


def test_a_joint_with_equal_limits_stands_still(tmp_path):
    hand = imported(tmp_path, urdf(follow='<limit lower="0.3" upper="0.3" effort="1" velocity="1"/>'))
    assert hand.joint_names == ("bend",)
    first, second = hand.links[1].shapes
    model = mujoco_model(tmp_path / "model.xml")[0]
    data = mujoco.MjData(model)
    data.joint("follow").qpos[0] = 0.3
    mujoco.mj_kinematics(model, data)
    expected = invert(body_pose(data, "one")) @ body_pose(data, "two")
    assert np.allclose(second.centre - first.centre, expected[:3, 3], atol=1e-12)


def test_names_in_another_script_and_names_that_stand_twice(tmp_path):
    text = urdf().replace('"one"', '"指一"').replace('"two"', '"指二"').replace('"follow"', '"bend"')
    hand = imported(tmp_path, text)
    assert [link.name for link in hand.links] == ["palm", "link_2", "link_3"]
    assert hand.joint_names == ("bend", "bend_2")
    assert note_of(hand, "same name").endswith("renamed: bend_2")


@pytest.mark.parametrize("ratio", ["-1", "-0.5"])
def test_limits_of_a_follower_that_have_the_wrong_sign_are_turned_round(tmp_path, ratio):
    """As those of a gripper whose inner fingers turn back as its jaws close: nothing of it could move."""
    follow = LIMIT.replace("-0.3", "0") + f'<mimic joint="bend" multiplier="{ratio}"/>'
    text = urdf(follow=follow).replace('lower="-0.3"', 'lower="0"')
    hand = imported(tmp_path, text)
    assert hand.limits.tolist() == [pytest.approx([0.0, 1.2])]
    assert (hand.axes[1].lower, hand.axes[1].upper) == (-1.2, 0.0)
    assert "follow" in note_of(hand, "with the other sign")
    # Limits that leave a part of the way are meant.
    some = imported(
        tmp_path,
        text.replace(
            'lower="0" upper="1.2" effort="2" velocity="1"/><mimic',
            'lower="-0.4" upper="1.2" effort="2" velocity="1"/><mimic',
        ),
    )
    assert (some.axes[1].lower, some.axes[1].upper) == (-0.4, 1.2)
    given = imported(tmp_path, text, {"limits": {"follow": [0.0, 1.2]}})
    assert given.limits[0].tolist() == [0.0, 0.0]


@pytest.mark.parametrize(
    ("text", "at"),
    [
        (urdf(follow=LIMIT + '<mimic joint="bend" multiplier="0" offset="0.25"/>'), 0.25),
        (mjcf(rest='<equality><joint joint1="follow" polycoef="0.25 0 0 0 0"/></equality>'), 0.25),
        (
            mjcf(rest='<equality><joint joint1="follow" joint2="bend" polycoef="0.25 0 0 0 0"/></equality>'),
            0.25,
        ),
    ],
)
def test_a_joint_that_follows_nothing_stands_still(tmp_path, text, at):
    free = imported(tmp_path, urdf() if "<robot" in text else mjcf())
    hand = imported(tmp_path, text)
    assert hand.joint_names == ("bend",)
    assert "follow stands still" in note_of(hand, "stands still")
    for bend in (0.0, 0.4):
        theirs = forward_kinematics(free, np.array([bend, at]))[-1]
        (link,) = [i for i, one in enumerate(hand.links) if one.name == "one"]
        ours = forward_kinematics(hand, np.array([bend]))[link]
        ball = hand.links[link].shapes[-1].centre
        their_ball = free.links[-1].shapes[-1].centre
        assert np.allclose(ours[:3, :3] @ ball + ours[:3, 3], theirs[:3, :3] @ their_ball + theirs[:3, 3])


@pytest.mark.parametrize("word", ["g", "o"])
def test_all_groups_of_an_obj_file_weigh(tmp_path, word):
    """MuJoCo takes the corners of all and the faces of the first, so that a flat one bounds no volume."""
    box = trimesh.creation.box((0.02, 0.02, 0.02))
    is_top = box.face_normals[:, 2] > 0.5
    lines = []
    for part in (is_top, ~is_top):
        first = sum(line.startswith("v ") for line in lines) + 1
        lines += [f"{word} part_{first}", *(f"v {a} {b} {c}" for a, b, c in box.vertices)]
        lines += [f"f {a + first} {b + first} {c + first}" for a, b, c in box.faces[part]]
    (tmp_path / "two.obj").write_text("\n".join(lines) + "\n", "utf-8")
    parts = '<mesh name="two" file="two.obj"/>'
    text = mjcf(two='<geom type="mesh" mesh="two" density="1000"/>', rest=f"<asset>{parts}</asset>")
    hand = imported(tmp_path, text)
    assert hand.links[2].inertia.mass == pytest.approx(1000 * 0.02**3, rel=1e-3)
    assert hand.links[2].inertia.centre == pytest.approx([0.0, 0.0, 0.0], abs=1e-6)
