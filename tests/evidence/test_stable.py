"""Forces that are certified to balance a load, held against the project's statics and linear programs."""

from dataclasses import replace

import numpy as np
import pytest
from holdfast.evidence import CertifiedStable, NotCertified, certify_stable
from holdfast.evidence.force_rows import ARM_M
from holdfast.evidence.stable import _near, _Rows, certify_forces, find_forces
from holdfast.geometry import axis_rotation, cone_edges, perpendicular
from holdfast.mjcf.squeeze import grasp_statics
from holdfast.objects import LiftTest
from holdfast.solver import Configuration, SolutionRadii, State, solution_radii
from scipy.optimize import linprog

SCALE = np.array([1.0, 1.0, 1.0, 1.0 / ARM_M, 1.0 / ARM_M, 1.0 / ARM_M])


def to_palm(frames):
    """From contact vectors in frames (n, 3, 3) to forces in the palm frame, (4 n, 4 n)."""
    n = len(frames)
    out = np.zeros((4 * n, 4 * n))
    for i, frame in enumerate(frames):
        out[4 * i : 4 * i + 3, 4 * i : 4 * i + 3] = frame.T
        out[4 * i + 3, 4 * i + 3] = 1.0
    return out


def moved(state, radii, rng):
    """A state anywhere within the radii."""
    turn = rng.normal(size=3)
    angle = 0.9 * radii.rotation * rng.uniform(-1.0, 1.0)  # entries change by no more than the angle
    return State(
        state.q + radii.joints * rng.uniform(-1.0, 1.0, len(state.q)),
        axis_rotation(turn / np.linalg.norm(turn), angle) @ state.R_palm_object,
        state.p_palm_object + radii.position * rng.uniform(-1.0, 1.0, 3),
        np.clip(state.params + radii.parameters * rng.uniform(-1.0, 1.0, len(state.params)), 0.0, 1.0),
    )


def is_balanced(configuration, settings, arms_m):
    """Whether forces in cones a little too wide balance every direction of a lift, within all efforts."""
    statics = grasp_statics(configuration, settings)
    n, mu = statics.n_contacts, settings.sliding_friction(configuration.task.object)
    cone = cone_edges(mu, mu, 3, outside=True)
    edges = np.zeros((4 * n, n * cone.shape[1]))
    for i in range(n):
        block = cone.copy()
        block[3] *= arms_m[i]
        edges[4 * i : 4 * i + 4, i * cone.shape[1] : (i + 1) * cone.shape[1]] = block
    effort = statics.T @ edges / statics.effort[:, None]
    for direction in settings.directions:
        weight = np.zeros(6)
        weight[:3] = statics.mass * settings.gravity * np.array(direction)
        found = linprog(
            np.zeros(edges.shape[1]),
            np.vstack([effort, -effort]),
            np.ones(2 * len(effort)),
            SCALE[:, None] * (statics.G @ edges),
            -SCALE * weight,
            method="highs",
        )
        if found.status != 0:
            return False
    return True


def test_the_rows_hold_those_of_every_state_within_the_radii(grasps) -> None:
    rng = np.random.default_rng(1)
    for configuration, squeeze in grasps:
        task = configuration.task
        if not isinstance(task.test, LiftTest):
            continue
        for size in (1e-9, 1e-4):
            radii = SolutionRadii(size, size, size, size)
            rows, contacts = _Rows.of(_near(task, configuration.state, radii, squeeze.settings), ())
            for _ in range(5):
                state = moved(configuration.state, radii, rng)
                there = Configuration(task, state, 0.0, None)
                statics = grasp_statics(there, squeeze.settings)
                turn = to_palm(statics.frames)
                room = 1e-11 + rows.A.rad  # the statics are rounded themselves
                assert np.all(np.abs(SCALE[:, None] * (statics.G @ turn.T) - rows.A.mid) <= room)
                assert np.all(np.abs(statics.T @ turn.T - rows.T.mid) <= 1e-11 + rows.T.rad)
                assert np.all(
                    np.abs(statics.frames[:, 0] - contacts.inward.mid) <= 1e-11 + contacts.inward.rad
                )
            # And they are no wider than what such states do to them, by much.
            assert rows.A.rad.max() < 1e4 * size


def test_certified_forces_balance_and_lie_in_their_cones(grasps) -> None:
    certified = 0
    for configuration, squeeze in grasps:
        found = certify_stable(configuration, squeeze)
        task, settings = configuration.task, squeeze.settings
        if not found:
            continue
        certified += 1
        assert isinstance(found, CertifiedStable) and found.slack_N > 0.0 and found.effort_share < 1.0
        statics = grasp_statics(configuration, settings)
        vectors = np.einsum("nij,knj->kni", statics.frames, found.forces[..., :3])
        torques = found.forces[..., 3]
        mu = settings.sliding_friction(task.object)
        lengths = np.sqrt((vectors[..., 1:] ** 2).sum(axis=2) + (torques / squeeze.spin_arms_m) ** 2) / mu
        assert (vectors[..., 0] - lengths).min() >= found.slack_N - 1e-9
        contact_vectors = np.concatenate([vectors, torques[..., None]], axis=2).reshape(len(vectors), -1)
        assert (np.abs(contact_vectors @ statics.T.T) / statics.effort).max() <= found.effort_share + 1e-9
        if isinstance(task.test, LiftTest):
            weights = np.zeros((len(settings.directions), 6))
            weights[:, :3] = statics.mass * settings.gravity * np.array(settings.directions)
            assert np.abs(contact_vectors @ statics.G.T + weights).max() < 1e-9
            assert is_balanced(configuration, settings, squeeze.spin_arms_m)
    assert certified >= 8


def test_the_slack_is_the_largest_but_for_facets(grasps) -> None:
    """Forces with more slack than was found are ruled out by a linear program with cones too wide."""
    for configuration, squeeze in grasps:
        task, settings = configuration.task, squeeze.settings
        found = certify_stable(configuration, squeeze)
        if not found or not isinstance(task.test, LiftTest):
            continue
        statics = grasp_statics(configuration, settings)
        mu = settings.sliding_friction(task.object)
        directions = cone_edges(1.0, 1.0, 3)[1:].T
        n = statics.n_contacts
        rows, limits = [], []
        for i in range(n):
            block = np.zeros((len(directions), 4 * n + 1))
            block[:, 4 * i + 1 : 4 * i + 4] = directions / (mu * np.array([1.0, 1.0, squeeze.spin_arms_m[i]]))
            block[:, 4 * i], block[:, -1] = -1.0, 1.0
            rows.append(block)
            limits.append(np.zeros(len(directions)))
        scaled = statics.T.reshape(-1, n, 4) * mu
        scaled[..., 3] *= squeeze.spin_arms_m
        reach = np.abs(statics.T[:, 0::4]).sum(axis=1) + np.linalg.norm(scaled[..., 1:], axis=2).sum(axis=1)
        for sign in (1.0, -1.0):
            rows.append(np.column_stack([sign * statics.T, reach]))
            limits.append(statics.effort)
        least = np.inf
        for direction in settings.directions:
            weight = np.zeros(6)
            weight[:3] = statics.mass * settings.gravity * np.array(direction)
            best = linprog(
                -np.eye(4 * n + 1)[-1],
                np.vstack(rows),
                np.concatenate(limits),
                np.column_stack([SCALE[:, None] * statics.G, np.zeros(6)]),
                -SCALE * weight,
                bounds=[(None, None)] * (4 * n + 1),
                method="highs",
            )
            least = min(least, -best.fun)
        assert found.slack_N <= least + 1e-9
        assert found.slack_N >= least - 0.03 * least - 2e-3


def test_what_is_not_balanced_is_never_certified(grasps) -> None:
    """Friction, weight and the pose are changed until a linear program with cones too wide has no forces."""
    rng = np.random.default_rng(2)
    refused = 0
    for configuration, squeeze in grasps:
        task, state, arms_m = configuration.task, configuration.state, squeeze.spin_arms_m
        if not isinstance(task.test, LiftTest):
            continue
        forces = find_forces(task, state, squeeze.settings, arms_m)
        if isinstance(forces, NotCertified):
            forces = np.zeros((len(squeeze.settings.directions), len(task.contacts), 4))
        radii = solution_radii(configuration)
        for _ in range(6):
            mu = squeeze.settings.sliding_friction(task.object)
            settings = replace(
                squeeze.settings,
                friction=mu * rng.uniform(0.02, 0.6),
                gravity=9.81 * 10.0 ** rng.uniform(0.0, 2.0),
            )
            other = Configuration(task, moved(state, SolutionRadii(0.1, 0.3, 3e-3, 0.3), rng), 0.0, None)
            if is_balanced(other, settings, arms_m):
                continue
            refused += 1
            assert isinstance(find_forces(task, other.state, settings, arms_m), NotCertified)
            noise = rng.normal(scale=10.0 ** rng.uniform(-9.0, 1.0), size=forces.shape)
            for guess in (forces, forces + noise, 5.0 * forces):
                assert not certify_forces(task, other.state, radii, settings, arms_m, guess)
    assert refused >= 25


def test_forces_that_are_off_are_either_refused_or_still_prove_it(grasps) -> None:
    """Forces near balanced ones may certify, with less slack: true ones are near them."""
    configuration, squeeze = grasps[0]
    found = certify_stable(configuration, squeeze)
    assert isinstance(found, CertifiedStable)
    state, radii = configuration.state, found.radii
    rng = np.random.default_rng(4)
    for size in (1e-6, 1e-2, 1e1):
        guess = found.forces + rng.normal(scale=size, size=found.forces.shape)
        other = certify_forces(configuration.task, state, radii, squeeze.settings, squeeze.spin_arms_m, guess)
        if isinstance(other, CertifiedStable):
            assert other.slack_N <= found.slack_N + 2e-3 and other.error_N > 1e-2 * size
        else:
            assert size > 1e-6


def test_a_box_that_is_too_wide_proves_nothing(grasps) -> None:
    configuration, squeeze = grasps[0]
    forces = certify_stable(configuration, squeeze).forces
    wide = SolutionRadii(1.0, 1.0, 1.0, 1.0)
    found = certify_forces(
        configuration.task, configuration.state, wide, squeeze.settings, squeeze.spin_arms_m, forces
    )
    assert isinstance(found, NotCertified) and not found and "not certified stable" in str(found)


def test_without_a_certificate_there_is_none(grasps) -> None:
    configuration, squeeze = grasps[0]
    found = certify_stable(replace(configuration, certificate=None), squeeze)
    assert found == NotCertified("stable", "the contacts themselves are not certified")


def test_tangents_do_not_matter(grasps) -> None:
    """Forces are written in the palm frame, so no choice of tangents enters the statement."""
    configuration, squeeze = grasps[0]
    found = certify_stable(configuration, squeeze)
    inward = -configuration.contact_points[0].n_object
    normal = found.forces[:, 0, :3] @ inward
    sideways = found.forces[:, 0, :3] @ np.asarray(perpendicular(inward)).T
    assert (normal > np.linalg.norm(sideways, axis=1) / found.friction).all()


@pytest.mark.parametrize("name", ["joints", "rotation", "position", "parameters"])
def test_the_radii_are_those_of_the_certificate(grasps, name: str) -> None:
    for configuration, _ in grasps:
        radii = solution_radii(configuration)
        assert 0.0 <= getattr(radii, name) < 1e-9
        shifted = State(
            configuration.state.q + 1e-6,
            configuration.state.R_palm_object,
            configuration.state.p_palm_object,
            configuration.state.params,
        )
        about = solution_radii(configuration, shifted)
        assert 1e-6 <= about.joints < 40e-6
