import numpy as np
import pytest
from holdfast.geometry.transforms import rotation_exp
from holdfast.hands import forward_kinematics, load_hand, point_jacobian
from holdfast.hands.hand_file import HandFile, build_hand
from holdfast.hands.kinematics import jacobian_from_axes, joint_axes
from scipy.spatial.transform import Rotation

BALL = [{"sphere": {"centre": [0, 0, 0], "radius": 0.01}}]
SERVO = {"effort": 1, "stiffness": 1, "damping": 0.1, "armature": 0.001}


def axis(name, direction, limits=(-1.0, 1.0), **more):
    return {"name": name, "direction": direction, "limits": list(limits), "actuator": SERVO, **more}


def make_hand(*joints):
    names = ["palm", *(joint["child"] for joint in joints)]
    links = [{"name": name, "mass": 0.1, "shapes": BALL} for name in names]
    return build_hand(HandFile(name="toy", links=links, joints=list(joints)), "toy")


def mixed_hand():
    """A slide with a universal joint on it, a fixed link at its end, and a revolute joint beside it."""
    turned = {"x_axis": [0, 0, 1], "y_axis": [0.6, 0.8, 0]}
    return make_hand(
        {"type": "prismatic", "parent": "palm", "child": "slide", "position": [0.1, 0, 0.02], **turned,
         "axes": [axis("s", [1, 2, 2], (-0.1, 0.1))]},
        {"type": "universal", "parent": "slide", "child": "a", "position": [0, 0.03, 0],
         "axes": [axis("u1", [0, 1, 0], zero_offset_deg=20), axis("u2", [0, 0, -1], zero_offset_deg=-35)]},
        {"type": "fixed", "parent": "a", "child": "tip", "position": [0.05, 0, 0.01], **turned},
        {"type": "revolute", "parent": "palm", "child": "b", "position": [0, -0.1, 0],
         "axes": [axis("r", [0, 0.6, 0.8])]},
    )  # fmt: skip


HANDS = {"sa": load_hand("sa"), "mixed": mixed_hand()}


@pytest.fixture(params=HANDS.values(), ids=HANDS.keys())
def hand(request):
    return request.param


def random_joints(hand, rng):
    return rng.uniform([a.lower for a in hand.axes], [a.upper for a in hand.axes])


def test_poses_are_rigid(hand):
    Ts = forward_kinematics(hand, random_joints(hand, np.random.default_rng(0)))
    R = Ts[:, :3, :3]
    assert R @ R.transpose(0, 2, 1) == pytest.approx(np.tile(np.eye(3), (len(R), 1, 1)), abs=1e-14)
    assert Ts[:, 3] == pytest.approx(np.tile([0, 0, 0, 1], (len(Ts), 1)))
    assert Ts[0] == pytest.approx(np.eye(4))


def test_chain_against_scipy(hand):
    """Independent composition: each link's own pose, then its axes one after the other."""
    q = random_joints(hand, np.random.default_rng(1))
    Ts = forward_kinematics(hand, q)
    k = 0
    for i, link in enumerate(hand.links):
        expected = (np.eye(4) if link.parent < 0 else Ts[link.parent]) @ link.T_parent_link0
        for a in link.axes:
            step = np.eye(4)
            if a.kind == "revolute":
                step[:3, :3] = Rotation.from_rotvec(q[k] * a.direction).as_matrix()
            else:
                step[:3, 3] = q[k] * a.direction
            expected = expected @ step
            k += 1
        assert Ts[i] == pytest.approx(expected, abs=1e-13)


def test_jacobians_agree_with_finite_differences(hand):
    rng = np.random.default_rng(2)
    q = random_joints(hand, rng)
    Ts = forward_kinematics(hand, q)
    h = 1e-6
    for link in range(len(hand.links)):
        p_link = rng.normal(size=3) * 0.05
        p = Ts[link][:3, :3] @ p_link + Ts[link][:3, 3]
        J_p, J_w = point_jacobian(hand, q, link, p)
        for k in range(len(q)):
            step = h * np.eye(len(q))[k]
            plus, minus = (forward_kinematics(hand, q + s)[link] for s in (step, -step))
            moved = (plus[:3, :3] @ p_link + plus[:3, 3]) - (minus[:3, :3] @ p_link + minus[:3, 3])
            turned = Rotation.from_matrix(plus[:3, :3] @ minus[:3, :3].T).as_rotvec()
            assert J_p[:, k] == pytest.approx(moved / (2 * h), abs=1e-8)
            assert J_w[:, k] == pytest.approx(turned / (2 * h), abs=1e-8)


def test_axes_stay_fixed_while_their_joint_moves(hand):
    q = random_joints(hand, np.random.default_rng(3))
    _, origins, directions = joint_axes(hand, q)
    for k in range(len(q)):
        _, moved_origins, moved_directions = joint_axes(hand, q + 0.1 * np.eye(len(q))[k])
        assert moved_directions[k] == pytest.approx(directions[k], abs=1e-13)
        assert moved_origins[k] == pytest.approx(origins[k], abs=1e-13)


def test_jacobian_takes_views_and_read_only_arrays(hand):
    q = random_joints(hand, np.random.default_rng(4))
    q.setflags(write=False)
    Ts, origins, directions = joint_axes(hand, q)
    last = len(hand.links) - 1
    expected = point_jacobian(hand, q, last, Ts[last][:3, 3].copy())
    for p in (Ts[last][:3, 3], Ts[last].T[3, :3]):
        J_p, J_w = jacobian_from_axes(hand, origins, directions, last, p)
        assert J_p == pytest.approx(expected[0])
        assert J_w == pytest.approx(expected[1])


def test_wrong_number_of_joints_is_an_error(hand):
    with pytest.raises(ValueError, match="joint vector"):
        forward_kinematics(hand, np.zeros(len(hand.axes) + 1))


@pytest.mark.parametrize("seed", range(5))
def test_universal_joint_with_offsets(seed):
    """T = R(a1, q1 + o1) R(a2, q2 + o2) in the frame that the file gives."""
    rng = np.random.default_rng(seed)
    frame = rotation_exp(rng.normal(size=3))
    a1 = rng.normal(size=3)
    a1 /= np.linalg.norm(a1)
    a2 = np.cross(a1, rng.normal(size=3))
    o1, o2 = rng.uniform(-180, 180, size=2)
    hand = make_hand(
        {"type": "universal", "parent": "palm", "child": "a", "position": [0.1, 0.2, 0.3],
         "x_axis": frame[:, 0].tolist(), "y_axis": frame[:, 1].tolist(),
         "axes": [axis("u1", a1.tolist(), zero_offset_deg=float(o1)),
                  axis("u2", a2.tolist(), zero_offset_deg=float(o2))]},
    )  # fmt: skip
    q = rng.uniform(-1, 1, size=2)
    first = Rotation.from_rotvec(a1 * (q[0] + np.deg2rad(o1))).as_matrix()
    second = Rotation.from_rotvec(a2 / np.linalg.norm(a2) * (q[1] + np.deg2rad(o2))).as_matrix()
    T = forward_kinematics(hand, q)[1]
    assert T[:3, :3] == pytest.approx(first @ second @ frame, abs=1e-12)
    assert T[:3, 3] == pytest.approx([0.1, 0.2, 0.3])
