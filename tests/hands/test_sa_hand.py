"""The SA hand against the published facts."""

import numpy as np
import pytest
from holdfast.geometry import BezierPatch, Box, Cap, Capsule, Hull, Patch, Sphere, shape_mesh
from holdfast.hands import builtin_hands, forward_kinematics, load_hand
from scipy.optimize import least_squares

HAND = load_hand("sa")
FINGERS = ("ring", "middle", "index", "thumb")


def pose_of(link, angles_deg=None):
    q = np.zeros(len(HAND.axes))
    for name, angle in (angles_deg or {}).items():
        q[HAND.joint_names.index(name)] = np.deg2rad(angle)
    return forward_kinematics(HAND, q)[HAND.link_index(link)]


def test_names_and_counts():
    assert "sa" in builtin_hands()
    joints = {f"{f}_{j}" for f in FINGERS for j in ("abduction", "flexion", "pip", "dip")} | {"thumb_base"}
    assert set(HAND.joint_names) == joints
    assert len(HAND.joint_names) == 17
    assert set(HAND.independent_names) == {name for name in joints if not name.endswith("_dip")}
    assert len(HAND.independent_names) == 13
    links = {f"{f}_{part}" for f in FINGERS for part in ("proximal", "medial", "distal")}
    assert {link.name for link in HAND.links} == links | {"palm", "thumb_base"}
    assert len(HAND.links) == 14


def test_limits_are_those_of_the_paper():
    expected = {"abduction": (-15, 15), "flexion": (-4, 75), "pip": (4, 75), "base": (0, 90)}
    for name, limits in zip(HAND.independent_names, np.rad2deg(HAND.limits), strict=True):
        assert limits == pytest.approx(expected[name.split("_")[1]])


def test_distal_joints_follow_the_pip_joints():
    q = HAND.expand(np.linspace(0.1, 0.5, 13))
    for finger in FINGERS:
        assert q[HAND.joint_names.index(f"{finger}_dip")] == q[HAND.joint_names.index(f"{finger}_pip")]


def test_total_mass_is_that_of_the_comparable_hand():
    assert sum(link.inertia.mass for link in HAND.links) == pytest.approx(1.8, abs=0.01)
    for finger in FINGERS:
        own = [
            link.inertia.mass
            for link in HAND.links
            if link.name.startswith(finger) and "base" not in link.name
        ]
        assert sum(own) == pytest.approx(0.375)


@pytest.mark.parametrize(
    ("finger", "position_mm", "splay_deg"),
    [
        ("ring", (-4.3, -40.165, 145.43), 1.97),
        ("middle", (-4.3, 0, 150.15), 0.0),
        ("index", (-4.3, 40.165, 145.43), -2.03),
    ],
)
def test_fingers_at_zero(finger, position_mm, splay_deg):
    T = pose_of(f"{finger}_proximal")
    assert 1e3 * T[:3, 3] == pytest.approx(position_mm)
    # u = +z, v = -y, w = +x, turned by the splay about +x.
    s, c = np.sin(np.deg2rad(splay_deg)), np.cos(np.deg2rad(splay_deg))
    assert T[:3, :3] == pytest.approx(np.array([[0, 0, 1], [-s, -c, 0], [c, -s, 0]]), abs=1e-12)


def test_flexion_turns_the_finger_out_of_the_palm():
    tip = np.array([0.03, 0, 0, 1.0])
    at_zero = pose_of("middle_distal") @ tip
    for joint in ("flexion", "pip", "dip"):
        assert (pose_of("middle_distal", {f"middle_{joint}": 20}) @ tip)[0] > at_zero[0] + 0.005


def test_phalanx_lengths():
    medial = pose_of("middle_medial")[:3, 3] - pose_of("middle_proximal")[:3, 3]
    distal = pose_of("middle_distal")[:3, 3] - pose_of("middle_medial")[:3, 3]
    assert 1e3 * np.linalg.norm(medial) == pytest.approx(67.8)
    assert 1e3 * np.linalg.norm(distal) == pytest.approx(30.0)


def test_thumb_base():
    base = pose_of("thumb_base")
    assert base[:3, :3] == pytest.approx(np.array([[0, -1, 0], [0, 0, -1], [1, 0, 0]]), abs=1e-12)
    assert 1e3 * base[:3, 3] == pytest.approx([-3, 27.1, 0])
    assert 1e3 * pose_of("thumb_proximal")[:3, 3] == pytest.approx([-9, 114, 97], abs=0.2)


def test_thumb_opposes_the_fingers_at_90():
    at_90 = pose_of("thumb_proximal", {"thumb_base": 90})
    assert 1e3 * at_90[0, 3] > 70  # in front of the palm
    w = at_90[:3, 2]
    assert w[0] < -0.5  # its pad looks back at the palm and the fingers


def test_thumb_frame_at_zero():
    """w_link is the abduction axis (cos 55, 0, sin 55) of L10, v_link is (0, 1, 0)."""
    R = pose_of("thumb_base")[:3, :3].T @ pose_of("thumb_proximal")[:3, :3]
    a = np.deg2rad(55)
    assert R[:, 2] == pytest.approx([np.cos(a), 0, np.sin(a)], abs=1e-12)
    assert R[:, 1] == pytest.approx([0, 1, 0], abs=1e-12)


# --- the published solutions


def contact_gap_mm(contact, solution):
    """Distance of the cap's centre to the object's patch, offset by the cap's radius."""
    names = {"ab": "abduction", "fl": "flexion", "pip": "pip", "dip": "dip"}
    angles = {}
    for finger, joints in solution["joint_angles_deg"].items():
        for short, angle in joints.items():
            if angle is not None:
                angles["thumb_base" if short == "base" else f"{finger}_{names[short]}"] = angle
    T = pose_of(contact["hand_link"].replace(" ", "_"), angles)
    centre = 1e3 * T[:3, 3] + T[:3, :3] @ contact["cap"]["centre_mm"]
    R, p = np.array(solution["object_rotation_rows"]), np.array(solution["object_position_mm"])
    patch = BezierPatch(np.array(contact["object_patch_mm"]["control_points"]) @ R.T + p)

    def apart(uv):
        return patch.evaluate(*uv) + contact["cap"]["radius_mm"] * patch.unit_normal(*uv) - centre

    return float(np.linalg.norm(least_squares(apart, [0.5, 0.5], bounds=(0, 1)).fun))


def test_published_solutions_close(published_tasks):
    solved = [task for task in published_tasks if task.get("published_first_solution")]
    gaps = [contact_gap_mm(c, task["published_first_solution"]) for task in solved for c in task["contacts"]]
    assert len(solved) == 7
    assert len(gaps) == 20
    # The published numbers are midpoints of boxes, so the equations hold only about so well.
    assert max(gaps) <= 0.86
    assert np.median(gaps) <= 0.1


# --- shapes and regions


def signed_distance(points, shape):
    """Signed distance (n,) to one convex shape; for a hull exact inside and near its faces."""
    match shape:
        case Sphere():
            return np.linalg.norm(points - shape.centre, axis=1) - shape.radius
        case Capsule():
            axis = shape.end - shape.start
            t = np.clip((points - shape.start) @ axis / (axis @ axis), 0, 1)
            return np.linalg.norm(points - shape.start - t[:, None] * axis, axis=1) - shape.radius
        case Box():
            local = (points - shape.T_link_box[:3, 3]) @ shape.T_link_box[:3, :3]
            return np.max(np.abs(local) - shape.half_extents, axis=1)
        case Hull():
            a, b, c = (shape.vertices[shape.faces[:, i]] for i in range(3))
            normals = np.cross(b - a, c - a)
            sizes = np.linalg.norm(normals, axis=1)
            normals, a = normals[sizes > 1e-12] / sizes[sizes > 1e-12, None], a[sizes > 1e-12]
            return np.max(points @ normals.T - np.sum(normals * a, axis=1), axis=1)


@pytest.mark.parametrize("name", HAND.regions)
def test_regions_lie_on_the_surface_of_their_link(name):
    region = HAND.regions[name]
    points, normals = region.region.sample(400, np.random.default_rng(0))
    shapes = HAND.links[region.link].shapes
    distance = np.min([signed_distance(points, shape) for shape in shapes], axis=0)
    assert 1e3 * np.abs(distance).max() <= 0.03
    outside = np.min([signed_distance(points + 1e-3 * normals, shape) for shape in shapes], axis=0)
    assert 1e3 * outside.min() > 0.7  # normals point out of the link


def test_every_finger_has_tip_and_pads():
    kinds = {"tip": Cap, "pad": Patch, "side": Patch, "medial": Patch, "proximal": Patch}
    for finger in FINGERS:
        for part, kind in kinds.items():
            region = HAND.regions[f"{finger}/{part}"]
            assert isinstance(region.region, kind)
            link = part if part in ("medial", "proximal") else "distal"
            assert HAND.links[region.link].name == f"{finger}_{link}"
    for part in ("centre", "edge", "upper"):
        assert isinstance(HAND.regions[f"palm/{part}"].region, Patch)


# Extents in mm as measured on the bodies of the benchmark: x, y, z with lower and upper ends.
EXTENTS = {
    "proximal": ((-12.7, 76.3), (-18.5, 18.5), (-22.7, 20.5)),
    "medial": ((-11, 41), (-15.7, 15.7), (-15.1, 14.3)),
    "distal": ((-10.9, 39), (-14.3, 14.3), (-14.9, 14.3)),
    "thumb_base": ((0.7, 101.3), (-20, 27.3), (-111, -18.5)),
    "palm": ((-44.7, 36.9), (-60, 63.2), (-6, 158.9)),
}


@pytest.mark.parametrize("link", HAND.links, ids=lambda link: link.name)
def test_extents_of_links(link):
    """Within 1.5 mm of the benchmark's bodies outwards, and 5 mm inwards."""
    expected = EXTENTS[link.name if link.name in EXTENTS else link.name.split("_")[1]]
    bounds = np.array([shape_mesh(shape).bounds for shape in link.shapes])
    lower, upper = 1e3 * bounds[:, 0].min(axis=0), 1e3 * bounds[:, 1].max(axis=0)
    for axis, (low, high) in enumerate(expected):
        assert low - 1.5 <= lower[axis] <= low + 5.0
        assert high - 5.0 <= upper[axis] <= high + 1.5


@pytest.mark.parametrize(("part", "volume_cm3"), [("proximal", 76), ("medial", 31), ("distal", 26)])
def test_volumes_are_like_the_bodies(part, volume_cm3):
    link = HAND.links[HAND.link_index(f"index_{part}")]
    points = np.vstack([shape_mesh(shape).vertices for shape in link.shapes])
    assert 1e6 * shape_mesh(Hull.from_points(points)).volume == pytest.approx(volume_cm3, rel=0.15)
