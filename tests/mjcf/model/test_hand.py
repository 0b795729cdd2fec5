"""The model of a hand agrees with its data, and MuJoCo can run it."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
import yaml
from holdfast.errors import InputError
from holdfast.geometry import MassProperties, Sphere
from holdfast.hands import Hand, Link, builtin_hands, forward_kinematics, load_hand
from holdfast.mjcf import hand_mjcf
from holdfast.retraction import overlapping_links

from ..conftest import in_mujoco

SERVO = {"effort": 3.0, "stiffness": 20.0, "damping": 0.5, "armature": 0.002}


# Every kind of joint and shape, a chain of couplings with offsets, and branches.
ODDITY = {
    "name": "oddity",
    "palm": "base",
    "actuators": {"servo": SERVO},
    "links": [
        {
            "name": "base",
            "mass": 0.5,
            "shapes": [{"box": {"centre": [0, 0, 0], "half_extents": [0.1, 0.1, 0.02]}}],
        },
        {
            "name": "slide",
            "mass": 0.1,
            "shapes": [{"capsule": {"start": [0, 0, 0], "end": [0, 0, 0.1], "radius": 0.01}}],
        },
        {"name": "knuckle", "mass": 0.1, "shapes": [{"sphere": {"centre": [0.02, 0, 0], "radius": 0.01}}]},
        {
            "name": "tip",
            "mass": 0.05,
            "shapes": [{"hull": {"points": [[0, 0, 0], [0.02, 0, 0], [0, 0.02, 0], [0, 0, 0.02]]}}],
        },
        {
            "name": "stiff",
            "mass": 0.05,
            "shapes": [{"box": {"centre": [0, 0, 0.02], "half_extents": [0.01, 0.01, 0.01]}}],
        },
    ],
    "joints": [
        {
            "type": "prismatic",
            "parent": "base",
            "child": "slide",
            "position": [0.03, 0.02, 0.05],
            "x_axis": [0.6, 0.8, 0],
            "y_axis": [-0.8, 0.6, 0],
            "axes": [
                {"name": "lift", "direction": [0, 0.6, 0.8], "limits": [0.0, 0.05], "actuator": "servo"}
            ],
        },
        {
            "type": "universal",
            "parent": "slide",
            "child": "knuckle",
            "position": [0, 0, 0.1],
            "axes": [
                {
                    "name": "swing",
                    "direction": [1, 0, 0],
                    "limits_deg": [-40, 40],
                    "zero_offset_deg": 12,
                    "actuator": "servo",
                },
                {
                    "name": "bend",
                    "direction": [0, 1, 0],
                    "limits_deg": [-90, 90],
                    "coupled": {"to": "swing", "ratio": -0.7, "offset_deg": 5},
                },
            ],
        },
        {
            "type": "revolute",
            "parent": "knuckle",
            "child": "tip",
            "position": [0.04, 0, 0],
            "axes": [
                {
                    "name": "curl",
                    "direction": [0, 0.8, 0.6],
                    "limits_deg": [-90, 90],
                    "coupled": {"to": "bend", "ratio": 1.3},
                }
            ],
        },
        {
            "type": "fixed",
            "parent": "base",
            "child": "stiff",
            "position": [-0.05, 0, 0.1],
            "x_axis": [0, 1, 0],
            "y_axis": [0, 0, 1],
        },
    ],
}


@pytest.fixture(scope="module", params=[*builtin_hands(), "oddity"])
def hand(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Hand:
    if request.param != "oddity":
        return load_hand(request.param)
    path = tmp_path_factory.mktemp("hands") / "oddity.yaml"
    path.write_text(yaml.safe_dump(ODDITY))
    return load_hand(path)


def test_both_kinematics_agree(hand: Hand) -> None:
    model, data = in_mujoco(hand_mjcf(hand))
    rng = np.random.default_rng(0)
    for _ in range(50):
        q = hand.expand(rng.uniform(*hand.limits.T))
        for name, value in zip(hand.joint_names, q, strict=True):
            data.qpos[model.joint(name).qposadr[0]] = value
        mujoco.mj_kinematics(model, data)
        for link, T in zip(hand.links, forward_kinematics(hand, q), strict=True):
            body = data.body(link.name)
            assert np.abs(body.xpos - T[:3, 3]).max() < 1e-9
            assert np.abs(body.xmat.reshape(3, 3) - T[:3, :3]).max() < 1e-9


def test_joints_stand_in_the_order_of_joint_vectors(hand: Hand) -> None:
    model, _ = in_mujoco(hand_mjcf(hand))
    assert tuple(model.joint(i).name for i in range(model.njnt)) == hand.joint_names
    assert tuple(model.actuator(i).name for i in range(model.nu)) == hand.independent_names


def test_couplings_hold_exactly_where_the_hand_says(hand: Hand) -> None:
    model, data = in_mujoco(hand_mjcf(hand))
    rng = np.random.default_rng(1)
    for _ in range(10):
        data.qpos[:] = hand.expand(rng.uniform(*hand.limits.T))
        mujoco.mj_forward(model, data)
        couplings = data.efc_pos[data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY]
        assert len(couplings) == len(hand.axes) - len(hand.independent)
        assert np.abs(couplings).max(initial=0.0) < 1e-9


def test_servos_and_limits_are_those_of_the_hand(hand: Hand) -> None:
    model, _ = in_mujoco(hand_mjcf(hand))
    for axis in hand.axes:
        joint = model.joint(axis.name)
        assert joint.range == pytest.approx([axis.lower, axis.upper], abs=1e-12)
        assert joint.limited[0]
        if axis.actuator is None:
            continue
        servo = model.actuator(axis.name)
        assert servo.forcerange == pytest.approx([-axis.actuator.effort, axis.actuator.effort])
        assert servo.forcelimited[0]
        assert servo.gainprm[0] == axis.actuator.stiffness == -servo.biasprm[1]
        assert model.dof_damping[joint.dofadr[0]] == axis.actuator.damping
        assert model.dof_armature[joint.dofadr[0]] == axis.actuator.armature


def test_masses_are_those_of_the_hand(hand: Hand) -> None:
    model, data = in_mujoco(hand_mjcf(hand))
    mujoco.mj_kinematics(model, data)
    for link in hand.links:
        body = model.body(link.name)
        assert body.mass[0] == pytest.approx(link.inertia.mass)
        assert body.ipos == pytest.approx(link.inertia.centre, abs=1e-12)
        R = np.zeros(9)
        mujoco.mju_quat2Mat(R, body.iquat)
        R = R.reshape(3, 3)
        assert R @ np.diag(body.inertia) @ R.T == pytest.approx(link.inertia.inertia, rel=1e-6, abs=1e-12)


def test_a_second_of_random_targets_runs_smoothly(hand: Hand) -> None:
    model, data = in_mujoco(hand_mjcf(hand))
    rng = np.random.default_rng(2)
    for _ in range(20):
        data.ctrl[:] = rng.uniform(*model.actuator_ctrlrange.T)
        mujoco.mj_step(model, data, 25)
        assert np.abs(data.actuator_force).max() <= model.actuator_forcerange.max()
    assert not data.warning.number.any()
    assert np.isfinite(data.qpos).all()


def test_neighbours_along_a_finger_never_collide(hand: Hand) -> None:
    model, data = in_mujoco(hand_mjcf(hand))
    rng = np.random.default_rng(3)
    pairs = {(link.parent, i) for i, link in enumerate(hand.links)}
    for _ in range(20):
        data.qpos[:] = hand.expand(rng.uniform(*hand.limits.T))
        mujoco.mj_forward(model, data)
        for contact in data.contact[: data.ncon]:
            first, second = sorted(int(model.geom_bodyid[geom]) - 1 for geom in contact.geom)
            assert (first, second) not in pairs


def test_names_with_special_characters_are_escaped() -> None:
    hand = load_hand("sa")
    odd = replace(hand.links[1], name='a<b & "c"')
    model, _ = in_mujoco(hand_mjcf(replace(hand, links=(hand.links[0], odd, *hand.links[2:]))))
    assert model.body(odd.name).id == 2


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("object", "link 'object': this name is reserved in the simulation model"),
        ("bell\x07", r"link 'bell\x07': a name must be printable and not empty"),
    ],
)
def test_names_that_a_model_cannot_carry_are_refused(name: str, message: str) -> None:
    hand = load_hand("sa")
    renamed = replace(hand, links=(hand.links[0], replace(hand.links[1], name=name), *hand.links[2:]))
    with pytest.raises(InputError) as caught:
        hand_mjcf(renamed)
    assert str(caught.value) == f"sa: {message}"


def test_pairs_that_clearance_leaves_out_do_not_collide_in_the_model():
    # Balls on links without joints: some overlap, and the model keeps the ends apart.
    def ball(i: int, parent: int, x: float) -> Link:
        T = np.eye(4)
        T[0, 3] = x
        inertia = MassProperties(0.1, np.zeros(3), 1e-4 * np.eye(3))
        return Link(f"ball_{i}", parent, T, (), (Sphere(np.zeros(3), 0.01),), inertia)

    links = (ball(0, -1, 0.0), ball(1, 0, 0.05), ball(2, 1, 0.008), ball(3, 2, 0.008), ball(4, 0, 0.2))
    hand = Hand("row", links, {}, never_touching=((1, 4),))
    left_out = overlapping_links(hand)
    assert left_out == {(0, 1), (1, 2), (2, 3), (0, 4), (1, 3), (1, 4)}
    model = mujoco.MjModel.from_xml_string(hand_mjcf(hand))
    excluded = {(int(s) >> 16, int(s) & 0xFFFF) for s in model.exclude_signature}
    assert excluded == {(a + 1, b + 1) for a, b in left_out}
