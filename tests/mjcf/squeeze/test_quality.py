"""Analytic measures against closed forms and a second way to compute them."""

import numpy as np
import pytest
import trimesh
from holdfast.geometry.friction_cone import even_directions
from holdfast.hands import forward_kinematics
from holdfast.mjcf import Grasp, HoldSettings, auc, grasp_quality, plan_squeeze
from holdfast.mjcf.squeeze.quality import epsilon_and_volume, manipulability, torque_length_m
from scipy.optimize import linprog
from scipy.spatial import ConvexHull


def test_two_fingers_in_the_plane() -> None:
    """Antipodal points with friction mu, a apart, in the plane: forces (+-1, +-mu), torques +-a mu / 2.

    With unit length a / 2, the wrenches (1, +-mu, -+mu) and (-1, +-mu, +-mu) are a tetrahedron's corners.
    """
    mu = 0.5
    corners = np.array([[1, mu, -mu], [1, -mu, mu], [-1, mu, mu], [-1, -mu, -mu]]).T
    epsilon, volume = epsilon_and_volume(corners)
    # Its faces are mu x + y - z = mu and the like, at the distance mu / sqrt(2 + mu^2).
    assert epsilon == pytest.approx(mu / np.sqrt(2.0 + mu**2))
    assert volume == pytest.approx(8.0 * mu**2 / 3.0)


@pytest.mark.parametrize("d", [2, 3, 6])
def test_a_cross_polytope(d: int) -> None:
    wrenches = np.hstack([np.eye(d), -np.eye(d)])
    epsilon, volume = epsilon_and_volume(wrenches)
    assert epsilon == pytest.approx(1.0 / np.sqrt(d))
    assert volume == pytest.approx(2.0**d / np.prod(np.arange(1, d + 1)))


def test_cones_side_by_side_make_the_hull_that_merged_facets_make() -> None:
    """Three contacts, one of which may press at three places: facets that are nearly in one plane."""
    rng = np.random.default_rng(0)
    edges, wrenches = even_directions(1), []
    for places in (3, 1, 1):
        (n, a, b), p = np.linalg.qr(rng.normal(size=(3, 3)))[0], 0.03 * rng.normal(size=3)
        forces = n + 0.6 * (edges[:, :1] * a + edges[:, 1:2] * b)
        for aside in 0.008 * (np.arange(places) - places // 2):
            torques = np.cross(p + aside * a, forces) + 0.6 * 0.003 * edges[:, 2:] * n
            wrenches.append(np.hstack([forces, torques / 0.05]))
    points = np.vstack(wrenches)
    epsilon, volume = epsilon_and_volume(points.T)
    hull = ConvexHull(points)
    assert volume == pytest.approx(hull.volume, rel=1e-6) and volume > 0.0
    assert epsilon == pytest.approx(max(0.0, -hull.equations[:, -1].max()), abs=1e-7)


def test_one_sided_or_flat_wrenches_close_nothing() -> None:
    one_sided = np.abs(np.random.default_rng(0).normal(size=(3, 30)))
    assert epsilon_and_volume(one_sided)[0] == 0.0
    flat = np.vstack([np.random.default_rng(0).normal(size=(2, 30)), np.zeros(30)])
    assert epsilon_and_volume(flat) == (0.0, 0.0)
    assert epsilon_and_volume(np.eye(3)) == (0.0, 0.0)


def test_epsilon_is_the_least_resisted_wrench() -> None:
    """No direction is resisted by less, each found by a linear program; some direction by no more."""
    rng = np.random.default_rng(1)
    wrenches = rng.normal(size=(4, 40))
    epsilon, _ = epsilon_and_volume(wrenches)
    assert epsilon > 0.0
    reached = []
    for u in rng.normal(size=(200, 4)):
        u /= np.linalg.norm(u)
        # The largest s with s u = W x, x >= 0 of sum 1.
        A = np.vstack([np.column_stack([wrenches, -u]), [*np.ones(40), 0.0]])
        found = linprog([*np.zeros(40), -1.0], A_eq=A, b_eq=[0, 0, 0, 0, 1], method="highs")
        reached.append(found.x[-1])
    assert min(reached) >= epsilon - 1e-9
    assert min(reached) < 1.5 * epsilon


def test_wrench_margin_is_at_least_what_one_squeeze_carries(grasp: Grasp) -> None:
    """A squeeze serves all directions at once, and its sum of forces is bound: the margin is freer."""
    settings = HoldSettings(planned_load=50.0, patch_radius_m=0.005)
    margin = grasp_quality(grasp.configuration, settings=settings).wrench_margin
    assert margin >= plan_squeeze(grasp.configuration, settings=settings).load_factor - 1e-6


def test_more_friction_is_better(grasp: Grasp) -> None:
    low, high = (grasp_quality(grasp.configuration, settings=HoldSettings(friction=mu)) for mu in (0.6, 0.9))
    assert 0.0 < low.epsilon < high.epsilon
    assert low.volume < high.volume
    assert low.wrench_margin < high.wrench_margin
    assert low.manipulability == high.manipulability


def test_without_friction_nothing_is_closed(firm: Grasp) -> None:
    quality = grasp_quality(firm.configuration, settings=HoldSettings(friction=0.1))
    assert quality.epsilon == 0.0
    assert quality.wrench_margin == 0.0


def test_twice_the_weight_is_half_the_margin(firm: Grasp) -> None:
    once, twice = (grasp_quality(firm.configuration, settings=HoldSettings(gravity=g)) for g in (9.81, 19.62))
    assert twice.wrench_margin == pytest.approx(0.5 * once.wrench_margin, rel=1e-6)
    assert twice.epsilon == once.epsilon


def test_manipulability_by_finite_differences(grasp: Grasp) -> None:
    configuration = grasp.configuration
    hand, q = configuration.task.hand, configuration.state.q
    here = forward_kinematics(hand, configuration.joint_vector)
    measures = []
    for contact, point in zip(configuration.task.contacts, configuration.contact_points, strict=True):
        i = contact.hand.link
        local = np.linalg.inv(here[i]) @ [*point.p_hand, 1.0]
        J = np.zeros((3, len(q)))
        for j in range(len(q)):
            ends = [forward_kinematics(hand, hand.expand(q + s * 1e-6 * np.eye(len(q))[j])) for s in (1, -1)]
            J[:, j] = ((ends[0][i] - ends[1][i]) @ local)[:3] / 2e-6
        measures.append(np.prod(np.linalg.svd(J, compute_uv=False)))
    assert manipulability(configuration) == pytest.approx(min(measures), rel=1e-5)


def test_the_length_is_that_of_the_farthest_point(firm: Grasp) -> None:
    obj = firm.configuration.task.object
    points, _ = trimesh.sample.sample_surface(obj.mesh, 100_000, seed=0)
    farthest = np.linalg.norm(points - obj.inertia.centre, axis=1).max()
    length = torque_length_m(obj)
    assert farthest <= length + 1e-12
    assert length == pytest.approx(farthest, rel=0.02)


def test_auc() -> None:
    held = np.array([True, True, False, False])
    assert auc(np.array([4.0, 3.0, 2.0, 1.0]), held) == 1.0
    assert auc(np.array([1.0, 2.0, 3.0, 4.0]), held) == 0.0
    assert auc(np.ones(4), held) == 0.5
    assert auc(np.array([4.0, 2.0, 3.0, 1.0]), held) == 0.75
    assert auc(np.ones(2), np.array([True, True])) is None
