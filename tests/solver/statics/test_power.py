"""Bernstein forms of power over parts of regions, against points of them and against exact arithmetic."""

import numpy as np
import pytest
from holdfast.geometry import BezierPatch, Cap, Patch, PointRegion
from holdfast.solver.statics.charts import UNIT_M, region_charts
from holdfast.solver.statics.power import point_power, power_net, refuted_friction
from holdfast.solver.statics.surface import extents, point_and_normal

CENTRE = np.array([0.003, -0.002, 0.001])


def patch(rng, degree):
    u, v = np.meshgrid(
        np.linspace(0, 0.05, degree[0] + 1), np.linspace(0, 0.03, degree[1] + 1), indexing="ij"
    )
    net = np.stack([u, v, np.full_like(u, 0.02)], axis=-1) + 0.004 * rng.normal(size=(*u.shape, 3))
    return Patch(BezierPatch(net))


def regions(seed):
    rng = np.random.default_rng(seed)
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    return [
        patch(rng, (1, 1)),
        patch(rng, (1, 3)),
        patch(rng, (3, 3)),
        Cap(rng.normal(size=3) * 0.02, 0.012, axis, 1.2),
        Cap(rng.normal(size=3) * 0.02, 0.012, axis, np.pi),
        PointRegion(rng.normal(size=3) * 0.02, axis),
    ]


def points_of(region, chart, u, v):
    """Point and unit inward normal from the centre of mass, in `UNIT_M`, by the region's own functions."""
    if isinstance(region, Patch):
        point, normal = region.patch.evaluate(u, v), -region.patch.unit_normal(u, v)
        return (point - CENTRE) / UNIT_M, normal
    point, normal, _, _ = point_and_normal(*(0.5 * (a + b) for a, b in (chart.points, chart.normals)), u, v)
    return point, normal


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("kind", range(6))
def test_power_at_every_point_lies_in_the_hull_of_the_control_points(kind, seed):
    region = regions(seed)[kind]
    rng = np.random.default_rng([7, kind, seed])
    for chart in region_charts(region, CENTRE):
        for _ in range(6):
            ends = np.sort(rng.uniform(size=(2, 2)), axis=1)
            low, high = power_net(*chart.points, *chart.normals, chart.is_patch, ends.ravel())
            assert (low <= high).all()
            y = rng.normal(size=6)
            for t in rng.uniform(size=(5, 2)):
                u, v = ends[:, 0] + t * (ends[:, 1] - ends[:, 0])
                q = point_power(*points_of(region, chart, u, v)) @ y
                # q of the net has the same direction but another length.
                nets = 0.5 * (low + high) @ y
                for _ in range(8):
                    c = rng.normal(size=8)
                    c -= (
                        (c @ q) / (q @ q) * q
                    )  # planes through the ray of q must not leave all points to a side
                    values = nets @ c
                    room = 1e-9 * np.abs(nets).max()
                    assert values.min() <= room and values.max() >= -room


@pytest.mark.parametrize("kind", range(6))
def test_no_force_has_power_against_a_twist_that_refutes(kind):
    rng = np.random.default_rng(kind)
    refuted = 0
    for seed in range(4):
        region = regions(seed)[kind]
        arm = 0.1
        for chart in region_charts(region, CENTRE):
            for _ in range(60):
                start = rng.uniform(0, 0.9, size=2)
                part = np.array([start[0], start[0] + 0.1, start[1], start[1] + 0.1])
                low, high = power_net(*chart.points, *chart.normals, chart.is_patch, part)
                y = np.rint(rng.normal(size=6) * 1000)
                reach = rng.choice([0.0, 0.05])
                friction = refuted_friction(low, high, np.full(len(low), arm), np.full(len(low), reach), y)
                if friction <= 0.0:
                    continue
                refuted += 1
                for t in rng.uniform(size=(20, 2)):
                    u, v = part[[0, 2]] + t * 0.1
                    p, n = points_of(region, chart, u, v)
                    # Anywhere in the disc about the point, in the tangent plane.
                    shift = np.cross(n, rng.normal(size=3))
                    shift *= reach * rng.choice([0.5, 1.0]) / np.linalg.norm(shift)
                    q = point_power(p + shift, n) @ y
                    q[4] *= arm
                    assert q[0] - 0.999999 * friction * np.linalg.norm(q[1:5]) > 0.0
    assert refuted >= 5


def test_charts_cover_a_cap():
    for half_angle in (0.3, 1.9, 2.5, np.pi):
        axis = np.array([0.6, 0.0, 0.8])
        cap = Cap(np.array([0.01, 0.02, 0.03]), 0.012, axis, half_angle)
        charts = region_charts(cap, CENTRE)
        assert len(charts) == (1 if half_angle < 2.0 else 2)
        nets = [[0.5 * (a + b) for a, b in (chart.points, chart.normals)] for chart in charts]
        t = np.linspace(0, 1, 60)
        covered = [point_and_normal(*net, u, v) for net in nets for u in t for v in t]
        normals = np.array([-n for _, n, _, _ in covered])
        points = np.array([p for p, _, _, _ in covered]) * UNIT_M + CENTRE
        assert np.allclose(points, cap.centre + cap.radius * normals, atol=1e-12)
        _, asked = cap.sample(200, np.random.default_rng(0))
        assert np.arccos(np.clip((asked @ normals.T).max(axis=1), -1, 1)).max() < 0.12


def test_derivatives_agree_with_differences():
    rng = np.random.default_rng(3)
    for region in regions(1):
        for chart in region_charts(region, CENTRE):
            nets = [0.5 * (a + b) for a, b in (chart.points, chart.normals)]
            at, h = rng.uniform(0.2, 0.8, size=2), 1e-6
            _, _, dp, dn = point_and_normal(*nets, *at)
            for k in range(2):
                step = h * np.eye(2)[k]
                ahead, back = point_and_normal(*nets, *(at + step)), point_and_normal(*nets, *(at - step))
                assert np.allclose((ahead[0] - back[0]) / (2 * h), dp[:, k], atol=1e-6)
                assert np.allclose((ahead[1] - back[1]) / (2 * h), dn[:, k], atol=1e-6)
            half = (
                extents(*nets, np.array([0.2, 0.3, 0.2, 0.3])),
                extents(*nets, np.array([0.2, 0.4, 0.2, 0.4])),
            )
            assert (half[0] <= half[1] + 1e-12).all()
