"""Odd models of hands, kind by kind: imported as MuJoCo itself moves them, or refused in words."""

from pathlib import Path

import mujoco
import numpy as np
import pytest
import trimesh
import yaml
from holdfast.errors import InputError
from holdfast.geometry import Box, Hull, invert
from holdfast.hands import Hand, forward_kinematics, load_hand
from holdfast.hands.new_file import new_hand_file
from holdfast.mjcf import hand_mjcf

from .test_import import SERVO, body_pose, mujoco_model, write_wedge

INERTIA = '<inertia ixx="1e-5" iyy="1e-5" izz="1e-5" ixy="0" ixz="0" iyz="0"/>'
INERTIAL = f'<inertial><origin xyz="0 0 0.02"/><mass value="0.05"/>{INERTIA}</inertial>'
BALL = '<collision><geometry><sphere radius="0.01"/></geometry></collision>'
LIMIT = '<limit lower="-0.3" upper="1.2" effort="2" velocity="1"/>'


def urdf(
    *,
    palm: str = INERTIAL + BALL,
    one: str = INERTIAL + BALL,
    two: str = INERTIAL + BALL,
    follow: str = LIMIT,
    extra: str = "",
) -> str:
    """A finger of two links on a palm."""
    return f"""<robot name="pkg"><link name="palm">{palm}</link>
    <link name="one">{one}</link><link name="two">{two}</link>
    <joint name="bend" type="revolute"><parent link="palm"/><child link="one"/>
      <origin xyz="0 0.01 0.05" rpy="0.3 0.2 0.1"/><axis xyz="0 1 0"/>{LIMIT}</joint>
    <joint name="follow" type="revolute"><parent link="one"/><child link="two"/>
      <origin xyz="0 0 0.04"/><axis xyz="0 1 0"/>{follow}</joint>{extra}</robot>"""


# Another finger on the palm.
SECOND = (
    f'<link name="other">{INERTIAL + BALL}</link><joint name="close" type="revolute"><parent link="palm"/>'
    f'<child link="other"/><origin xyz="0 -0.01 0.05"/><axis xyz="0 1 0"/>{LIMIT}</joint>'
)


def above(kind: str) -> str:
    """A link and a joint above the palm, neither with a mass."""
    return (
        f'<link name="mount"/><joint name="above" type="{kind}"><parent link="mount"/><child link="palm"/>'
        '<origin xyz="0.1 0.2 0.3" rpy="0.1 0.2 0.3"/><axis xyz="0 0 1"/>'
        '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
    )


def mjcf(
    *,
    palm: str = '<geom size="0.02" mass="0.3"/>',
    one: str = '<geom size="0.01" pos="0 0 0.01" mass="0.03"/>',
    two: str = '<geom size="0.01" pos="0 0 0.01" mass="0.03"/>',
    above: str = "",
    world: str = "",
    rest: str = "",
) -> str:
    """A finger of two links on a palm."""
    return f"""<mujoco><compiler angle="radian"/><worldbody>{world}
    <body name="palm" pos="0.1 0 0" quat="0.9 0.1 0.2 0.3">{above}{palm}
      <body name="one" pos="0 0.01 0.05" quat="0.9 0 0.1 0">
        <joint name="bend" axis="0 1 0" range="-0.3 1.2"/>{one}
        <body name="two" pos="0 0 0.04"><joint name="follow" axis="0 1 0" range="-0.5 1.5"/>{two}</body>
      </body></body></worldbody>{rest}</mujoco>"""


def written(folder: Path, model: str, hand: dict | None = None, name: str = "model.xml") -> Path:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(model, "utf-8")
    out = folder / "hand.yaml"
    out.write_text(
        yaml.safe_dump({"name": "odd", "import": name, "actuator": SERVO, **(hand or {})}), "utf-8"
    )
    return out


def imported(folder: Path, model: str, hand: dict | None = None, name: str = "model.xml") -> Hand:
    """The hand; it goes into MuJoCo again, which a mass or an inertia that no body has would not."""
    got = load_hand(written(folder, model, hand, name))
    mujoco.MjModel.from_xml_string(hand_mjcf(got))
    return got


def check_motion(hand: Hand, model: mujoco.MjModel, palm: str, bodies: dict[str, str] | None = None) -> None:
    """Link poses against MuJoCo's own, coupled joints free."""
    data, rng = mujoco.MjData(model), np.random.default_rng(0)
    for _ in range(20):
        q = rng.uniform(-0.5, 0.5, len(hand.axes))
        for name, position in zip(hand.joint_names, q, strict=True):
            data.joint(name).qpos[0] = position
        mujoco.mj_kinematics(model, data)
        for T, link in list(zip(forward_kinematics(hand, q), hand.links, strict=True))[1:]:
            expected = invert(body_pose(data, palm)) @ body_pose(
                data, (bodies or {}).get(link.name, link.name)
            )
            assert np.abs(T - expected).max() < 1e-12


# Meshes: where they lie from the folder of the hand file, the model's name, and how the model names them.
@pytest.mark.parametrize(
    ("model", "mesh", "named", "meshdir"),
    [
        ("a.urdf", "meshes/w.stl", "meshes/w.stl", ""),
        ("a.urdf", "meshes/w.stl", "./meshes/w.stl", "meshes"),
        ("a.urdf", "meshes/w.stl", "meshes/w.stl", "meshes/"),
        ("a.urdf", "meshes/right/w.stl", "right/w.stl", "meshes/right"),
        ("a.urdf", "meshes/w.stl", "package:///meshes/w.stl", ""),
        ("a.urdf", "meshes/w.stl", "package://meshes/w.stl", ""),
        ("a.urdf", "meshes/w.stl", "package://hand_description/meshes/w.stl", ""),
        ("urdf/a.urdf", "meshes/w.stl", "package://hand_description/meshes/w.stl", ""),
        ("urdf/a.urdf", "meshes/w.stl", "package:///meshes/w.stl", ""),
        ("urdf/a.urdf", "meshes/w.stl", "model://hand_description/meshes/w.stl", ""),
        ("urdf/a.urdf", "meshes/w.stl", "../meshes/w.stl", ""),
        ("urdf/a.urdf", "meshes/w.stl", "../meshes/w.stl", "../meshes"),
        ("pkg/urdf/a.urdf", "other/meshes/w.stl", "package://other/meshes/w.stl", ""),
        ("urdf/a.urdf", "meshes/w.stl", "package://outer/v2/hand/meshes/w.stl", ""),
        ("a.urdf", "meshes/collisions/w.STL", "collisions/w.stl", ""),
        ("a.xml", "meshes/w.stl", "meshes/w.stl", "meshes"),
        ("a.xml", "meshes/w.stl", "w.stl", "./meshes/"),
        ("mjcf/a.xml", "meshes/w.stl", "w.stl", "../meshes"),
        ("mjcf/a.xml", "meshes/w.stl", "../meshes/w.stl", "../meshes"),
        ("a.urdf", "w.ply", "w.ply", ""),
        ("a.urdf", "w.glb", "w.glb", ""),
        ("a.urdf", "w.off", "w.off", ""),
    ],
)
def test_meshes_are_found_and_read(tmp_path, model, mesh, named, meshdir):
    write_wedge(tmp_path / mesh)
    if model.endswith(".urdf"):
        shape = f'<collision><geometry><mesh filename="{named}"/></geometry></collision>'
        extra = f'<mujoco><compiler meshdir="{meshdir}"/></mujoco>' if meshdir else ""
        text = urdf(two=INERTIAL + shape, extra=extra)
    else:
        asset = f'<compiler meshdir="{meshdir}"/><asset><mesh name="w" file="{named}"/></asset>'
        text = mjcf(two='<geom type="mesh" mesh="w" mass="0.01"/>', rest=asset)
    hand = imported(tmp_path, text, name=model)
    (hull,) = hand.links[-1].shapes
    assert isinstance(hull, Hull)
    assert np.ptp(hull.vertices, axis=0) == pytest.approx([0.02, 0.012, 0.01], abs=1e-6)


def test_the_meshs_own_place_comes_first(tmp_path):
    write_wedge(tmp_path / "meshes" / "w.stl")
    trimesh.creation.box((0.1, 0.1, 0.1)).export(tmp_path / "w.stl")
    shape = '<collision><geometry><mesh filename="w.stl"/></geometry></collision>'
    (hull,) = imported(tmp_path, urdf(two=INERTIAL + shape)).links[-1].shapes
    assert np.ptp(hull.vertices, axis=0) == pytest.approx([0.1, 0.1, 0.1])


def test_a_text_stl_is_read(tmp_path):
    (tmp_path / "w.stl").write_text(trimesh.creation.box((0.02, 0.03, 0.04)).export(file_type="stl_ascii"))
    shape = '<collision><geometry><mesh filename="w.stl"/></geometry></collision>'
    (hull,) = imported(tmp_path, urdf(two=INERTIAL + shape)).links[-1].shapes
    assert np.ptp(hull.vertices, axis=0) == pytest.approx([0.02, 0.03, 0.04])


def test_a_urdf_without_collision_elements_collides_as_drawn(tmp_path):
    write_wedge(tmp_path / "w.stl")
    drawn = INERTIAL + '<visual><geometry><mesh filename="w.stl"/></geometry></visual>'
    hand = imported(tmp_path, urdf(palm=drawn, one=drawn, two=drawn))
    assert [[type(shape) for shape in link.shapes] for link in hand.links] == [[Hull]] * 3
    assert any("no collision elements" in note for note in hand.notes)


def test_an_mjcf_whose_geoms_are_only_drawn_collides_as_drawn(tmp_path):
    drawn = '<geom type="box" size="0.01 0.01 0.01" contype="0" conaffinity="0" mass="0.01"/>'
    hand = imported(tmp_path, mjcf(palm=drawn, one=drawn, two=drawn))
    assert [[type(shape) for shape in link.shapes] for link in hand.links] == [[Box]] * 3
    assert any("no geom of the model collides" in note for note in hand.notes)


FINGERS_ON_THE_WORLD = "".join(
    f'<body name="{name}" pos="{x} 0 0.05"><joint name="{name}" axis="0 1 0" range="0 60"/>'
    '<geom size="0.01" mass="0.02"/></body>'
    for name, x in (("left", -0.03), ("right", 0.03))
)
PLANE = '<geom type="plane" size="1 1 0.1"/>'
PALM_GEOMS = '<geom type="box" size="0.03 0.03 0.01"/>'


@pytest.mark.parametrize("chosen", [{}, {"palm": "world"}])
def test_a_palm_that_is_part_of_the_world(tmp_path, chosen):
    text = f"<mujoco><worldbody>{PLANE}{PALM_GEOMS}{FINGERS_ON_THE_WORLD}</worldbody></mujoco>"
    region = {"palm/top": {"link": "palm", "point": [0, 0, 0.01], "normal": [0, 0, 1]}}
    hand = imported(tmp_path, text, {**chosen, "regions": region})
    assert [link.name for link in hand.links] == ["palm", "left", "right"]
    assert [type(shape) for shape in hand.links[0].shapes] == [Box]  # the floor is no part of the palm
    check_motion(hand, mujoco.MjModel.from_xml_string(text), "world")


def test_what_floats_beside_fingers_on_the_world_is_left_out(tmp_path):
    ball = '<body name="toy" pos="0 0 1"><freejoint/><geom size="0.05"/></body>'
    text = f"<mujoco><worldbody>{PALM_GEOMS}{FINGERS_ON_THE_WORLD}{ball}</worldbody></mujoco>"
    hand = imported(tmp_path, text, {"palm": "world"})
    assert [link.name for link in hand.links] == ["palm", "left", "right"]
    assert any("toy" in note for note in hand.notes)
    with pytest.raises(
        InputError, match="several bodies stand on the world: left, right, toy; name the palm"
    ):
        load_hand(written(tmp_path, text))


def test_of_the_bodies_of_a_scene_the_one_with_fingers_is_the_hand(tmp_path):
    table = '<body name="table" pos="0 0 1"><geom size="0.05"/></body>'
    drawer = (
        '<body name="drawer" pos="0 1 0"><joint name="pull" type="slide"/><geom size="0.05"/>'
        '<body name="knob"><joint name="turn"/><geom size="0.01"/></body></body>'
    )
    palm = f'<body name="mount"><body name="hand">{PALM_GEOMS}{FINGERS_ON_THE_WORLD}</body></body>'
    scene = f"<mujoco><worldbody>{table}{drawer}{{}}</worldbody></mujoco>"
    hand = imported(tmp_path, scene.format(palm))
    assert [link.name for link in hand.links] == ["mount", "left", "right"]
    assert any("only mount has fingers; left out: table, drawer" in note for note in hand.notes)
    other = palm.replace('name="', 'name="other_')
    with pytest.raises(
        InputError, match=r"on the world stand 2 hands; name one of their palms .*: mount, other_mount"
    ):
        imported(tmp_path, scene.format(palm + other))


NO_MASS = '<inertial><mass value="0"/><inertia ixx="0" iyy="0" izz="0" ixy="0" ixz="0" iyz="0"/></inertial>'
NO_INERTIA = NO_MASS.replace('mass value="0"', 'mass value="0.1"')
MASS_ALONE = '<inertial><mass value="0.1"/></inertial>'
NEGATIVE = NO_INERTIA.replace('ixx="0"', 'ixx="-1e-5"')
LOPSIDED = MASS_ALONE.replace("</i", INERTIA.replace('ixx="1e-5"', 'ixx="1e-3"') + "</i")
MINUS = NO_INERTIA.replace('mass value="0.1"', 'mass value="-0.1"')


@pytest.mark.parametrize("where", ["palm", "one", "two"])
@pytest.mark.parametrize(
    ("inertial", "mass"),
    [
        ("", 1000 * 4 / 3 * np.pi * 1e-6),
        (NO_MASS, 1000 * 4 / 3 * np.pi * 1e-6),
        (MINUS, 1000 * 4 / 3 * np.pi * 1e-6),
        (NO_INERTIA, 0.1),
        (MASS_ALONE, 0.1),
        (NEGATIVE, 0.1),
        (LOPSIDED, 0.1),
    ],
)
def test_links_without_mass_or_with_an_inertia_that_no_body_has(tmp_path, where, inertial, mass):
    hand = imported(tmp_path, urdf(**{where: inertial + BALL}))
    got = hand.links[["palm", "one", "two"].index(where)].inertia
    assert got.mass == pytest.approx(mass, rel=0.01)
    moments = np.linalg.eigvalsh(got.inertia)
    assert moments[0] > 0.0
    assert moments[2] <= (moments[0] + moments[1]) * 1.000001
    if inertial in (NO_INERTIA, MASS_ALONE, NEGATIVE):
        assert moments == pytest.approx(0.4 * 0.1 * 1e-4, rel=0.02)  # the ball's


@pytest.mark.parametrize("bare", ["", NO_MASS])
def test_links_without_matter(tmp_path, bare):
    hand = imported(tmp_path, urdf(one=bare))
    assert hand.links[1].inertia.mass == pytest.approx(1e-3)
    assert any(note.startswith("one: the model gives it no mass") for note in hand.notes)


def test_an_mjcf_link_without_mass(tmp_path):
    massless = '<inertial pos="0 0 0" mass="0" diaginertia="0 0 0"/><geom size="0.01" mass="0"/>'
    crooked = '<inertial pos="0 0 0" mass="0.1" fullinertia="1e-5 1e-5 1e-5 1 0 0"/><geom size="0.01"/>'
    hand = imported(tmp_path, mjcf(one=massless, two=crooked))
    assert hand.links[1].inertia.mass == pytest.approx(4.19e-3, rel=0.01)
    assert hand.links[2].inertia.inertia == pytest.approx(np.eye(3) * 4e-6, rel=0.02)


def test_an_arm_whose_meshes_are_missing_is_left_out_with_them(tmp_path):
    """Only the hand's own meshes are needed; a scale that would make a stand-in vanish does no harm."""
    no_dae, no_kind = (SMALL.format(name) for name in ("package://arm/base.dae", "fore.wrl"))
    arm = f'<link name="base">{INERTIAL + no_dae}</link><link name="fore">{INERTIAL + no_kind}</link>' + (
        f'<joint name="turn" type="revolute"><parent link="base"/><child link="fore"/>{LIMIT}</joint>'
        f'<joint name="wrist" type="fixed"><parent link="fore"/><child link="palm"/>{LIMIT}</joint>'
    )
    hand = imported(tmp_path, urdf(extra=arm), {"palm": "palm"})
    assert [link.name for link in hand.links] == ["palm", "one", "two"]
    assert any("does without" in note and "package://arm/base.dae, fore.wrl" in note for note in hand.notes)

    with pytest.raises(InputError, match=r"mesh a/two.stl: No such file: .*; missing too: three.wrl$"):
        two = SMALL.format("a/two.stl") + SMALL.format("three.wrl")
        imported(tmp_path, urdf(two=two, extra=arm), {"palm": "palm"})


def test_a_missing_mesh_that_is_only_drawn_weighs_nothing(tmp_path):
    drawn = '<geom type="mesh" mesh="skin" contype="0" conaffinity="0"/>'
    one = '<geom size="0.01" pos="0 0 0.01"/>' + drawn
    rest = (
        '<default><mesh scale=".001 .001 .001"/></default><asset><mesh name="skin" file="skin.stl"/></asset>'
    )
    hand = imported(tmp_path, mjcf(one=one, rest=rest))
    whole = imported(tmp_path, mjcf(one=one.replace(drawn, "")))
    assert [link.inertia.mass for link in hand.links] == [link.inertia.mass for link in whole.links]
    assert [len(link.shapes) for link in hand.links] == [len(link.shapes) for link in whole.links]
    assert any("does without" in note and "skin.stl" in note for note in hand.notes)
    only_drawn = mjcf(palm=drawn, one=drawn, two=drawn, rest=rest)
    with pytest.raises(InputError, match=r"mesh skin.stl: No such file"):
        imported(tmp_path, only_drawn)


def test_prefixes_that_no_name_space_declares_are_passed_over(tmp_path):
    """As MuJoCo does: published models hold remarks for other programs."""
    extra = '<drake:collision_filter_group name="g"><drake:member link="one"/></drake:collision_filter_group>'
    assert [link.name for link in imported(tmp_path, urdf(extra=extra)).links] == ["palm", "one", "two"]


@pytest.mark.parametrize("kind", ["fixed", "floating", "planar", "revolute", "continuous", "prismatic"])
def test_joints_above_the_palm_are_left_out(tmp_path, kind):
    text = urdf(extra=above(kind))
    hand = imported(tmp_path, text, {"palm": "palm"})
    assert hand.joint_names == ("bend", "follow")
    check_motion(hand, mujoco_model_of(tmp_path, urdf()), "palm")


def test_a_floating_joint_that_carries_all_that_moves_rests(tmp_path):
    hand = imported(tmp_path, urdf(extra=above("floating")))
    assert [link.name for link in hand.links] == ["mount", "one", "two"]


def test_a_link_that_nothing_holds_is_left_out(tmp_path):
    hand = imported(tmp_path, urdf(extra=f'<link name="lost">{INERTIAL + BALL}</link>' + SECOND))
    assert [link.name for link in hand.links] == ["palm", "one", "two", "other"]
    assert any("left out: lost" in note for note in hand.notes)


def mujoco_model_of(folder: Path, text: str) -> mujoco.MjModel:
    path = folder / "plain.urdf"
    path.write_text(text, "utf-8")
    return mujoco_model(path)[0]


@pytest.mark.parametrize(
    "joint", ["<freejoint/>", '<joint type="ball"/>', '<joint type="slide" axis="1 0 0"/>']
)
def test_joints_of_the_palm_in_mjcf_are_left_out(tmp_path, joint):
    text = mjcf(above=joint)
    hand = imported(tmp_path, text)
    assert hand.joint_names == ("bend", "follow")
    check_motion(hand, mujoco.MjModel.from_xml_string(text), "palm")


@pytest.mark.parametrize("limit", ["", '<limit lower="0" upper="0" effort="1" velocity="1"/>'])
@pytest.mark.parametrize(("ratio", "offset"), [(1.05851325, 0.1), (-0.87, -0.05)])
def test_a_mimic_joint_takes_the_limits_that_its_master_sets(tmp_path, limit, ratio, offset):
    mimic = f'<mimic joint="bend" multiplier="{ratio}" offset="{offset}"/>'
    hand = imported(tmp_path, urdf(follow=limit + mimic))
    axis = hand.axes[1]
    assert (axis.coupling.master, axis.coupling.ratio, axis.coupling.offset) == ("bend", ratio, offset)
    assert (axis.lower, axis.upper) == pytest.approx(sorted([-0.3 * ratio + offset, 1.2 * ratio + offset]))
    assert hand.limits == pytest.approx(np.array([[-0.3, 1.2]]))


def test_a_coupling_of_the_hand_file_stands_before_the_models(tmp_path):
    curved = '<equality><joint joint1="follow" joint2="bend" polycoef="0 1 0.5 0 0"/></equality>'
    straight = curved.replace("0 1 0.5", "0 0.5 0")
    own = {"coupled": {"follow": {"to": "bend", "ratio": 0.9}}}
    for model in (curved, straight):
        assert imported(tmp_path, mjcf(rest=model), own).axes[1].coupling.ratio == 0.9
    turned = imported(tmp_path, mjcf(rest=straight), {"coupled": {"bend": {"to": "follow", "ratio": 0.9}}})
    assert turned.independent_names == ("follow",)
    outside = urdf(follow=LIMIT + '<mimic joint="above"/>', extra=above("revolute"))
    assert imported(tmp_path, outside, {"palm": "palm", **own}).axes[1].coupling.master == "bend"


@pytest.mark.parametrize(
    ("actuator", "effort", "stiffness", "damping"),
    [
        ('<position joint="bend" kp="5" kv="0.2" forcerange="-3 3"/>', 1.5, 5.0, 0.2),
        ('<position joint="bend" kp="5" kv="0.2" forcerange="-1 1"/>', 1.0, 5.0, 0.2),
        ('<position joint="bend" kp="5" kv="0.2" gear="2" forcerange="-0.5 0.6"/>', 1.0, 20.0, 0.8),
        ('<position joint="bend" kp="5" kv="0.2" gear="-2" forcerange="-3 3"/>', 1.5, 20.0, 0.8),
        ('<position joint="bend" kp="5" kv="0.2"/>', 1.5, 5.0, 0.2),
        ('<position tendon="pull" kp="5" kv="0.2" gear="4" forcerange="-0.5 0.5"/>', 1.0, 20.0, 0.8),
        ('<motor joint="bend" gear="2"/>', SERVO["effort"], SERVO["stiffness"], SERVO["damping"]),
    ],
)
def test_gears_and_both_limits_of_force_are_respected(tmp_path, actuator, effort, stiffness, damping):
    text = mjcf(
        rest='<tendon><fixed name="pull"><joint joint="bend" coef="0.5"/></fixed></tendon>'
        f"<actuator>{actuator}</actuator>"
    ).replace('range="-0.3 1.2"', 'range="-0.3 1.2" actuatorfrcrange="-1.5 2"')
    servo = imported(tmp_path, text).axes[0].actuator
    assert (servo.effort, servo.stiffness, servo.damping) == pytest.approx((effort, stiffness, damping))


TENDON = (
    '<tendon><fixed name="tie" {}><joint joint="bend" coef="1.5"/>'
    '<joint joint="follow" coef="-2"/></fixed></tendon>'
)


def test_a_tendon_that_ties_two_joints_becomes_a_coupling(tmp_path):
    text = mjcf(
        rest=TENDON.format("") + '<equality><tendon tendon1="tie" polycoef="0.1 0 0 0 0"/></equality>'
    )
    hand = imported(tmp_path, text)
    coupling = hand.axes[1].coupling
    assert (coupling.master, coupling.ratio, coupling.offset) == pytest.approx(("bend", 0.75, -0.05))
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    data.qpos[:] = hand.expand(np.array([0.7]))
    mujoco.mj_forward(model, data)
    assert np.abs(data.efc_pos[data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY]).max() < 1e-14


DRIVEN = '<actuator><position joint="bend" kp="1"/></actuator>'


def test_a_joint_that_a_driven_one_pulls_along_by_a_tendon_follows_it(tmp_path):
    text = mjcf(rest=TENDON.format('limited="true" range="-0.1 0.3"') + DRIVEN)
    hand = imported(tmp_path, text)
    coupling = hand.axes[1].coupling
    # By hand: 1.5 bend - 2 follow stays within 0.2 of 0.1.
    assert (coupling.master, coupling.ratio, coupling.offset) == pytest.approx(("bend", 0.75, -0.05))
    assert any("tendon tie: lets follow follow bend by the ratio 0.75; its 0.1 rad" in n for n in hand.notes)
    # MuJoCo's own tendon is in the middle of its range where the coupling holds.
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    data.qpos[:] = hand.expand(np.array([0.7]))
    mujoco.mj_forward(model, data)
    assert data.ten_length == pytest.approx([0.1], abs=1e-12)


@pytest.mark.parametrize(
    ("tendon", "rest", "words"),
    [
        ('limited="true" range="-0.01 0.01"', "", "ties loosely bend, follow"),
        ('limited="true" range="-0.8 0.8"', DRIVEN, "ties loosely bend, follow"),
        (
            'limited="true" range="-0.01 0.01"',
            DRIVEN.replace("</actuator>", '<position joint="follow" kp="1"/></actuator>'),
            "ties loosely bend, follow",
        ),
        ('stiffness="10"', "", "ties loosely bend, follow"),
        ("", '<actuator><position tendon="tie" kp="1"/></actuator>', "drives together bend, follow"),
    ],
)
def test_other_tendons_between_joints_are_told(tmp_path, tendon, rest, words):
    hand = imported(tmp_path, mjcf(rest=TENDON.format(tendon) + rest))
    assert len(hand.independent) == 2
    assert any(words in note for note in hand.notes)
    # Who says how one follows the other need not be told.
    hand = imported(
        tmp_path, mjcf(rest=TENDON.format(tendon) + rest), {"coupled": {"follow": {"to": "bend"}}}
    )
    assert not any("tendon" in note for note in hand.notes)


def test_tendons_through_space_that_an_equality_ties_are_told(tmp_path):
    """As of a gripper whose cables pull both fingers."""
    site = '<geom size="0.01" pos="0 0 0.01" mass="0.03"/><site name="{}" pos="0 0.01 0.01"/>'
    sites = {body: site.format(name) for body, name in (("palm", "a"), ("one", "b"), ("two", "c"))}
    tendons = "".join(
        f'<spatial name="{name}"><site site="{one}"/><site site="{other}"/></spatial>'
        for name, one, other in (("first", "a", "b"), ("second", "a", "c"))
    )
    rest = f"<tendon>{tendons}</tendon><equality><tendon tendon1='first' tendon2='second'/></equality>"
    hand = imported(tmp_path, mjcf(**sites, rest=rest))
    assert hand.joint_names == ("bend", "follow")
    assert any(note.startswith("equality 0: ties tendons that run through space") for note in hand.notes)
    coupled = imported(tmp_path, mjcf(**sites, rest=rest), {"coupled": {"follow": {"to": "bend"}}})
    assert len(coupled.independent) == 1


@pytest.mark.parametrize(
    ("bits", "rest", "pairs"),
    [
        ("", "", set()),
        ("", '<contact><exclude body1="two" body2="palm"/></contact>', {(0, 2)}),
        ('contype="1" conaffinity="0"', "", {(0, 1), (0, 2), (1, 2)}),
        ('contype="1" conaffinity="2"', "", {(0, 1), (0, 2), (1, 2)}),
        ('contype="2" conaffinity="3"', "", set()),
        ('contype="1" conaffinity="0"', '<contact><pair geom1="a" geom2="c"/></contact>', {(0, 1), (1, 2)}),
    ],
)
def test_pairs_that_the_model_keeps_from_touching(tmp_path, bits, rest, pairs):
    geoms = {
        body: f'<geom name="{name}" size="0.01" {bits}/>'
        for body, name in (("palm", "a"), ("one", "b"), ("two", "c"))
    }
    hand = imported(tmp_path, mjcf(**geoms, rest=rest))
    assert set(hand.never_touching) == pairs
    assert all(len(link.shapes) == 1 for link in hand.links)


SMALL = '<collision><geometry><mesh filename="{}"/></geometry></collision>'


@pytest.mark.parametrize(
    ("text", "hand", "words"),
    [
        (
            urdf(follow=LIMIT + '<mimic joint="bent"/>'),
            {},
            "joint follow.mimic: unknown joint.* 'bent'.*bend",
        ),
        (urdf(follow=LIMIT + "<mimic/>"), {}, "joint follow.mimic: unknown joint"),
        (
            urdf(follow=LIMIT + '<mimic joint="above"/>', extra=above("fixed")),
            {"palm": "palm"},
            "joint follow.mimic: unknown joint that moves 'above'",
        ),
        (
            urdf(follow=LIMIT + '<mimic joint="above"/>', extra=above("revolute")),
            {"palm": "palm"},
            "coupled to 'above', which the palm does not carry; say in coupled",
        ),
        (urdf(follow=LIMIT + '<mimic joint="follow"/>'), {}, "joint follow.mimic: follows itself"),
        (
            urdf(extra=above("floating")),
            {"palm": "mount"},
            "joint above: is floating; .* above the palm alone",
        ),
        (
            urdf().replace('"follow" type="revolute"', '"follow" type="floating"'),
            {},
            "joint follow: is floating; .* or take out link 'two', which nothing holds",
        ),
        (
            urdf(extra=above("fixed").replace('"above"', '"twice"').replace('"palm"', '"two"')),
            {},
            "link two: hangs on two joints, follow and twice",
        ),
        (
            urdf(extra=above("fixed").replace('"palm"', '"plam"')),
            {},
            "joint above.child: unknown link 'plam'",
        ),
        (urdf(extra='<link name="two"/>'), {}, "link two: is there 2 times"),
        (urdf(extra=above("bolted")), {}, "joint above.type: is one of revolute, .* not 'bolted'"),
        (urdf(follow=LIMIT + '<mimic joint="bend" multiplier="x"/>'), {}, "mimic.multiplier: is a number"),
        (
            urdf(follow=LIMIT + '<mimic joint="bend" multiplier="1e-5"/>'),
            {},
            "the ratio 1e-05; from 0.01 to 100",
        ),
        (urdf().replace("0 0 0.04", "inf 0 0"), {}, "origin.xyz: has finite numbers alone, not 'inf 0 0'"),
        (mjcf().replace("0 0 0.04", "inf 0 0"), {}, "body two.pos: has finite numbers alone, not 'inf 0 0'"),
        (mjcf().replace("-0.5 1.5", "nan 1.5"), {}, "joint follow.range: has finite numbers"),
        (mjcf().replace('mass="0.03"', 'mass="nan"'), {}, "geom.mass: has finite numbers"),
        (mjcf().replace("0 0 0.04", "0 0 40"), {}, "body two: reaches 40 m, .* no hand is larger than 10 m"),
        (mjcf().replace('mass="0.03"', 'mass="30000"'), {}, "weighs 3e[+]04 kg; at most 1000 kg"),
        (
            urdf(one=MASS_ALONE.replace("0.1", "heavy") + BALL),
            {},
            "one.inertial.value: is a number, not 'heavy'",
        ),
        (urdf(two=SMALL.format("no.stl")), {}, "mesh no.stl: No such file: looked for .* no.stl"),
        (
            urdf(two=SMALL.format("package://p/no.stl")),
            {},
            "mesh package://p/no.stl: No such file: .*p/no.stl",
        ),
        (urdf(two=SMALL.format("w.fbx")), {}, "'w.fbx' is none of the kinds that can be read: .obj, .stl"),
        (urdf(two=SMALL.format("../w.stl")), {}, "must be a path below the folder"),
        (urdf(two=SMALL.format("file:///etc/w.stl")), {}, "No such file|below the folder"),
        (urdf(two=SMALL.format("broken.ply")), {}, "broken.ply: can't be read as a mesh|holds no triangles"),
        (urdf(palm="", one="", two=""), {}, "carries no geom"),
        (urdf(), {"palm": "plam"}, "palm: unknown body 'plam'.*palm"),
        ("<mujoco/>", {}, "has no bodies: is it a part that another model includes"),
        ("<mujocoinclude/>", {}, "is a part that another model includes; name that one"),
        (
            mjcf(
                rest='<tendon><fixed name="a"><joint joint="bend" coef="1"/></fixed>'
                '<fixed name="b"><joint joint="follow" coef="1"/></fixed></tendon>'
                '<equality><tendon tendon1="b" tendon2="a" polycoef="0 1 1 0 0"/></equality>'
            ),
            {},
            "say in coupled how 'follow' follows",
        ),
        (
            mjcf(rest='<equality><weld body1="two" body2="palm"/></equality>'),
            {},
            "equality 0: closes a loop, and none of its joints is driven",
        ),
    ],
)
def test_what_no_hand_is_made_of_is_refused(tmp_path, text, hand, words):
    (tmp_path / "broken.ply").write_text("ply\nnothing\n", "utf-8")
    with pytest.raises(InputError, match=words) as caught:
        load_hand(written(tmp_path, text, hand))
    assert "\n" not in str(caught.value)
    assert str(tmp_path) in str(caught.value)


@pytest.mark.parametrize(
    ("one", "rest", "words"),
    [
        ('<geom size="1e-300"/>', "", r"geom \d: size: is 1e-300 m; at least 1e-07 is allowed"),
        (
            '<joint name="s" axis="0 1e200 0" range="0 1"/><geom size="0.01"/>',
            "",
            "joint s: axis: has no dir",
        ),
        ('<joint name="s" damping="1e300" range="0 1"/><geom size="0.01"/>', "", "dof_damping: is 1e"),
        ('<joint name="s" ref="1e300" range="0 1"/><geom size="0.01"/>', "", "qpos0: is 1e"),
        ('<joint name="s" armature="1e308" range="0 1"/><geom size="0.01"/>', "", "dof_armature: is 1e"),
        ('<geom size="0.01" quat="1e-200 0 0 0"/>', "", r"body one: iquat: has no direction"),
        (
            '<geom size="0.01"/>',
            '<actuator><position name="push" joint="bend" kp="1e300"/></actuator>',
            "actuator push: gainprm: is 1e",
        ),
    ],
)
def test_numbers_beyond_all_measure_are_refused(tmp_path, one, rest, words):
    # Each of them is finite, and MuJoCo compiles it.
    with pytest.raises(InputError, match=words):
        load_hand(written(tmp_path, mjcf(one=one, rest=rest)))


def test_a_model_that_is_a_circle_of_links_is_refused(tmp_path):
    model = tmp_path / "claw.xml"
    model.symlink_to(model.name)
    for read in (lambda: load_hand(model), lambda: new_hand_file(tmp_path / "new.yaml", str(model))):
        with pytest.raises(InputError, match="is not the path of a file"):
            read()


def test_servos_without_armature_get_the_usual_one(tmp_path):
    """Thin links alone would ring at a contact; what the model does give stays."""
    text = mjcf(rest="<actuator><position joint='bend' kp='20' kv='1' forcerange='-2 2'/></actuator>")
    servos = []
    for name, model in (
        ("bare", text),
        ("given", text.replace('name="bend"', 'name="bend" armature="0.002"')),
    ):
        path = tmp_path / f"{name}.xml"
        path.write_text(model, "utf-8")
        hand = load_hand(path)
        servo = next(axis.actuator for axis in hand.axes if axis.name == "bend")
        assert (servo.effort, servo.stiffness, servo.damping) == (2.0, 20.0, 1.0)
        servos.append((servo.armature, any("armature" in note and "bend" in note for note in hand.notes)))
    assert servos[0][0] > 0.0 and servos[0][1]
    assert servos[1] == (0.002, False)


def test_commas_between_numbers_and_shapes_without_extent_are_mended(tmp_path):
    plain = urdf()
    nothing = '<collision><geometry><sphere radius="0.0"/></geometry></collision>'
    odd = urdf(one=INERTIAL + BALL + nothing).replace('rpy="0.3 0.2 0.1"', 'rpy="0.3, 0.2 0.1"') + "\0"
    assert odd.count(",") == plain.count(",") + 1
    mended, whole = (
        imported(tmp_path / name, text, name="m.urdf") for name, text in (("odd", odd), ("plain", plain))
    )
    for a, b in zip(mended.links, whole.links, strict=True):
        assert a.T_parent_link0 == pytest.approx(b.T_parent_link0) and len(a.shapes) == len(b.shapes)
    assert [note for note in mended.notes if note not in whole.notes] == [
        "commas between numbers, read as spaces: 1",
        "shapes without extent, left out: one",
    ]


@pytest.mark.parametrize("left", ["$(optenv REACH 0.04) 0 0", "${reach} 0 0"])
def test_what_xacro_left_undone_is_refused_as_such(tmp_path, left):
    text = urdf().replace('xyz="0 0 0.04"', f'xyz="{left}"')
    with pytest.raises(InputError, match="is a template in xacro"):
        load_hand(written(tmp_path, text, name="m.urdf"))
