"""The contact equations against finite differences, and against contacts made by construction."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from holdfast.geometry import BezierPatch, Cap, Patch, PointRegion
from holdfast.geometry.transforms import perpendicular, rotation_exp
from holdfast.hands import HandRegion, forward_kinematics, load_hand
from holdfast.objects import Contact, ObjectRegion, Task, load_object, load_task
from holdfast.solver import ContactManifold, State

KINDS = ("cap", "patch", "point")
PAIRS = list(itertools.product(KINDS, KINDS))
LINKS = ("index_distal", "thumb_distal")
ROWS = {("cap", "cap"): 1, ("cap", "patch"): 3, ("cap", "point"): 3, ("patch", "cap"): 3, ("point", "cap"): 3}


def unit(v):
    return v / np.linalg.norm(v)


def make_region(kind, rng):
    """A region of some centimetres, anywhere near the origin of its body."""
    if kind == "cap":
        return Cap(0.02 * rng.normal(size=3), 0.013, unit(rng.normal(size=3)), np.deg2rad(70), True)
    if kind == "point":
        return PointRegion(0.02 * rng.normal(size=3), unit(rng.normal(size=3)), True)
    M, N = rng.integers(1, 4, size=2)
    u, v = np.meshgrid(np.linspace(0, 0.03, M + 1), np.linspace(0, 0.02, N + 1), indexing="ij")
    net = np.stack([u, v, 0.004 * rng.uniform(size=u.shape)], axis=-1)
    return Patch(BezierPatch(net @ rotation_exp(rng.normal(size=3)).T + 0.02 * rng.normal(size=3)), True)


def make_task(pairs, rng):
    hand = load_hand("sa")
    contacts = tuple(
        Contact(
            HandRegion(f"hand {i}", hand.link_index(link), make_region(on_hand, rng)),
            ObjectRegion(f"object {i}", make_region(on_object, rng)),
            align_within_deg=0.0,
        )
        for i, (link, (on_hand, on_object)) in enumerate(zip(LINKS, pairs, strict=False))
    )
    return Task(name="toy", hand=hand, object=load_object("scalpel"), contacts=contacts)


def random_state(manifold, rng):
    low, high = manifold.lower, manifold.upper
    x = low + (high - low) * rng.uniform(0.2, 0.8, size=len(low))
    position = np.array([0.1, 0.02, 0.2]) + 0.05 * rng.normal(size=3)
    return State(x[: manifold.n_q], rotation_exp(rng.normal(size=3)), position, x[manifold.n_q :])


def touching(manifold, rng):
    """A state whose first contact holds, made by moving the object to where the hand's region is."""
    state = random_state(manifold, rng)
    contact = manifold.task.contacts[0]
    T = forward_kinematics(manifold.hand, manifold.hand.expand(state.q))[contact.hand.link]
    p_hand, n_hand = a_point(contact.hand.region, state.params[:2], rng)
    p_object, n_object = a_point(contact.object.region, state.params[manifold.n_params - 2 :], rng)
    p_hand, n_hand = T[:3, :3] @ p_hand + T[:3, 3], T[:3, :3] @ n_hand
    spin = rotation_exp(rng.uniform(-3, 3) * n_hand)
    R = (
        spin
        @ np.column_stack([*perpendicular(-n_hand), -n_hand])
        @ np.array([*perpendicular(n_object), n_object])
    )
    return State(state.q, R, p_hand - R @ p_object, state.params), (p_hand, n_hand)


def a_point(region, params, rng):
    if isinstance(region, Patch):
        return region.patch.evaluate(*params), region.patch.unit_normal(*params)
    points, normals = region.sample(1, rng)
    return points[0], normals[0]


def finite_differences(function, manifold, state, h=1e-6):
    steps = h * np.eye(manifold.n_tangent)
    columns = [function(manifold.retract(state, s)) - function(manifold.retract(state, -s)) for s in steps]
    return np.array(columns).T / (2 * h)


@pytest.mark.parametrize("pair", PAIRS, ids="-".join)
def test_jacobians_agree_with_finite_differences(pair):
    rng = np.random.default_rng(0)
    manifold = ContactManifold(make_task([pair, pair[::-1]], rng))
    for _ in range(3):
        state = random_state(manifold, rng)
        c, J = manifold.linearise(state)
        assert c.shape == (ROWS.get(pair, 5) + ROWS.get(pair[::-1], 5),)
        assert np.abs(J - finite_differences(manifold.residual, manifold, state)).max() < 1e-7
        g, J_g = manifold.inequalities(state)
        # One row a cap, and one that makes the normals face where there is none.
        assert g.shape == (2 * max(pair.count("cap"), 1),)
        expected = finite_differences(lambda s: manifold.inequalities(s)[0], manifold, state)
        assert J_g == pytest.approx(expected.reshape(J_g.shape), abs=2e-6)


@pytest.mark.parametrize("pair", PAIRS, ids="-".join)
def test_a_contact_made_by_construction_solves_the_equations(pair):
    rng = np.random.default_rng(1)
    manifold = ContactManifold(make_task([pair], rng))
    for _ in range(10):
        state, (p, n) = touching(manifold, rng)
        assert manifold.residual(state) == pytest.approx(np.zeros(ROWS.get(pair, 5)), abs=1e-15)
        (point,) = manifold.contact_points(state)
        assert point.p_hand == pytest.approx(p, abs=1e-14)
        assert point.p_object == pytest.approx(p, abs=1e-14)
        assert point.n_hand == pytest.approx(n, abs=1e-12)
        assert point.n_object == pytest.approx(-n, abs=1e-12)
        assert point.gap_m < 1e-14
        assert point.normal_angle_rad < 1e-7
        assert np.all(manifold.inequalities(state)[0] > -1e-12)
        assert manifold.is_feasible(state)


@pytest.mark.parametrize("pair", PAIRS, ids="-".join)
def test_apart_means_a_residual(pair):
    rng = np.random.default_rng(2)
    manifold = ContactManifold(make_task([pair], rng))
    state, (_, n) = touching(manifold, rng)
    dx = np.zeros(manifold.n_tangent)
    dx[manifold.n_q : manifold.n_q + 3] = 1e-3 * n
    lifted = manifold.retract(state, dx)
    assert np.linalg.norm(manifold.residual(lifted)) == pytest.approx(1e-3, rel=1e-6)
    if "cap" not in pair or pair == ("cap", "cap"):
        assert manifold.contact_points(lifted)[0].gap_m == pytest.approx(1e-3, rel=1e-6)


@pytest.mark.parametrize("pair", [p for p in PAIRS if "cap" not in p], ids="-".join)
def test_normals_that_face_the_same_way_are_not_feasible(pair):
    """The equations alone admit it; the hand would then stand inside the object."""
    rng = np.random.default_rng(3)
    manifold = ContactManifold(make_task([pair], rng))
    state, (p, n) = touching(manifold, rng)
    turn = rotation_exp(np.pi * perpendicular(n)[0])
    turned = State(state.q, turn @ state.R_palm_object, turn @ (state.p_palm_object - p) + p, state.params)
    assert manifold.residual(turned) == pytest.approx(np.zeros(5), abs=1e-14)
    assert not manifold.is_feasible(turned)


@pytest.mark.parametrize("pair", [("cap", "patch"), ("point", "cap")], ids="-".join)
def test_normals_outside_their_cap_are_not_feasible(pair):
    rng = np.random.default_rng(4)
    manifold = ContactManifold(make_task([pair], rng))
    signs = []
    for _ in range(60):
        state = random_state(manifold, rng)
        contact = manifold.task.contacts[0]
        (point,) = manifold.contact_points(state)
        on_hand = isinstance(contact.hand.region, Cap)
        cap = contact.hand.region if on_hand else contact.object.region
        T = forward_kinematics(manifold.hand, manifold.hand.expand(state.q))[contact.hand.link]
        R = T[:3, :3] if on_hand else state.R_palm_object
        angle = np.arccos(np.clip((R @ cap.axis) @ (point.n_hand if on_hand else point.n_object), -1, 1))
        assert manifold.is_feasible(state) == (angle <= cap.half_angle_rad)
        signs.append(angle <= cap.half_angle_rad)
    assert 5 < sum(signs) < 55


def test_sizes_and_limits():
    rng = np.random.default_rng(5)
    manifold = ContactManifold(make_task([("cap", "patch"), ("patch", "patch")], rng))
    assert (manifold.n_q, manifold.n_params, manifold.n_tangent) == (13, 6, 25)
    assert manifold.lower.shape == manifold.upper.shape == manifold.bounded.shape == (19,)
    assert manifold.bounded.tolist() == [*range(13), *range(19, 25)]
    assert np.array_equal(manifold.lower[:13], manifold.task.limits[:, 0])
    assert np.array_equal(manifold.upper[13:], np.ones(6))


@pytest.mark.parametrize("which", [0, 5, 13, 16])
@pytest.mark.parametrize("side", [-1, 1])
def test_beyond_a_limit_is_not_feasible(which, side):
    rng = np.random.default_rng(6)
    manifold = ContactManifold(make_task([("patch", "patch")], rng))
    state, _ = touching(manifold, rng)
    x = np.concatenate([state.q, state.params])
    x[which] = (manifold.upper if side > 0 else manifold.lower)[which] + side * 1e-6
    assert not manifold.is_feasible(State(x[:13], state.R_palm_object, state.p_palm_object, x[13:]))


def test_retraction():
    rng = np.random.default_rng(7)
    manifold = ContactManifold(make_task([("cap", "patch"), ("patch", "cap")], rng))
    state = random_state(manifold, rng)
    same = manifold.retract(state, np.zeros(manifold.n_tangent))
    for name in ("q", "R_palm_object", "p_palm_object", "params"):
        assert getattr(same, name) == pytest.approx(getattr(state, name), abs=1e-15)
    far = manifold.retract(state, 10 * rng.normal(size=manifold.n_tangent))
    x = np.concatenate([far.q, far.params])
    assert np.all((manifold.lower <= x) & (x <= manifold.upper))
    dx = np.zeros(manifold.n_tangent)
    dx[manifold.n_q : manifold.n_q + 6] = [0.1, 0.2, 0.3, 0.4, -0.5, 0.6]
    moved = manifold.retract(state, dx)
    assert moved.p_palm_object == pytest.approx(state.p_palm_object + dx[manifold.n_q : manifold.n_q + 3])
    assert moved.R_palm_object == pytest.approx(
        rotation_exp(dx[manifold.n_q + 3 : manifold.n_q + 6]) @ state.R_palm_object
    )


def test_rotations_do_not_drift():
    rng = np.random.default_rng(8)
    manifold = ContactManifold(make_task([("cap", "point")], rng))
    state = random_state(manifold, rng)
    crooked = State(
        state.q, state.R_palm_object + 1e-6 * rng.normal(size=(3, 3)), state.p_palm_object, state.params
    )
    for start in (state, crooked):
        now = start
        for _ in range(300):
            now = manifold.retract(now, 0.1 * rng.normal(size=manifold.n_tangent))
        assert now.R_palm_object.T @ now.R_palm_object == pytest.approx(np.eye(3), abs=1e-14)
        assert np.linalg.det(now.R_palm_object) == pytest.approx(1.0)


@pytest.mark.parametrize("pair", PAIRS, ids="-".join)
def test_projection_lands_on_the_manifold_near_by_and_keeps_limits(pair):
    rng = np.random.default_rng(9)
    manifold = ContactManifold(make_task([pair], rng))
    for _ in range(10):
        solution, _ = touching(manifold, rng)
        dx = 3e-3 * rng.normal(size=manifold.n_tangent)
        landed = manifold.project(manifold.retract(solution, dx))
        assert landed is not None
        assert np.abs(manifold.residual(landed)).max() < 1e-9
        x, x0 = (np.concatenate([s.q, s.params]) for s in (landed, solution))
        assert np.all((manifold.lower <= x) & (x <= manifold.upper))
        # Least-norm steps do not wander off: about as far as the disturbance itself.
        assert np.abs(x - x0).max() < 0.1
        assert np.linalg.norm(landed.p_palm_object - solution.p_palm_object) < 0.05


def test_projection_leaves_a_solution_as_it_is():
    rng = np.random.default_rng(10)
    manifold = ContactManifold(make_task([("cap", "patch")], rng))
    solution, _ = touching(manifold, rng)
    assert manifold.project(solution) is solution


def test_projection_holds_coordinates_at_their_limits():
    """Started at a corner of all limits, it either lands inside them or says that it did not."""
    task = load_task("upholding")
    manifold = ContactManifold(task)
    rng = np.random.default_rng(11)
    landed = 0
    for _ in range(20):
        x = np.where(rng.uniform(size=len(manifold.lower)) < 0.5, manifold.lower, manifold.upper)
        rotation = rotation_exp(rng.normal(size=3))
        start = State(x[: manifold.n_q], rotation, np.array([0.1, 0.03, 0.22]), x[manifold.n_q :])
        state = manifold.project(start)
        if state is None:
            continue
        landed += 1
        assert np.abs(manifold.residual(state)).max() < 1e-9
        x = np.concatenate([state.q, state.params])
        assert np.all((manifold.lower <= x) & (x <= manifold.upper))
    assert landed >= 5


def test_projection_says_when_it_does_not_land():
    """Fingertips and thumb tip that would have to touch two points ten metres apart."""
    rng = np.random.default_rng(12)
    task = make_task([("point", "point"), ("point", "point")], rng)
    far = Contact(
        task.contacts[1].hand,
        ObjectRegion("far", PointRegion(np.array([10.0, 0, 0]), np.array([0, 0, 1.0]), True)),
    )
    manifold = ContactManifold(replace(task, name="far", contacts=(task.contacts[0], far)))
    assert manifold.project(random_state(manifold, rng)) is None


def test_answers_do_not_depend_on_what_was_asked_before():
    rng = np.random.default_rng(13)
    task = make_task([("cap", "patch"), ("patch", "point")], rng)
    manifold = ContactManifold(task)
    a, b = random_state(manifold, rng), random_state(manifold, rng)
    expected = [ContactManifold(task).linearise(s) for s in (a, b)]
    manifold.contact_points(a)
    for state, (c, J) in zip((a, b, a), (*expected, expected[0]), strict=True):
        got = manifold.linearise(state)
        assert np.array_equal(got[0], c)
        assert np.array_equal(got[1], J)
        got[1][:] = 0.0  # what is handed out is the caller's own
        point = manifold.contact_points(state)[0]
        point.p_hand[:] = point.n_hand[:] = point.p_object[:] = point.n_object[:] = 9.0
    assert np.array_equal(manifold.linearise(a)[1], expected[0][1])


def test_state_is_a_frozen_copy():
    q = np.zeros(13)
    state = State(q, np.eye(3), np.zeros(3), np.zeros(0))
    q[0] = 1.0
    assert state.q[0] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        state.q[0] = 1.0
    assert state.T_palm_object == pytest.approx(np.eye(4))
