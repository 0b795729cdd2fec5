import numpy as np
import pytest
from holdfast.geometry import BezierPatch
from holdfast.geometry.bernstein import bernstein, bernstein_product
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

degrees = st.tuples(st.integers(1, 4), st.integers(1, 4))
nets = degrees.flatmap(
    lambda mn: arrays(float, (mn[0] + 1, mn[1] + 1, 3), elements=st.floats(-1, 1, allow_subnormal=False))
)
unit = st.floats(0, 1, allow_subnormal=False)
quick = settings(max_examples=60, deadline=None, derandomize=True)


def random_patch(rng: np.random.Generator, M: int, N: int) -> BezierPatch:
    return BezierPatch(rng.normal(size=(M + 1, N + 1, 3)))


def de_casteljau(points: np.ndarray, t: float) -> np.ndarray:
    while len(points) > 1:
        points = (1 - t) * points[:-1] + t * points[1:]
    return points[0]


@quick
@given(nets, unit, unit)
def test_evaluation_agrees_with_de_casteljau(net, u, v):
    expected = de_casteljau(de_casteljau(net, u), v)
    assert BezierPatch(net).evaluate(u, v) == pytest.approx(expected, abs=1e-12)


@quick
@given(st.integers(0, 9), unit)
def test_bernstein_polynomials_are_a_partition_of_one(degree, x):
    b = bernstein(degree, x)
    assert np.all(b >= 0)
    assert b.sum() == pytest.approx(1.0, abs=1e-13)


def test_parameters_broadcast():
    patch = random_patch(np.random.default_rng(0), 2, 3)
    u, v = np.linspace(0, 1, 4), np.linspace(0, 1, 5)
    grid = patch.evaluate(u[:, None], v[None, :])
    assert grid.shape == (4, 5, 3)
    assert grid[2, 3] == pytest.approx(patch.evaluate(u[2], v[3]), abs=1e-15)
    assert grid[[0, 0, -1, -1], [0, -1, 0, -1]] == pytest.approx(
        patch.control_points[[0, 0, -1, -1], [0, -1, 0, -1]]
    )


@pytest.mark.parametrize("degree", [(1, 1), (1, 3), (2, 2), (3, 2), (5, 4)])
def test_derivatives_agree_with_finite_differences(degree):
    rng = np.random.default_rng(1)
    patch = random_patch(rng, *degree)
    h = 1e-6
    for u, v in rng.uniform(0.1, 0.9, size=(5, 2)):
        du = (patch.evaluate(u + h, v) - patch.evaluate(u - h, v)) / (2 * h)
        dv = (patch.evaluate(u, v + h) - patch.evaluate(u, v - h)) / (2 * h)
        assert patch.du.evaluate(u, v) == pytest.approx(du, abs=1e-7)
        assert patch.dv.evaluate(u, v) == pytest.approx(dv, abs=1e-7)


@quick
@given(nets, unit, unit)
def test_normal_patch_is_the_cross_product_of_the_derivatives(net, u, v):
    patch = BezierPatch(net)
    M, N = patch.degree
    assert patch.normal.degree == (2 * M - 1, 2 * N - 1)
    expected = np.cross(patch.du.evaluate(u, v), patch.dv.evaluate(u, v))
    assert patch.normal.evaluate(u, v) == pytest.approx(expected, abs=1e-10)


def test_product_of_bernstein_polynomials():
    rng = np.random.default_rng(2)
    a, b = rng.normal(size=(3, 4)), rng.normal(size=(2, 5))

    def value(c, u, v):
        return bernstein(c.shape[0] - 1, u) @ c @ bernstein(c.shape[1] - 1, v)

    for u, v in rng.uniform(size=(5, 2)):
        assert value(bernstein_product(a, b), u, v) == pytest.approx(value(a, u, v) * value(b, u, v))


def test_outward_normal_of_a_flat_patch():
    patch = BezierPatch([[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    assert patch.unit_normal(0.3, 0.6) == pytest.approx([0, 0, 1])


@quick
@given(nets, st.sampled_from([0, 1]), st.floats(0.05, 0.95), unit, unit)
def test_halves_reproduce_the_patch(net, axis, t, u, v):
    patch = BezierPatch(net)
    first, second = patch.split(axis, t)
    at = [u, v]
    at[axis] = t * (u, v)[axis]
    assert first.evaluate(u, v) == pytest.approx(patch.evaluate(*at), abs=1e-12)
    at[axis] = t + (1 - t) * (u, v)[axis]
    assert second.evaluate(u, v) == pytest.approx(patch.evaluate(*at), abs=1e-12)


@quick
@given(nets, st.tuples(unit, unit), st.tuples(unit, unit), unit, unit)
def test_restriction_reproduces_the_patch(net, us, vs, u, v):
    (u0, u1), (v0, v1) = sorted(us), sorted(vs)
    patch = BezierPatch(net)
    piece = patch.restrict((u0, u1), (v0, v1))
    expected = patch.evaluate(u0 + u * (u1 - u0), v0 + v * (v1 - v0))
    assert piece.evaluate(u, v) == pytest.approx(expected, abs=1e-11)


@quick
@given(nets, unit, unit)
def test_points_lie_in_the_bounding_box_of_the_net(net, u, v):
    p = BezierPatch(net).evaluate(u, v)
    assert np.all(p >= net.min(axis=(0, 1)) - 1e-12)
    assert np.all(p <= net.max(axis=(0, 1)) + 1e-12)


def test_control_points_are_copied_and_frozen():
    net = np.random.default_rng(3).normal(size=(2, 2, 3))
    patch = BezierPatch(net)
    net[0, 0, 0] = 9.0
    assert patch.control_points[0, 0, 0] != 9.0
    with pytest.raises(ValueError, match="read-only"):
        patch.control_points[0, 0, 0] = 1.0


def grid(M: int, N: int) -> np.ndarray:
    u, v = np.meshgrid(np.linspace(0, 1, M + 1), np.linspace(0, 1, N + 1), indexing="ij")
    return np.stack([u, v, np.zeros_like(u)], axis=-1)


def collapsed_edge():
    net = grid(2, 2)
    net[0, :] = net[0, 0]
    return net


def folded():
    net = grid(2, 1)
    net[1, :, 0] = 3.0  # the control polygon goes far out and comes back
    return net


DEGENERATE = {
    "edge collapsed": collapsed_edge(),
    "folded": folded(),
    "zero area": np.full((2, 2, 3), 0.5),
    "a line": grid(1, 1) * [1, 0, 0],
    "bow tie": np.array([[[0, 0, 0], [1, 1, 0]], [[1, 0, 0], [0, 1, 0]]]),
}


@pytest.mark.parametrize("net", DEGENERATE.values(), ids=DEGENERATE.keys())
def test_degenerate_patches_are_noticed(net):
    assert BezierPatch(net).normal_may_vanish()


@pytest.mark.parametrize("scale", [1e-3, 1.0, 10.0])
@pytest.mark.parametrize("degree", [(1, 1), (2, 3), (3, 3)])
def test_gently_curved_patches_pass(degree, scale):
    rng = np.random.default_rng(4)
    net = grid(*degree) + [0, 0, 1] * rng.uniform(-0.2, 0.2, size=(degree[0] + 1, degree[1] + 1, 1))
    assert not BezierPatch(scale * net).normal_may_vanish()


def test_a_patch_that_bends_right_round_passes():
    """The normals cover more than a half space, so only subdivision can settle it."""
    angle = np.deg2rad([0, 80, 160, 240])
    ring = np.column_stack([np.cos(angle), np.sin(angle)])
    net = np.zeros((4, 2, 3))
    net[..., :2] = ring[:, None]
    net[:, 1, 2] = 1.0
    patch = BezierPatch(net)
    n = patch.unit_normal(np.linspace(0, 1, 30), np.full(30, 0.5))
    assert (n @ n.T).min() < -0.5
    assert not patch.normal_may_vanish()
