"""Imported hands against MuJoCo's own kinematics, and what can't be imported."""

from pathlib import Path

import mujoco
import numpy as np
import pytest
import trimesh
import yaml
from holdfast.errors import InputError
from holdfast.geometry import Box, Capsule, Hull, Sphere, shape_mesh
from holdfast.geometry.transforms import invert
from holdfast.hands import forward_kinematics, load_hand

SERVO = {"effort": 1.0, "stiffness": 8.0, "damping": 0.1, "armature": 0.001}
MJCF = """
<mujoco model="odd">
  <compiler angle="radian" autolimits="true" meshdir="parts"/>
  <default><default class="drawn"><geom contype="0" conaffinity="0" group="2"/></default></default>
  <asset><mesh name="wedge" file="wedge.obj"/><mesh file="wedge.obj" name="again" scale="2 2 2"/></asset>
  <worldbody>
    <light pos="0 0 1"/>
    <geom name="floor" type="plane" size="1 1 0.1"/>
    <body name="forearm" pos="0.1 0.2 0.3" quat="0.9 0.1 0.3 -0.2">
      <joint name="wrist" axis="1 0 0" range="-1 1"/>
      <geom type="box" size="0.1 0.02 0.02" mass="1"/>
      <body name="palm" pos="0.2 0 0" quat="0.7 0.1 -0.2 0.6">
        <joint name="wrist2" axis="0 1 0" range="-1 1"/>
        <geom type="box" size="0.03 0.04 0.05" pos="0 0 0.01" euler="0.1 0.2 0.3" mass="0.4"/>
        <geom class="drawn" type="mesh" mesh="again" mass="0"/>
        <include file="fingers.xml"/>
      </body>
    </body>
  </worldbody>
  <equality>
    <joint joint1="tip" joint2="flexion" polycoef="0.2 0.5 0 0 0"/>
    <joint joint1="telescope" joint2="slide" polycoef="0.001 -0.5 0 0 0"/>
  </equality>
  <actuator>
    <position name="drive" joint="flexion" kp="5" forcerange="-0.7 0.6"/>
  </actuator>
</mujoco>
"""
FINGERS = """
<mujocoinclude>
  <body name="carriage" pos="0.02 0.01 0.06" quat="0.9 0 0.4 0.1">
    <joint name="slide" type="slide" axis="1 2 2" range="-0.02 0.03"/>
    <geom type="sphere" size="0.01" mass="0.02"/>
    <body name="knuckle" pos="0 0.01 0.03">
      <joint name="abduction" axis="1 0 0" range="-0.3 0.5" ref="0.1" pos="0 0.002 0"/>
      <joint name="flexion" axis="0 1 0.2" range="-0.2 1.4" ref="-0.3" pos="0 0.002 0" damping="0.06"
        armature="0.002"/>
      <geom type="capsule" size="0.008" fromto="0 0 0 0.004 0 0.04" mass="0.03"/>
      <body name="rod" pos="0 0 0.045" quat="0.8 0.1 0.1 0.4">
        <geom type="cylinder" size="0.006 0.01" pos="0.001 0 0.012" mass="0.01"/>
        <body name="nail" pos="0 0 0.03"><geom type="ellipsoid" size="0.005 0.006 0.007" mass="0.004"/></body>
        <body name="end" pos="0 0.001 0.025">
          <joint name="tip" axis="0 1 0" range="-2 2"/>
          <geom type="mesh" mesh="wedge" pos="0.001 0 0" euler="0.3 0 0.1" mass="0.01"/>
          <body name="last" pos="0.02 0 0">
            <joint name="telescope" type="slide" axis="0 0 1" range="-0.1 0.1"/>
            <geom type="sphere" size="0.006" mass="0.005"/>
          </body>
        </body>
      </body>
    </body>
  </body>
</mujocoinclude>
"""
URDF = """
<robot name="small">
  <link name="base">
    <inertial><mass value="0.3"/>
      <inertia ixx="1e-3" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><mesh filename="package://small/parts/no_such_file.dae"/></geometry></visual>
    <collision><geometry><box size="0.06 0.08 0.02"/></geometry></collision>
  </link>
  <link name="one">
    <inertial><origin xyz="0 0 0.02"/><mass value="0.05"/>
      <inertia ixx="1e-5" iyy="1e-5" izz="1e-6" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 0 0.02" rpy="0 0.1 0"/>
      <geometry><cylinder radius="0.008" length="0.03"/></geometry></collision>
  </link>
  <link name="two">
    <inertial><mass value="0.02"/>
      <inertia ixx="1e-5" iyy="1e-5" izz="1e-5" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 0 0.02"/>
      <geometry><mesh filename="package://small/parts/wedge.obj"/></geometry></collision>
  </link>
  <link name="mark"/>
  <joint name="bend" type="revolute"><parent link="base"/><child link="one"/>
    <origin xyz="0 0.01 0.02" rpy="0.3 0.2 0.1"/><axis xyz="0 1 0"/>
    <limit lower="-0.2" upper="1.5" effort="2" velocity="1"/></joint>
  <joint name="follow" type="revolute"><parent link="one"/><child link="two"/>
    <origin xyz="0 0 0.04"/><axis xyz="0 1 0"/><limit lower="-1" upper="2" effort="2" velocity="1"/>
    <mimic joint="bend" multiplier="0.75" offset="0.1"/></joint>
  <joint name="end" type="fixed"><parent link="two"/><child link="mark"/>
    <origin xyz="0.01 0 0.02" rpy="0 1 0"/></joint>
</robot>
"""
CAP = {"centre": [0.001, 0.002, 0.003], "radius": 0.004, "axis": [0, 0.6, 0.8], "half_angle_deg": 40}
MJCF_HAND = {
    "name": "odd",
    "import": "model/odd.xml",
    "palm": "palm",
    "palm_frame": {"position": [0.01, 0.02, 0.03], "x_axis": [0, 0, 1], "y_axis": [0.6, 0.8, 0]},
    "actuator": SERVO,
    "link_names": {"end": "tip_link"},
    "joint_names": {"flexion": "bend"},
    "regions": {
        "finger/tip": {"link": "last", "cap": CAP},
        "finger/nail": {"link": "nail", "point": [0.001, 0, 0], "normal": [0, 0, 1]},
        "palm/side": {
            "link": "palm",
            "bezier": [[[0, 0, 0], [0, 0.01, 0]], [[0.01, 0, 0], [0.01, 0.01, 0.001]]],
        },
    },
}
URDF_HAND = {
    "name": "small",
    "import": "small.urdf",
    "actuator": SERVO,
    "regions": {"finger/mark": {"link": "mark", "cap": CAP}},
}


def write_wedge(path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    corners = [[0, 0, 0], [0.02, 0, 0], [0, 0.012, 0], [0, 0, 0.01], [0.015, 0.004, 0.006]]
    trimesh.convex.convex_hull(np.array(corners)).export(path)


def write(folder: Path, hand: dict, **files: str) -> Path:
    """The hand file with its models and meshes beside it."""
    for folder_of_meshes in (folder / "model" / "parts", folder / "parts"):
        write_wedge(folder_of_meshes / "wedge.obj")
    for name, text in {
        "model/odd.xml": MJCF,
        "model/fingers.xml": FINGERS,
        "small.urdf": URDF,
        **files,
    }.items():
        (folder / name).write_text(text, "utf-8")
    path = folder / "hand.yaml"
    path.write_text(yaml.safe_dump(hand), "utf-8")
    return path


def mujoco_model(path: Path) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """The model as MuJoCo itself reads it, nothing merged."""
    spec = mujoco.MjSpec.from_file(str(path))
    spec.compiler.fusestatic = False
    spec.compiler.balanceinertia = True
    model = spec.compile()
    return model, mujoco.MjData(model)


def body_pose(data: mujoco.MjData, name: str) -> np.ndarray:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = data.body(name).xmat.reshape(3, 3), data.body(name).xpos
    return T


def check_kinematics(
    hand, model, data, *, palm, T_body_palm, bodies, joints, anchors, seeds=1000, within=1e-12
):
    """Poses of all links, at random joint vectors (coupled joints free), agree."""
    rng = np.random.default_rng(0)
    for _ in range(seeds):
        q = rng.uniform(-1.0, 1.0, len(hand.axes))
        for name, position in zip(hand.joint_names, q, strict=True):
            data.joint(joints.get(name, name)).qpos[0] = position
        mujoco.mj_kinematics(model, data)
        T_palm = body_pose(data, palm) @ T_body_palm
        Ts = forward_kinematics(hand, q)
        for T, link in list(zip(Ts, hand.links, strict=True))[1:]:
            expected = invert(T_palm) @ body_pose(data, bodies.get(link.name, link.name))
            expected[:3, 3] += expected[:3, :3] @ anchors.get(link.name, np.zeros(3))
            assert np.abs(T - expected).max() < within


@pytest.fixture(scope="module")
def odd(tmp_path_factory):
    folder = tmp_path_factory.mktemp("odd")
    path = write(folder, MJCF_HAND)
    return load_hand(path), *mujoco_model(folder / "model" / "odd.xml")


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    folder = tmp_path_factory.mktemp("small")
    path = write(folder, URDF_HAND)
    plain = folder / "plain.urdf"
    plain.write_text(URDF.replace("package://small/", ""), "utf-8")
    return load_hand(path), *mujoco_model(plain)


T_BODY_PALM = np.array([[0, 0.6, -0.8, 0.01], [0, 0.8, 0.6, 0.02], [1, 0, 0, 0.03], [0, 0, 0, 1]])


def test_an_mjcf_hand_moves_as_in_mujoco(odd):
    hand, model, data = odd
    assert hand.joint_names == ("slide", "abduction", "bend", "tip", "telescope")
    assert [link.name for link in hand.links] == ["palm", "carriage", "knuckle", "tip_link", "last"]
    check_kinematics(
        hand, model, data, palm="palm", T_body_palm=T_BODY_PALM, bodies={"tip_link": "end"},
        joints={"bend": "flexion"}, anchors={"knuckle": np.array([0, 0.002, 0])},
    )  # fmt: skip


def test_a_urdf_hand_moves_as_in_mujoco(small):
    hand, model, data = small
    assert hand.joint_names == ("bend", "follow")
    check_kinematics(hand, model, data, palm="base", T_body_palm=np.eye(4), bodies={}, joints={}, anchors={})


@pytest.mark.parametrize("name", ["allegro", "leap"])
def test_public_hands_move_as_in_mujoco(public_hands, name):
    path = public_hands[name]
    hand, spec = load_hand(path), yaml.safe_load(path.read_text("utf-8"))
    assert len(hand.independent) == len(hand.axes) == 16
    model, data = mujoco_model(path.parent / spec["import"])
    frame = spec.get("palm_frame", {"x_axis": [1, 0, 0], "y_axis": [0, 1, 0]})
    T = np.eye(4)
    T[:3, :3] = np.column_stack(
        [frame["x_axis"], frame["y_axis"], np.cross(frame["x_axis"], frame["y_axis"])]
    )
    check_kinematics(
        hand, model, data, palm=spec["palm"], T_body_palm=T,
        bodies={new: old for old, new in spec["link_names"].items()},
        joints={new: old for old, new in spec["joint_names"].items()}, anchors={},
        # Axes that a model writes as 1.5708 rad apart are made parallel, as it says.
        within=1e-12 if not any("parallel" in note for note in hand.notes) else 1e-6,
    )  # fmt: skip


def test_couplings_limits_and_servos_come_from_the_model(odd, small):
    hand, *_ = odd
    axes = dict(zip(hand.joint_names, hand.axes, strict=True))
    # q_tip - 0 = 0.2 + 0.5 (q_bend + 0.3), for MuJoCo's polynomial counts from the reference position.
    q = hand.expand(np.zeros(len(hand.independent)))
    assert hand.independent_names == ("slide", "abduction", "bend")
    assert q[hand.joint_names.index("tip")] == pytest.approx(0.35)
    assert q[hand.joint_names.index("telescope")] == pytest.approx(0.001)
    assert (axes["bend"].lower, axes["bend"].upper) == (-0.2, 1.4)
    assert axes["slide"].kind == axes["telescope"].kind == "prismatic"
    servo = axes["bend"].actuator
    assert (servo.effort, servo.stiffness, servo.damping, servo.armature) == (0.6, 5.0, 0.06, 0.002)
    assert axes["slide"].actuator.effort == SERVO["effort"]
    hand, *_ = small
    assert hand.expand(np.array([0.4])) == pytest.approx([0.4, 0.4])


@pytest.mark.parametrize("which", ["odd", "small"])
def test_coupled_positions_satisfy_mujocos_own_equalities(which, request):
    hand, model, data = request.getfixturevalue(which)
    names = {"bend": "flexion"} if which == "odd" else {}
    rng = np.random.default_rng(1)
    for _ in range(20):
        q = hand.expand(rng.uniform(*hand.limits.T))
        for name, position in zip(hand.joint_names, q, strict=True):
            data.joint(names.get(name, name)).qpos[0] = position
        mujoco.mj_forward(model, data)
        violation = data.efc_pos[data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY]
        assert len(violation) == model.neq
        assert np.abs(violation).max() < 1e-14


def test_masses_are_those_of_the_model(odd):
    hand, model, data = odd
    mujoco.mj_resetData(model, data)
    for name, position in zip(hand.joint_names, hand.expand(np.zeros(3)), strict=True):
        data.joint({"bend": "flexion"}.get(name, name)).qpos[0] = position
    mujoco.mj_forward(model, data)
    T_palm = body_pose(data, "palm") @ T_BODY_PALM
    Ts = forward_kinematics(hand, hand.expand(np.zeros(3)))
    masses = [link.inertia.mass for link in hand.links]
    centre = sum(
        link.inertia.mass * (T @ np.append(link.inertia.centre, 1.0))[:3]
        for T, link in zip(Ts, hand.links, strict=True)
    ) / sum(masses)
    carried = model.body("palm").id
    assert sum(masses) == pytest.approx(model.body_subtreemass[carried])
    expected = (invert(T_palm) @ np.append(data.subtree_com[carried], 1.0))[:3]
    assert centre == pytest.approx(expected, abs=1e-9)


def test_shapes_are_the_geoms_that_collide(odd):
    hand, model, data = odd
    kinds = [[type(shape) for shape in link.shapes] for link in hand.links]
    # The rod and the nail have no joint: they are part of the knuckle.
    assert kinds == [[Box], [Sphere], [Capsule, Hull, Hull], [Hull], [Sphere]]
    q = hand.expand(np.array([0.01, 0.2, 0.5]))
    for name, position in zip(hand.joint_names, q, strict=True):
        data.joint({"bend": "flexion"}.get(name, name)).qpos[0] = position
    mujoco.mj_forward(model, data)
    T_palm = body_pose(data, "palm") @ T_BODY_PALM
    centres = [
        (T @ np.append(shape_mesh(shape).center_mass, 1.0))[:3]
        for T, link in zip(forward_kinematics(hand, q), hand.links, strict=True)
        for shape in link.shapes
    ]
    inside = [
        g
        for g in range(model.ngeom)
        if model.geom_contype[g] and model.geom_bodyid[g] >= model.body("palm").id
    ]
    expected = [(invert(T_palm) @ np.append(data.geom_xpos[g], 1.0))[:3] for g in inside]
    assert np.array(centres) == pytest.approx(np.array(expected), abs=1e-5)


def test_regions_are_given_in_the_frames_of_the_bodies(odd, small):
    for (hand, model, data), region, body, point in (
        (odd, "finger/nail", "nail", [0.001, 0, 0]),
        (odd, "finger/tip", "last", CAP["centre"]),
        (small, "finger/mark", "mark", CAP["centre"]),
    ):
        q = hand.expand(hand.limits.mean(axis=1))
        for name, position in zip(hand.joint_names, q, strict=True):
            data.joint({"bend": "flexion"}.get(name, name) if region != "finger/mark" else name).qpos[0] = (
                position
            )
        mujoco.mj_forward(model, data)
        T_palm = body_pose(data, "palm") @ T_BODY_PALM if hand.name == "odd" else body_pose(data, "base")
        placed = hand.regions[region]
        local = placed.region.centre if hasattr(placed.region, "centre") else placed.region.point
        at = (forward_kinematics(hand, q)[placed.link] @ np.append(local, 1.0))[:3]
        expected = (invert(T_palm) @ body_pose(data, body) @ np.append(point, 1.0))[:3]
        assert at == pytest.approx(expected, abs=1e-12)


FREE = '<body name="loose"><freejoint/><geom size="0.01"/></body>'
BALL = '<body name="loose"><joint type="ball"/><geom size="0.01"/></body>'
ASKEW = (
    '<body name="loose"><joint axis="1 0 0" range="0 1"/><joint axis="0 1 0" pos="0 0 0.01" range="0 1"/>'
    '<geom size="0.01"/></body>'
)
XACRO = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="odd">
  <xacro:include filename="fingers.xacro"/>
</robot>"""
END = "</mujocoinclude>"


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"model/fingers.xml": FINGERS.replace(END, FREE + END)}, "can't compile the model: .*free joint"),
        ({"model/fingers.xml": FINGERS.replace(END, BALL + END)}, "is a ball joint; only hinges and slides"),
        (
            {
                "model/fingers.xml": FINGERS.replace(END, BALL + END),
                "model/odd.xml": MJCF.replace(
                    "<equality>", '<equality><connect body1="loose" body2="end" anchor="0 0 0"/>'
                ),
            },
            "is a ball joint; .* without them and the loops they close",
        ),
        ({"model/fingers.xml": FINGERS.replace(END, ASKEW + END)}, "axes don't cross: put a body between"),
        (
            {
                "model/odd.xml": MJCF.replace(
                    "<equality>", '<equality><connect body1="end" body2="palm" anchor="0 0 0"/>'
                )
            },
            "closes a loop",
        ),
        (
            {"model/odd.xml": MJCF.replace("0.2 0.5 0 0 0", "0.2 0.5 9 0 0")},
            "something else than offset [+] ratio",
        ),
        ({"model/fingers.xml": FINGERS.replace(' range="-0.02 0.03"', "")}, "limits.slide: is required"),
        ({"model/odd.xml": MJCF.replace("wedge.obj", "../../../wedge.obj")}, "below the folder of this file"),
        ({"model/odd.xml": MJCF.replace('file="wedge.obj"', 'file="/etc/hostname.obj"')}, "below the folder"),
        ({"model/odd.xml": MJCF.replace("fingers.xml", "../../secret.xml")}, "below the folder of this file"),
        ({"model/odd.xml": MJCF.replace('meshdir="parts"', 'meshdir="/etc"')}, "below the folder"),
        ({"model/odd.xml": MJCF.replace("wedge.obj", "none.obj")}, "none.obj: No such file"),
        ({"model/odd.xml": MJCF.replace("wedge.obj", "wedge.fbx")}, "none of the kinds that can be read"),
        (
            {"model/fingers.xml": FINGERS.replace(END, '<include file="fingers.xml"/>' + END)},
            "more than 100 files are included",
        ),
        ({"model/odd.xml": "<!DOCTYPE a [<!ENTITY b 'c'>]>" + MJCF}, "document type or entities"),
        ({"model/odd.xml": MJCF[:-20]}, "not valid XML"),
        ({"model/odd.xml": "<mujoco>" + "<a>" * 300 + "</a>" * 300 + "</mujoco>"}, "nested deeper"),
        ({"model/odd.xml": "<html/>"}, "neither MJCF nor URDF"),
        ({"model/odd.xml": XACRO}, "template in xacro; `xacro FILE > hand.urdf` makes"),
        (
            {"model/fingers.xml": FINGERS.replace('type="sphere"', 'type="blob"')},
            "can't compile the model: .*blob",
        ),
        (
            {"model/odd.xml": MJCF.replace("<light", "<flexcomp name='f' file='x.msh'/><light")},
            "can't be imported",
        ),
        (
            {"model/fingers.xml": FINGERS.replace('name="last"', 'name="tip:link"')},
            "'tip_link' .*stands twice",
        ),
    ],
)
def test_models_that_are_not_a_hand_are_refused(tmp_path, change, words):
    path = write(tmp_path, MJCF_HAND, **change)
    with pytest.raises(InputError, match=words) as caught:
        load_hand(path)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("link", ["model/odd.xml", "model/parts/wedge.obj"])
def test_links_out_of_the_folder_are_not_followed(tmp_path, link):
    inside = tmp_path / "inside"
    inside.mkdir()
    path = write(inside, MJCF_HAND)
    (inside / link).rename(tmp_path / "outside")
    (inside / link).symlink_to(tmp_path / "outside")
    with pytest.raises(InputError, match="must be a path below the folder"):
        load_hand(path)
