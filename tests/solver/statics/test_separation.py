"""Twists that separate, against linear programs over edges inside and outside the cones."""

import numpy as np
import pytest
from holdfast.mjcf.squeeze.load_program import cone_edges
from holdfast.solver.statics.power import point_power
from holdfast.solver.statics.separation import (
    BALANCED,
    SEPARATED,
    friction_against,
    needed_friction,
    separate,
    twist_for,
)
from scipy.optimize import linprog

ARM = 0.11


def grasp(rng, n):
    """Points about the origin with inward normals that look at it more or less."""
    points = rng.normal(size=(n, 3))
    points *= 0.5 / np.linalg.norm(points, axis=1, keepdims=True)
    normals = -points + rng.uniform(0.1, 0.6) * rng.normal(size=(n, 3)) * 0.5
    return points, normals / np.linalg.norm(normals, axis=1, keepdims=True)


def wrenches(points, normals, mu, *, outside):
    """Wrenches (k, 6) of all cone edges."""
    found = []
    for p, n in zip(points, normals, strict=True):
        t = np.cross(n, np.eye(3)[np.argmin(np.abs(n))])
        t /= np.linalg.norm(t)
        f_n, f_1, f_2, tau = cone_edges(mu, mu * ARM, 2, outside=outside)
        f = f_n[:, None] * n + f_1[:, None] * t + f_2[:, None] * np.cross(n, t)
        found.append(np.column_stack([f, np.cross(p, f) + tau[:, None] * n]))
    return np.vstack(found)


def can_balance(edges):
    k = len(edges)
    A = np.vstack([edges.T, np.ones(k)])
    return linprog(np.zeros(k), A_eq=A, b_eq=np.append(np.zeros(6), 1.0), method="highs").status == 0


@pytest.mark.parametrize("n", [2, 3, 4, 5])
def test_as_linear_programs_say(n):
    rng = np.random.default_rng(n)
    seen = {BALANCED: 0, SEPARATED: 0}
    for _ in range(60):
        points, normals = grasp(rng, n)
        mu = rng.uniform(0.05, 1.0)
        maps = np.array([point_power(p, m) for p, m in zip(points, normals, strict=True)])
        status, y, parts = separate(maps, np.full(n, ARM), np.zeros(n), np.arange(n), mu, n)
        inner = can_balance(wrenches(points, normals, mu, outside=False))
        outer = can_balance(wrenches(points, normals, mu, outside=True))
        assert not inner or status == BALANCED
        assert outer or status == SEPARATED
        seen[status] += 1
        assert np.allclose(parts.sum(axis=0), y, atol=1e-9)
        assert np.isclose((parts[:, :3] * normals).sum(), 1.0)
        if status == SEPARATED:
            assert (wrenches(points, normals, mu, outside=False) @ y).min() > 0.0
    assert min(seen.values()) >= (0 if n == 2 else 5)


def test_needed_friction_of_a_leaning_pinch_is_known():
    for lean in (0.01, 0.1, 0.4, 1.0):
        points = np.array([[0.3, 0.0, 0.0], [-0.3, 0.0, 0.0]])
        normals = -np.array([[np.cos(lean), np.sin(lean), 0.0], [-np.cos(lean), np.sin(lean), 0.0]])
        maps = np.array([point_power(p, m) for p, m in zip(points, normals, strict=True)])
        assert np.isclose(needed_friction(maps, np.full(2, ARM), np.zeros(2)), np.tan(lean), rtol=1e-5)


def test_what_can_never_balance_needs_no_end_of_friction():
    maps = np.array([point_power(p, np.array([0.0, 0.0, 1.0])) for p in np.eye(3)[:2]])
    assert needed_friction(maps, np.zeros(2), np.zeros(2)) == np.inf


@pytest.mark.parametrize("n", [2, 3, 4])
def test_needed_friction_changes_as_it_does_along_its_twist(n):
    rng = np.random.default_rng(n)
    errors = []
    arms, reaches = np.full(n, ARM), np.zeros(n)
    for _ in range(40):
        points, normals = grasp(rng, n)
        along, turned = 1e-4 * rng.normal(size=(2, n, 3))

        def maps(sign, points=points, normals=normals, along=along, turned=turned):
            leaning = normals + sign * turned
            leaning /= np.linalg.norm(leaning, axis=1)[:, None]
            return np.array([point_power(p, m) for p, m in zip(points + sign * along, leaning, strict=True)])

        needed = needed_friction(maps(0.0), arms, reaches)
        if not 1e-3 < needed < 10.0:
            continue
        twist, weights = twist_for(maps(0.0), arms, reaches, 0.999 * needed)
        assert np.isclose(friction_against(maps(0.0), arms, reaches, twist, weights), needed, rtol=0.01)
        changes = [
            cost(maps(1.0)) - cost(maps(-1.0))
            for cost in (
                lambda at: needed_friction(at, arms, reaches),
                lambda at, twist=twist, weights=weights: friction_against(at, arms, reaches, twist, weights),
            )
        ]
        errors.append(abs(changes[1] - changes[0]) / max(abs(changes[0]), 1e-5 * needed))
    # Of two contacts the twist is often not the only one, and changes are those along any of them.
    assert len(errors) >= 10 and (n == 2 or np.median(errors) < 0.02)
