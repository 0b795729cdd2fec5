"""Bounds of the load over parts of regions, against what points of them carry; slopes of the descent."""

import numpy as np
import pytest
from holdfast.solver.statics.charts import region_charts
from holdfast.solver.statics.load.bound import load_bound
from holdfast.solver.statics.load.point import carried_load
from holdfast.solver.statics.load.twists import descend, load_rows, measure
from holdfast.solver.statics.power import point_power, power_net
from holdfast.solver.statics.surface import point_and_normal

from .test_power import CENTRE, regions

ARMS, FORCES, MU = np.array([0.1, 0.08, 0.1]), np.array([3.0, 5.0, 4.0]), 0.5


def opposed(seed: int) -> list:
    """Charts about the middle that face it, more or less: a patch, a cap, a point."""
    chosen = [regions(seed)[kind] for kind in (1, 3, 5)]
    return [region_charts(region, CENTRE)[0] for region in chosen]


def facing(rng: np.random.Generator, k: int) -> np.ndarray:
    """Maps (k, 8, 6) of points about the origin with normals that look at it, more or less."""
    points = rng.normal(size=(k, 3))
    points *= 0.5 / np.linalg.norm(points, axis=1, keepdims=True)
    normals = -points + 0.15 * rng.normal(size=(k, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return np.array([point_power(p, n) for p, n in zip(points, normals, strict=True)])


@pytest.mark.parametrize("seed", range(6))
def test_no_force_at_points_of_a_part_has_more_power_than_is_bounded(seed):
    rng = np.random.default_rng(seed)
    charts = opposed(seed)
    parts = [np.array([a, a + 0.2, b, b + 0.2]) for a, b in rng.uniform(0.0, 0.8, size=(3, 2))]
    nets = [power_net(*c.points, *c.normals, c.is_patch, p) for c, p in zip(charts, parts, strict=True)]
    low, high = (np.concatenate([net[k] for net in nets]) for k in (0, 1))
    owner = np.repeat(np.arange(3), [len(net[0]) for net in nets])
    normals = 0.5 * (low + high)[:, 0, :3]
    along = np.array([normals[owner == i].sum(axis=0) for i in range(3)])
    along = np.rint(along / np.abs(along).max(axis=1, keepdims=True) * 1000.0)
    for _ in range(10):
        twist = np.rint(rng.normal(size=6) * 1000.0)
        bound_N = load_bound(low, high, owner, ARMS, MU, FORCES, along, twist)
        tilted = np.array([np.roll(e, 1) * [1, -1, 1] for e in along])
        assert load_bound(low, high, owner, ARMS, MU, FORCES, tilted, twist) >= 0.0
        for _ in range(10):
            total = 0.0
            for chart, part, arm, force in zip(charts, parts, ARMS, FORCES, strict=True):
                u, v = part[[0, 2]] + rng.uniform(size=2) * 0.2
                p, n, _, _ = point_and_normal(
                    *(0.5 * (a + b) for a, b in (chart.points, chart.normals)), u, v
                )
                q = point_power(p, n) @ twist
                q[4] *= arm
                total += force * max(0.0, MU * np.linalg.norm(q[1:5]) - q[0])
            assert total / np.linalg.norm(twist[:3]) <= bound_N * (1.0 + 1e-12)


def test_a_turn_alone_shows_nothing():
    maps = facing(np.random.default_rng(0), 3)
    along = np.rint(maps[:, 0, :3] * 1000.0)
    twist = np.array([0.0, 0.0, 0.0, 5.0, 1.0, 2.0])
    assert load_bound(maps, maps, np.arange(3), ARMS, MU, FORCES, along, twist) == np.inf
    assert load_bound(maps, maps, np.arange(3), ARMS, MU, FORCES, -along, np.ones(6)) == np.inf


@pytest.mark.parametrize("smoothing", [0.3, 0.01])
def test_the_slope_agrees_with_differences(smoothing):
    rng = np.random.default_rng(4)
    maps, owner = facing(rng, 7), np.array([0, 0, 0, 1, 1, 2, 2])
    rows = load_rows(maps, maps[:, 0, :3], FORCES, ARMS, owner, MU)
    y, slope, weights = rng.normal(size=(2, 6)), np.zeros((2, 6)), np.zeros(7)
    rest, of_rest = np.zeros((2, 6)), np.zeros(7)
    at = measure(rows, owner, 3, y, smoothing, slope, weights)
    assert at >= measure(rows, owner, 3, y, 0.0, rest, of_rest)
    assert np.allclose([weights[owner == i].sum() for i in range(3)], 1.0)
    for k in np.ndindex(2, 6):
        step = np.zeros((2, 6))
        step[k] = 1e-6
        ahead = measure(rows, owner, 3, y + step, smoothing, rest, of_rest)
        back = measure(rows, owner, 3, y - step, smoothing, rest, of_rest)
        assert np.isclose((ahead - back) / 2e-6, slope[k], atol=1e-4)


def test_the_descent_ends_where_points_carry_no_more():
    rng, near = np.random.default_rng(11), 0
    for _ in range(12):
        maps, owner = facing(rng, 4), np.arange(4)
        forces, arms = np.full(4, 2.0), np.full(4, 0.1)
        carried = carried_load(maps, arms, MU, forces)
        assert carried.least <= carried.most
        rows = load_rows(maps, maps[:, 0, :3], forces, arms, owner, MU)
        starts = np.vstack([np.eye(3), -np.eye(3)])
        ends = [descend(rows, owner, 4, np.append(d, np.zeros(3))[None], 0.0, 0)[0] for d in starts]
        assert min(ends) >= carried.least * (1.0 - 1e-6)
        near += min(ends) <= carried.most * 1.01 + 1e-6
    assert near >= 10
