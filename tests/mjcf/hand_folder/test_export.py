"""A hand's folder loads by itself, agrees with the hand data, and behaves under load."""

import xml.etree.ElementTree as ET
from pathlib import Path

import mujoco
import numpy as np
import pytest
from holdfast.hands import Hand, builtin_hands, forward_kinematics, load_hand
from holdfast.mjcf.hand_folder.export import export_hand, hand_files
from holdfast.mjcf.hand_folder.postures import SelfContact, leaf_links, open_posture, pinch, power_posture

_ORDER = ["compiler", "option", "default", "asset", "worldbody"]
_ORDER += ["contact", "equality", "actuator", "sensor", "keyframe"]


@pytest.fixture(scope="module")
def hand() -> Hand:
    return load_hand("sa")


@pytest.fixture(scope="module")
def folder(hand: Hand, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("menagerie") / "schunk_sa"
    export_hand(hand, path, sources="Where the numbers come from.")
    return path


@pytest.fixture(scope="module")
def model(folder: Path) -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_path(str(folder / "sa_hand.xml"))


def test_the_folder_is_whole(folder: Path, hand: Hand) -> None:
    names = {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}
    assert {"sa_hand.xml", "scene.xml", "README.md", "CHANGELOG.md"} <= names
    assert names == set(hand_files(hand))
    readme = (folder / "README.md").read_text("utf-8")
    assert "Where the numbers come from." in readme
    assert all(f"`{name}`" in readme for name in hand.joint_names)
    assert mujoco.MjModel.from_xml_path(str(folder / "scene.xml")).nu == len(hand.independent)


def test_equal_hands_make_equal_files(hand: Hand) -> None:
    assert hand_files(hand) == hand_files(hand)


def test_kinematics_masses_and_servos_are_the_hands(hand: Hand, model: mujoco.MjModel) -> None:
    data = mujoco.MjData(model)
    rng = np.random.default_rng(0)
    for _ in range(10):
        q = hand.expand(rng.uniform(*hand.limits.T))
        data.qpos[:] = q
        mujoco.mj_kinematics(model, data)
        for link, T in zip(hand.links, forward_kinematics(hand, q), strict=True):
            assert np.abs(data.body(link.name).xpos - T[:3, 3]).max() < 1e-9
    for link in hand.links:
        assert model.body(link.name).mass[0] == pytest.approx(link.inertia.mass)
    for axis in hand.axes:
        joint = model.joint(axis.name)
        assert joint.range == pytest.approx([axis.lower, axis.upper], abs=1e-9)
        if axis.actuator is not None:
            servo = model.actuator(axis.name)
            assert servo.forcerange == pytest.approx([-axis.actuator.effort, axis.actuator.effort])
            assert servo.gainprm[0] == axis.actuator.stiffness
        # Every joint is damped and has armature, coupled ones too.
        assert model.dof_damping[joint.dofadr[0]] > 0.0
        assert model.dof_armature[joint.dofadr[0]] > 0.0


def test_what_is_drawn_and_what_collides_are_apart(hand: Hand, model: mujoco.MjModel) -> None:
    drawn = model.geom_group == 2
    collides = (model.geom_contype != 0) | (model.geom_conaffinity != 0)
    assert np.array_equal(model.geom_group == 3, collides)
    assert np.array_equal(drawn, ~collides)
    shapes = sum(len(link.shapes) for link in hand.links)
    assert drawn.sum() == collides.sum() == shapes
    assert not model.geom_contype[drawn].any()


def test_classes_are_nested_and_excludes_written_out(folder: Path, hand: Hand) -> None:
    root = ET.parse(folder / "sa_hand.xml").getroot()
    (top,) = root.findall("default/default")
    assert top.get("class") == "sa"
    inner = {child.get("class") for child in top.findall("default")}
    assert {"sa/visual", "sa/collision", "sa/coupled", "sa/pip", "sa/base"} <= inner
    used = {entry.get("class") for entry in root.iter() if entry.tag not in ("default",)}
    defined = {entry.get("class") for entry in root.iter("default")}
    assert used - {None} <= defined
    pairs = {(e.get("body1"), e.get("body2")) for e in root.iter("exclude")}
    for link in hand.links:
        if link.parent >= 0:
            assert (hand.links[link.parent].name, link.name) in pairs


def run_with_random_controls(model: mujoco.MjModel, seed: int) -> None:
    data = mujoco.MjData(model)
    rng = np.random.default_rng(seed)
    for _ in range(20):
        data.ctrl[:] = rng.uniform(*model.actuator_ctrlrange.T)
        mujoco.mj_step(model, data, max(1, round(0.05 / model.opt.timestep)))
    assert data.time >= 0.99
    assert not data.warning.number.any()
    assert np.isfinite(data.qpos).all()


def test_a_second_of_random_controls_runs_without_a_warning(model: mujoco.MjModel) -> None:
    for seed in range(5):
        run_with_random_controls(model, seed)


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in builtin_hands() if name != "sa"])
def test_every_built_in_hand_makes_a_folder_that_runs(name: str, tmp_path: Path) -> None:
    export_hand(load_hand(name), tmp_path)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "scene.xml"))
    assert {"open", "pinch", "power"} == {model.key(i).name for i in range(model.nkey)}
    assert model.nsensor == len(leaf_links(load_hand(name)))
    run_with_random_controls(model, seed=0)


def test_an_empty_section_is_left_out_and_sensors_come_before_keyframes(folder: Path) -> None:
    root = ET.parse(folder / "sa_hand.xml").getroot()
    tags = [entry.tag for entry in root]
    assert tags == sorted(tags, key=_ORDER.index)
    assert all(len(entry) or entry.attrib for entry in root)
    for body in root.iter("body"):
        parts = [child.tag for child in body]
        assert parts.index("geom") < parts.index("body") if "body" in parts else True
        assert "geom" not in parts[parts.index("body") :] if "body" in parts else True


def test_the_readme_names_the_sources_of_the_hand_file() -> None:
    hand = load_hand("shadow")
    text = hand_files(hand)["README.md"]
    assert hand.sources and all(source in text for source in hand.sources.values())


@pytest.mark.parametrize("force_N", [2.0, 30.0])
def test_coupled_distals_follow_within_a_hundredth_of_a_degree_under_load(
    hand: Hand, model: mujoco.MjModel, force_N: float
) -> None:
    """At the tip of each finger, along its pad's normal and sideways; 30 N is all that it may press with."""
    data = mujoco.MjData(model)
    q = 0.5 * (open_posture(hand) + power_posture(hand))
    for along in ((0.0, 0.0, -1.0), (0.0, 0.0, 1.0), (0.0, 1.0, 0.0)):
        mujoco.mj_resetData(model, data)
        data.qpos[:], data.ctrl[:] = hand.expand(q), q
        for _ in range(round(1.0 / model.opt.timestep)):
            mujoco.mj_forward(model, data)
            data.qfrc_applied[:] = 0.0
            for link in leaf_links(hand):
                body = data.body(hand.links[link].name)
                R = body.xmat.reshape(3, 3)
                point = body.xpos + R @ [0.0383, 0.0, 0.0]
                force = force_N * R @ np.array(along)
                mujoco.mj_applyFT(model, data, force, np.zeros(3), point, body.id, data.qfrc_applied)
            mujoco.mj_step(model, data)
        assert force_N > 2.0 or np.abs(data.qvel).max() < 1e-3
        for axis in hand.axes:
            if axis.coupling is not None:
                own, master = (data.joint(name).qpos[0] for name in (axis.name, axis.coupling.master))
                wanted = axis.coupling.ratio * master + axis.coupling.offset
                assert np.rad2deg(abs(own - wanted)) < 0.01


def test_keyframes_are_free_of_self_contact(hand: Hand, model: mujoco.MjModel) -> None:
    data = mujoco.MjData(model)
    for name in ("open", "pinch", "power"):
        mujoco.mj_resetDataKeyframe(model, data, model.key(name).id)
        assert data.qpos == pytest.approx(hand.expand(data.ctrl), abs=1e-6)
        mujoco.mj_forward(model, data)
        assert not data.ncon or data.contact.dist.min() >= 0.0, name
        # And it is a place of rest.
        mujoco.mj_step(model, data, round(0.2 / model.opt.timestep))
        assert np.abs(data.qpos - model.key(name).qpos).max() < 0.05, name


def test_a_pinch_faces_two_pads(hand: Hand, model: mujoco.MjModel) -> None:
    found = pinch(hand)
    assert found is not None
    Ts = forward_kinematics(hand, hand.expand(found.q))
    pads = []
    for name in ("thumb/tip", "index/tip"):
        pad = hand.regions[name]
        normal = Ts[pad.link][:3, :3] @ pad.region.axis
        pads.append((Ts[pad.link][:3, :3] @ pad.region.centre + Ts[pad.link][:3, 3], normal))
    (p1, n1), (p2, n2) = pads
    assert n1 @ n2 < -0.8
    assert 0.02 <= np.linalg.norm(p2 - p1) <= 0.06
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert data.site("grasp_site").xpos == pytest.approx(found.centre, abs=1e-9)


def test_power_bends_every_finger(hand: Hand) -> None:
    bent = power_posture(hand) - open_posture(hand)
    assert np.count_nonzero(bent > 0.3) >= 9
    assert not SelfContact(hand).pairs(power_posture(hand))


def test_touch_sensors_feel_what_touches(hand: Hand, folder: Path) -> None:
    """A block is pressed against one fingertip: its sensor feels it, the others don't."""
    text = (folder / "sa_hand.xml").read_text("utf-8")
    tip = load_hand("sa").links[leaf_links(hand)[-1]].name
    ball = (
        '<body name="ball"><freejoint/><inertial pos="0 0 0" mass="0.01" diaginertia="1e-6 1e-6 1e-6"/>'
        '<geom type="sphere" size="0.01"/></body></worldbody>'
    )
    path = folder / "with_ball.xml"
    root = ET.fromstring(text.replace("</worldbody>", ball))
    root.remove(root.find("keyframe"))
    path.write_text(ET.tostring(root, encoding="unicode"), "utf-8")
    model = mujoco.MjModel.from_xml_path(str(path))
    path.unlink()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    body = data.body(tip)
    data.qpos[-7:-4] = body.xpos + body.xmat.reshape(3, 3) @ [0.0253 + 0.013 + 0.0099, 0.0, 0.0]
    mujoco.mj_forward(model, data)
    felt = {model.sensor(i).name: data.sensordata[i] for i in range(model.nsensor)}
    assert felt.pop(f"{tip}_touch") > 0.0
    assert set(felt.values()) == {0.0}
