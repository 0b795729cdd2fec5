"""Regions that are found: on their links, outward, and of every finger; mirror images; new hand files."""

from pathlib import Path

import mujoco
import numpy as np
import pytest
from holdfast.errors import InputError
from holdfast.geometry import Hull, Patch, region_normal, rotation_from_quaternion, shape_mesh
from holdfast.hands import (
    Hand,
    HandRegion,
    forward_kinematics,
    hand_placement,
    load_hand,
    mirrored,
    new_hand_file,
)
from holdfast.mjcf import hand_mjcf
from holdfast.pipeline.cli.main import main

MIRROR = np.diag([1.0, -1.0, 1.0, 1.0])


def finger(name: str, x: float, side: float, shape: str) -> str:
    """Two links that bend towards the middle, x = 0, for positive angles."""
    return f"""<body name="{name}_near" pos="{x} 0 0.03">
      <joint name="{name}_base" axis="0 {-side} 0" range="-0.2 1.2"/>
      <geom type="capsule" fromto="0 0 0 0 0 0.04" size="0.008" mass="0.03"/>
      <body name="{name}_far" pos="0 0 0.05"><joint name="{name}_bend" axis="0 {-side} 0" range="0 1.4"/>
        {shape}</body></body>"""


BLOCK = '<geom type="box" pos="0 0 0.018" size="0.006 0.008 0.018" mass="0.02"/>'
ROUND = '<geom type="capsule" fromto="0 0 0.002 0 0 0.03" size="0.008" mass="0.02"/>'
JAWS = "".join(
    f"""<body name="{name}_jaw" pos="{x} 0 0.05"><joint name="{name}_slide" type="slide" axis="1 0 0"
    range="{low} {high}"/><geom type="box" size="0.005 0.01 0.03" mass="0.03"/></body>"""
    for name, x, low, high in (("left", 0.03, -0.02, 0.02), ("right", -0.03, -0.02, 0.02))
)


def model(inner: str) -> str:
    return f"""<mujoco><compiler angle="radian"/><worldbody><body name="palm">
      <geom type="box" pos="0 0 0.01" size="0.05 0.03 0.01" mass="0.3"/>{inner}</body></worldbody></mujoco>"""


PINCERS = model(finger("index", 0.03, 1.0, BLOCK) + finger("thumb", -0.03, -1.0, ROUND))
MODELS = {"pincers": PINCERS, "jaws": model(JAWS)}


@pytest.fixture(params=MODELS)
def hand(request, tmp_path: Path) -> Hand:
    path = tmp_path / f"{request.param}_right.xml"
    path.write_text(MODELS[request.param], "utf-8")
    return load_hand(path)


def distance_off_surface(hand: Hand, entry: HandRegion) -> float:
    return hand_placement(hand, entry).farthest_m


def probes(hand: Hand, name: str) -> tuple[np.ndarray, np.ndarray]:
    return hand.regions[name].region.sample(200, np.random.default_rng(0))


def test_every_finger_has_a_tip_and_a_pad_and_the_palm_a_centre(hand):
    fingers = {"index", "thumb"} if hand.name.startswith("pincers") else {"left", "right"}
    assert {f"{f}/{part}" for f in fingers for part in ("tip", "pad")} | {"palm/centre"} <= set(hand.regions)


def test_regions_lie_on_their_links_with_outward_normals(hand):
    for name, entry in hand.regions.items():
        assert distance_off_surface(hand, entry) < 1.5e-4, name
        assert hand_placement(hand, entry).fault(entry.region, "") == ""
        points, normals = probes(hand, name)
        # A step outwards leaves all shapes of the link, a step inwards enters one.
        inside = {sign: _inside(hand, entry.link, points + sign * 1e-3 * normals) for sign in (1, -1)}
        assert not inside[1].any(), name
        assert inside[-1].all(), name


def _inside(hand: Hand, link: int, points: np.ndarray) -> np.ndarray:
    """By the meshes of shapes, rather than by what found the regions."""
    inside = np.zeros(len(points), dtype=bool)
    for shape in hand.links[link].shapes:
        mesh = shape_mesh(shape)
        depth = np.einsum("fi,pfi->pf", mesh.face_normals, points[:, None] - mesh.triangles[None, :, 0])
        inside |= depth.max(axis=1) < 1e-4
    return inside


def test_opposing_pads_face_each_other_when_the_hand_closes(hand):
    """In some posture each pad's middle looks at the other within 30 degrees."""
    pads = [name for name in hand.regions if name.endswith("/pad")]
    best = np.inf
    rng = np.random.default_rng(1)
    for _ in range(500):
        T = forward_kinematics(hand, hand.expand(rng.uniform(*hand.limits.T)))
        places = []
        for name in pads:
            points, normals = probes(hand, name)
            pose = T[hand.regions[name].link]
            places.append(
                (pose[:3, :3] @ points.mean(axis=0) + pose[:3, 3], pose[:3, :3] @ normals.mean(axis=0))
            )
        (p, n), (q, m) = places
        across = (q - p) / np.linalg.norm(q - p)
        angles = [
            np.arccos(np.clip(v @ w / np.linalg.norm(v), -1, 1)) for v, w in ((n, across), (m, -across))
        ]
        best = min(best, max(angles))
    assert best < np.radians(30.0)


ROD = """<body name="rod" pos="{at}"><joint name="rod_{of}" axis="0 1 0" range="-2 2"/>
    <geom type="box" pos="{middle}" size="0.003 0.003 {half}" mass="0.01"/></body>"""
LEADING_BACK = PINCERS.replace(BLOCK, BLOCK + ROD.format(of="a", at="0 0 0", middle="0 0 -0.03", half=0.03))
DRIVEN = PINCERS.replace(
    "</worldbody>",
    "</worldbody><equality><joint joint1='rod_b' joint2='index_base' polycoef='0 1.1 0 0 0'/></equality>",
).replace(
    "</body></worldbody>",
    ROD.format(of="b", at="0.02 0 0.02", middle="0 0 0.01", half=0.01) + "</body></worldbody>",
)


def test_pads_of_jaws_whose_frames_lie_between_them_face_each_other(tmp_path):
    """As exporters leave them that give all links one frame: nothing of a jaw is near its own."""
    jaws = "".join(
        f"""<body name="{name}_jaw"><joint name="{name}_slide" type="slide" axis="{side} 0 0" range="0 0.02"/>
        <geom type="box" pos="{side * 0.015} 0 0.03" size="0.005 0.01 0.03" mass="0.03"/>
        <geom type="box" pos="{side * 0.025} 0 0.008" size="0.008 0.01 0.008" mass="0.03"/></body>"""
        for name, side in (("left", 1), ("right", -1))
    )
    (tmp_path / "h.xml").write_text(model(jaws), "utf-8")
    hand = load_hand(tmp_path / "h.xml")
    for name, inward in (("left", -1.0), ("right", 1.0)):
        for place in ("pad", "tip"):
            point, normal = hand.regions[f"{name}/{place}"].region.middle()
            assert normal @ [inward, 0.0, 0.0] > 0.99 and abs(point[0]) == pytest.approx(0.01)


def test_pads_of_parallel_jaws_are_flat_and_parallel_however_their_frames_are_turned(tmp_path):
    """Control points that are rounded one by one in a turned frame would leave them askew by 1e-5 rad."""
    turn, back = "0.8 0.3 -0.4 0.33", "0.8 -0.3 0.4 -0.33"
    slide = rotation_from_quaternion(np.array([float(x) for x in back.split()])) @ [1.0, 0.0, 0.0]
    axis = " ".join(f"{x:.16g}" for x in slide)
    jaws = JAWS
    for name in ("left", "right"):
        jaws = jaws.replace(f'<body name="{name}_jaw" pos', f'<body name="{name}_jaw" quat="{turn}" pos')
    jaws = jaws.replace('axis="1 0 0"', f'axis="{axis}"').replace("<geom", f'<geom quat="{back}"')
    (tmp_path / "h.xml").write_text(model(jaws), "utf-8")
    hand = load_hand(tmp_path / "h.xml")
    T = forward_kinematics(hand, np.zeros(2))
    normals = []
    for name in ("left/pad", "right/pad"):
        entry = hand.regions[name]
        normal = region_normal(entry.region)
        assert normal is not None
        normals.append(T[entry.link][:3, :3] @ normal)
    assert np.abs(normals[0] + normals[1]).max() < 1e-12


@pytest.mark.parametrize("text", [LEADING_BACK, DRIVEN])
def test_a_rod_of_a_linkage_is_no_finger_and_bears_no_tip(text, tmp_path):
    """One hangs on a finger and leads back to the palm, one on the palm is driven by a finger's joint."""
    path = tmp_path / "pincers.xml"
    path.write_text(text, "utf-8")
    hand = load_hand(path)
    assert "rod" in [link.name for link in hand.links]
    assert {hand.links[region.link].name for name, region in hand.regions.items() if "tip" in name} == {
        "index_far",
        "thumb_far",
    }
    assert not any(hand.links[region.link].name == "rod" for region in hand.regions.values())


@pytest.mark.parametrize(
    ("called", "names"),
    [
        ("index medium pinky thumb", "index middle little thumb"),
        ("a b c d", "index middle ring thumb"),
        ("a ring c d", "index ring little thumb"),
        ("pinky b index d", "little middle index thumb"),
        # What every finger is called names none of them, and what the thumb is called none of the others.
        ("ring_a ring_b ring_c middle", "index ring little thumb"),
    ],
)
def test_names_that_a_model_gives_stay_and_the_others_follow_from_the_row(called, names, tmp_path):
    *row, opposing = called.split()
    fingers = "".join(
        finger(name, -0.03, -1.0, BLOCK).replace('pos="-0.03 0', f'pos="-0.03 {y}')
        for name, y in zip(row, (-0.03, 0.0, 0.03), strict=True)
    )
    thumb = finger(opposing, 0.03, 1.0, BLOCK).replace('pos="0.03 0', 'pos="0.03 -0.04')
    (tmp_path / "h.xml").write_text(model(fingers + thumb), "utf-8")
    hand = load_hand(tmp_path / "h.xml")
    found = {hand.links[one.link].name: name for name, one in hand.regions.items() if "/tip" in name}
    assert found == {f"{a}_far": f"{b}/tip" for a, b in zip(called.split(), names.split(), strict=True)}


def test_finding_is_deterministic(tmp_path):
    path = tmp_path / "a.xml"
    path.write_text(PINCERS, "utf-8")
    one, two = load_hand(path), load_hand(path)
    assert list(one.regions) == list(two.regions)
    for name in one.regions:
        assert np.array_equal(probes(one, name)[0], probes(two, name)[0])


def test_a_model_without_fingers_is_refused(tmp_path):
    path = tmp_path / "stick.xml"
    joint = '<joint name="a" axis="0 1 0" range="0 1"/>'
    bare = f'<body name="one">{joint}<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body>'
    path.write_text(model(bare), "utf-8")
    with pytest.raises(InputError, match="regions: no finger was found"):
        load_hand(path)


@pytest.mark.parametrize("name", ["sa", "shadow"])
def test_the_mirror_image_moves_as_the_hand_in_a_mirror(name):
    check_mirror(load_hand(name))


def test_the_mirror_image_of_a_model_moves_so_too(hand):
    check_mirror(hand)
    assert mirrored(hand).name.endswith("_left")


def check_mirror(hand: Hand) -> None:
    other, rng = mirrored(hand), np.random.default_rng(0)
    simulated = mujoco.MjModel.from_xml_string(hand_mjcf(other))
    data = mujoco.MjData(simulated)
    for _ in range(10):
        q = hand.expand(rng.uniform(*hand.limits.T))
        T, U = forward_kinematics(hand, q), forward_kinematics(other, q)
        assert np.abs(MIRROR @ T @ MIRROR - U).max() < 1e-12
        for joint, position in zip(other.joint_names, q, strict=True):
            data.joint(joint).qpos[0] = position
        mujoco.mj_kinematics(simulated, data)
        for link, pose in list(zip(other.links, U, strict=True))[1:]:
            assert np.abs(data.body(link.name).xpos - pose[:3, 3]).max() < 1e-12
            assert np.abs(data.body(link.name).xmat.reshape(3, 3) - pose[:3, :3]).max() < 1e-12
    for name in hand.regions:
        assert (
            distance_off_surface(other, other.regions[name])
            < distance_off_surface(hand, hand.regions[name]) + 1e-4
        )
        region, image = hand.regions[name].region, other.regions[name].region
        if isinstance(region, Patch):
            n, m = region.patch.unit_normal(0.3, 0.6), image.patch.unit_normal(0.6, 0.3)
            assert n * [1, -1, 1] == pytest.approx(m, abs=1e-12)
    for link, image in zip(hand.links, other.links, strict=True):
        assert image.inertia.mass == link.inertia.mass
        assert np.linalg.eigvalsh(image.inertia.inertia) == pytest.approx(
            np.linalg.eigvalsh(link.inertia.inertia), rel=1e-9, abs=1e-15
        )
        for shape in image.shapes:
            if isinstance(shape, Hull):
                corners = shape.vertices[shape.faces]
                volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum()
                assert volume > 0.0


def test_twice_mirrored_is_the_hand_itself():
    hand = load_hand("sa")
    again = mirrored(mirrored(hand))
    q = hand.expand(hand.limits.mean(axis=1))
    assert np.array_equal(forward_kinematics(hand, q), forward_kinematics(again, q))


def test_a_new_file_says_what_the_model_alone_is(hand, tmp_path):
    (source,) = tmp_path.glob("*.xml")
    path = tmp_path / "mine.yaml"
    path.write_text(new_hand_file(path, str(source)), "utf-8")
    read = load_hand(path)
    assert read.name == "mine" and list(read.regions) == list(hand.regions)
    assert read.joint_names == hand.joint_names
    for name in hand.regions:
        assert np.abs(probes(read, name)[0] - probes(hand, name)[0]).max() < 1e-8
    path.write_text(new_hand_file(path, str(source), mirror=True), "utf-8")
    left = load_hand(path)
    T = forward_kinematics(read, read.expand(read.limits.mean(axis=1)))
    U = forward_kinematics(left, left.expand(left.limits.mean(axis=1)))
    assert np.abs(MIRROR @ T @ MIRROR - U).max() < 1e-12


def test_a_hand_without_a_name_is_called_as_its_file_and_copied_so(tmp_path):
    text = new_hand_file(tmp_path / "first.yaml", None)
    nameless = "\n".join(line for line in text.splitlines() if not line.startswith("name:"))
    (tmp_path / "first.yaml").write_text(nameless, "utf-8")
    first = load_hand(tmp_path / "first.yaml")
    path = tmp_path / "second.yaml"
    path.write_text(new_hand_file(path, str(tmp_path / "first.yaml"), mirror=True), "utf-8")
    second = load_hand(path)
    assert (first.name, second.name) == ("first", "second_mirrored")
    T, U = (forward_kinematics(hand, hand.expand(hand.limits.mean(axis=1))) for hand in (first, second))
    assert np.abs(MIRROR @ T @ MIRROR - U).max() < 1e-12


def test_new_writes_an_example_and_never_over_a_file(tmp_path, capsys):
    path = tmp_path / "mine.yaml"
    assert main(["hands", "new", str(path)]) == 0
    assert {"index/tip", "thumb/tip", "palm/centre"} <= set(load_hand(path).regions)
    path.write_text("mine", "utf-8")
    assert main(["hands", "new", str(path), "--model", "sa"]) == 2
    assert "--force" in capsys.readouterr().err and path.read_text("utf-8") == "mine"
    assert main(["hands", "new", str(path), "--model", "sa", "--mirror", "--force"]) == 0
    T = forward_kinematics(load_hand("sa"), np.zeros(len(load_hand("sa").axes)))
    U = forward_kinematics(load_hand(path), np.zeros(len(load_hand(path).axes)))
    assert np.abs(MIRROR @ T @ MIRROR - U).max() < 1e-12


def test_a_model_elsewhere_is_refused_with_the_remedy(tmp_path, capsys):
    (tmp_path / "a.xml").write_text(PINCERS, "utf-8")
    assert main(["hands", "new", str(tmp_path / "below" / "b.yaml"), "--model", str(tmp_path / "a.xml")]) == 2
    assert "must lie in or below the folder of the hand file" in capsys.readouterr().err


def test_bare_models_are_listed_and_mirrored(tmp_path, capsys):
    (tmp_path / "pincers_right.xml").write_text(PINCERS, "utf-8")
    assert main(["hands", str(tmp_path / "pincers_right.xml"), "--mirror"]) == 0
    shown = capsys.readouterr().out
    assert "pincers_left" in shown and "index/tip" in shown and "usual servos" in shown


def test_the_palm_is_found_below_a_wrist(tmp_path):
    inner = PINCERS.partition("<worldbody>")[2].partition("</worldbody>")[0]
    arm = (
        '<mujoco><compiler angle="radian"/><worldbody><body name="arm"><geom size="0.02" mass="1"/>'
        '<body name="wrist"><joint name="turn" axis="0 0 1" range="-1 1"/><geom size="0.02" mass="0.1"/>'
        f"{inner}</body></body></worldbody></mujoco>"
    )
    path = tmp_path / "arm.xml"
    path.write_text(arm, "utf-8")
    hand = load_hand(path)
    assert "turn" not in hand.joint_names and len(hand.axes) == 4
    assert any("from which the fingers branch" in note for note in hand.notes)


@pytest.mark.parametrize("mirror", [False, True])
def test_the_example_that_is_written_without_a_model_has_sound_regions(mirror, tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text(new_hand_file(path, None, mirror=mirror), "utf-8")
    new = load_hand(path)
    assert {name.partition("/")[2] for name in new.regions} >= {"tip", "pad", "centre"}
    for region in new.regions.values():
        assert hand_placement(new, region).fault(region.region, new.links[region.link].name) == ""
