"""Rows of the relaxation hold, exactly, at every point that satisfies the functions, and are tight."""

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from holdfast.geometry.bernstein import bernstein
from holdfast.solver.enclosure.bernstein import bernstein_range, workspace
from holdfast.solver.linear.relaxation import Relaxation
from holdfast.solver.linear.tighten import Tightener
from holdfast.solver.polynomial.canonical import CanonicalForm, Rows, canonical_form
from holdfast.solver.polynomial.polynomial import Polynomial
from holdfast.solver.polynomial.system import SystemBuilder
from scipy.spatial import ConvexHull

Array = np.ndarray


def margins(rows: Rows, x: list[Fraction]) -> list[tuple[Fraction, Fraction]]:
    """By row: what the point is above the lower side and below the upper side (infinite sides left out)."""
    out = []
    for r in range(len(rows.lower)):
        total = sum(
            (
                Fraction(float(rows.value[t])) * x[rows.column[t]]
                for t in range(rows.start[r], rows.start[r + 1])
            ),
            Fraction(0),
        )
        big = Fraction(10) ** 6
        low, high = float(rows.lower[r]), float(rows.upper[r])
        out.append(
            (
                big if low == -np.inf else total - Fraction(low),
                big if high == np.inf else Fraction(high) - total,
            )
        )
    return out


def random_box(rng: np.random.Generator, size: int) -> tuple[Array, Array]:
    width = 10.0 ** rng.uniform(-12, 0.7, size) * (rng.uniform(size=size) < 0.9)
    lower = rng.normal(size=size) * 2
    return lower, lower + width


def members(lower: Array, upper: Array, rng: np.random.Generator) -> list[Fraction]:
    """A point of the box, as often as not with coordinates at its ends."""
    share = rng.choice([0.0, 0.0, 1.0, 1.0, 0.5, 0.3125], len(lower))
    return [
        Fraction(float(lo)) + Fraction(float(s)) * (Fraction(float(hi)) - Fraction(float(lo)))
        for lo, hi, s in zip(lower, upper, share, strict=True)
    ]


def products_system():
    builder = SystemBuilder()
    x, y, z = (builder.variable(name, -10, 10) for name in "xyz")
    builder.at_least_zero(x * x + x * y + y * z + z * z * x)
    return canonical_form(builder.build())


def test_rows_of_products_hold_exactly_on_the_products():
    form = products_system()
    relaxation = Relaxation(form)
    rng = np.random.default_rng(0)
    for _ in range(600):
        lower, upper = form.lower.copy(), form.upper.copy()
        lower[:3], upper[:3] = random_box(rng, 3)
        x = members(lower[:3], upper[:3], rng) + [Fraction(0)] * (form.size - 3)
        for k, i, j in form.products:
            x[k] = x[i] * x[j]
            if k < form.size:  # a product of products needs the box of its factors
                corners = np.multiply.outer([lower[i], upper[i]], [lower[j], upper[j]])
                room = 1e-14 * (1 + np.abs(corners).max())
                lower[k], upper[k] = corners.min() - room, corners.max() + room
        rows = relaxation.build(lower, upper).rows
        for below, above in margins(rows, x)[relaxation.n_linear :]:
            assert below >= 0 and above >= 0


def test_planes_of_a_product_touch_it_in_the_corners():
    """The tetrahedron of figure 5(b): in each corner of the rectangle all rows but two are tight."""
    form = products_system()
    relaxation = Relaxation(form)
    lower, upper = form.lower.copy(), form.upper.copy()
    lower[:3], upper[:3] = [-1.3, 0.2, 0.7], [0.4, 2.2, 0.9]
    rows = relaxation.build(lower, upper).rows
    (triple,) = (c for c, t in enumerate(form.products.tolist()) if t[1:] == [0, 1])
    first = relaxation.n_linear + 4 * triple
    k = form.products[triple, 0]
    for a in (lower[0], upper[0]):
        for b in (lower[1], upper[1]):
            x = [Fraction(0)] * form.size
            x[0], x[1] = Fraction(a), Fraction(b)
            x[k] = x[0] * x[1]
            distance = [float(min(pair)) for pair in margins(rows, x)[first : first + 4]]
            assert sorted(d < 1e-14 for d in distance) == [False, True, True, True]


def test_tangents_and_chord_of_a_square():
    """Figure 5(a) with one tangent more: tangents touch at the ends and half way, the chord at both ends."""
    form = products_system()
    relaxation = Relaxation(form)
    lower, upper = form.lower.copy(), form.upper.copy()
    lower[:3], upper[:3] = [-1.3, 0.2, 0.7], [0.4, 2.2, 0.9]
    rows = relaxation.build(lower, upper).rows
    (square,) = (c for c, t in enumerate(form.products.tolist()) if t[1:] == [0, 0])
    first = relaxation.n_linear + 4 * square
    k = form.products[square, 0]
    tight = []
    for a in (lower[0], upper[0]):
        x = [Fraction(0)] * form.size
        x[0] = Fraction(a)
        x[k] = x[0] * x[0]
        tight.append([float(min(pair)) < 1e-14 for pair in margins(rows, x)[first : first + 4]])
    assert tight == [[True, False, False, True], [False, True, False, True]]
    # Half way, the chord lies (width / 2)^2 above.
    x[0] = (Fraction(lower[0]) + Fraction(upper[0])) / 2
    x[k] = x[0] * x[0]
    assert float(margins(rows, x)[first + 2][0]) < 1e-14
    assert float(margins(rows, x)[first + 3][1]) == pytest.approx(0.85**2)


def function_form(b: Array) -> CanonicalForm:
    """x_2 = f(x_0, x_1) with control points b."""
    builder = SystemBuilder()
    u, v = builder.variable("u", 0, 1), builder.variable("v", 0, 1)
    builder.bernstein("f", u, v, b)
    return canonical_form(builder.build())


def parts(form: CanonicalForm, rng: np.random.Generator, count: int) -> Iterator[tuple[Array, Array]]:
    """Boxes of the parameters in the unit square, many of them narrow, some one float wide or a point."""
    for _ in range(count):
        ends = np.sort(rng.uniform(size=(2, 2)) ** rng.uniform(0.2, 5.0), axis=1)
        for end in ends:
            match int(rng.integers(0, 8)):
                case 0:
                    end[1] = end[0]
                case 1:
                    end[1] = np.nextafter(end[0], 1.0)
                case 2:
                    end[1] = min(end[0] + 10.0 ** rng.uniform(-14, -4), 1.0)
        yield np.append(ends[:, 0], form.lower[2]), np.append(ends[:, 1], form.upper[2])


DEGREES = [(1, 1), (1, 3), (2, 2), (3, 3), (5, 2), (0, 3), (4, 0), (0, 0), (5, 5)]


@pytest.mark.parametrize("degree", DEGREES)
def test_hulls_hold_exactly_on_the_function(exact, degree):
    rng = np.random.default_rng(sum(degree))
    b = rng.normal(size=(degree[0] + 1, degree[1] + 1))
    form = function_form(b)
    relaxation = Relaxation(form)
    for lower, upper in parts(form, rng, 60):
        rows = relaxation.build(lower, upper).rows
        assert np.isfinite(rows.value).all()
        assert np.all(np.isfinite(rows.lower) ^ np.isfinite(rows.upper))
        for _ in range(6):
            x = members(lower[:2], upper[:2], rng)
            x.append(exact.bernstein(b, *x))
            for below, above in margins(rows, x):
                assert below >= 0 and above >= 0


def envelope(rows: Rows, x: Array, y: Array) -> tuple[Array, Array]:
    """What the rows of one function leave of it at points (m,): lower and upper ends."""
    a = rows.value.reshape(-1, 3)
    plane = -np.outer(a[:, 1], x) - np.outer(a[:, 2], y)
    return (rows.lower[:, None] + plane).max(axis=0), (rows.upper[:, None] + plane).min(axis=0)


def wide_part(rng: np.random.Generator) -> Array:
    """Ends (2, 2) of both parameters."""
    low = rng.uniform(0.0, 0.6, 2)
    return np.column_stack([low, low + rng.uniform(0.05, 0.4, 2)])


def control_net(exact: Any, b: Array, ends: Array) -> Array:
    """Control points (n, 3) of the part over a box, by interpolation of exact values."""
    x, y = (np.linspace(*end, n) for end, n in zip(ends, b.shape, strict=True))
    values = [[float(exact.bernstein(b, Fraction(p), Fraction(q))) for q in y.tolist()] for p in x.tolist()]
    inverse = [np.linalg.inv(bernstein(n - 1, np.linspace(0.0, 1.0, n))) for n in b.shape]
    net = inverse[0] @ np.array(values) @ inverse[1].T
    return np.stack([*np.meshgrid(x, y, indexing="ij"), net], axis=-1).reshape(-1, 3)


@pytest.mark.parametrize("degree", [d for d in DEGREES if min(d) > 0])
def test_rows_of_a_function_are_the_hull_of_its_control_points(exact, degree):
    """As Qhull finds it (paper, section 4.3): the same facets but for vertical ones, and no others."""
    rng = np.random.default_rng(degree[0])
    b = rng.normal(size=(degree[0] + 1, degree[1] + 1))
    form = function_form(b)
    relaxation = Relaxation(form)
    for _ in range(10):
        ends = wide_part(rng)
        rows = relaxation.build(*np.column_stack([ends.T, [form.lower[2], form.upper[2]]])).rows
        normals = ConvexHull(control_net(exact, b, ends)).equations
        normals = normals[np.abs(normals[:, 2]) > 1e-6 * np.abs(normals).max(axis=1)]
        # A facet z = -(n_x x + n_y y + d) / n_z in the form of a row, below where its normal points down.
        facets = np.column_stack([np.sign(normals[:, 2]), normals[:, [0, 1, 3]] / normals[:, [2]]])
        side = np.where(np.isfinite(rows.upper), rows.upper, rows.lower)
        ours = np.column_stack(
            [np.where(np.isfinite(rows.upper), 1.0, -1.0), rows.value.reshape(-1, 3)[:, 1:], -side]
        )
        distances = np.abs(ours[:, None] - facets[None]).max(axis=2)
        assert distances.min(axis=1).max() < 1e-9 and distances.min(axis=0).max() < 1e-9


@pytest.mark.parametrize("seed", range(4))
def test_a_bilinear_function_has_the_tetrahedron_of_a_product(seed):
    """x y as a function and as a product: the same four faces."""
    rng = np.random.default_rng(seed)
    builder = SystemBuilder()
    u, v = builder.variable("u", 0, 1), builder.variable("v", 0, 1)
    builder.bernstein("f", u, v, np.array([[0.0, 0.0], [0.0, 1.0]]))
    builder.at_least_zero(u * v)
    form = canonical_form(builder.build())
    relaxation = Relaxation(form)
    lower, upper = form.lower.copy(), form.upper.copy()
    lower[:2], upper[:2] = wide_part(rng).T
    rows = relaxation.build(lower, upper).rows
    first = relaxation.n_linear
    faces = []
    for start in (first, first + 4):
        values = np.array([rows.value[rows.start[r] : rows.start[r] + 3] for r in range(start, start + 4)])
        sides = np.column_stack([rows.lower, rows.upper])[start : start + 4].clip(-1e3, 1e3)
        faces.append(np.array(sorted(np.column_stack([sides.round(9), values.round(9)]).tolist())))
    assert len(rows.lower) == first + 8
    assert np.abs(faces[0] - faces[1]).max() < 1e-12


@pytest.mark.parametrize("degree", [(1, 2), (2, 2), (3, 3), (5, 4)])
def test_hulls_are_within_two_parallel_planes(exact, degree):
    """Planes with the mean slopes of the chords, moved until all control points lie between them."""
    rng = np.random.default_rng(degree[1])
    b = rng.normal(size=(degree[0] + 1, degree[1] + 1))
    form = function_form(b)
    relaxation = Relaxation(form)
    shares = []
    for _ in range(10):
        ends = wide_part(rng)
        rows = relaxation.build(*np.column_stack([ends.T, [form.lower[2], form.upper[2]]])).rows
        net = control_net(exact, b, ends)
        z = net[:, 2].reshape(b.shape)
        rise = z[-1, 0] - z[0, 0] + z[-1, -1] - z[0, -1], z[0, -1] - z[0, 0] + z[-1, -1] - z[-1, 0]
        slopes = 0.5 * np.array(rise) / np.ptp(ends, axis=1)
        beside = net[:, 2] - net[:, :2] @ slopes
        x, y = rng.uniform(ends[:, :1], ends[:, 1:], (2, 200))
        low, high = envelope(rows, x, y)
        plane = slopes @ np.stack([x, y])
        assert np.all(low >= plane + beside.min() - 1e-12) and np.all(high <= plane + beside.max() + 1e-12)
        shares.append((high - low).mean() / np.ptp(beside))
    assert np.mean(shares) < 0.8


def test_flat_and_linear_functions_need_one_facet_a_side():
    for b in (np.full((4, 4), 0.3), np.add.outer(np.arange(4.0), 2.0 * np.arange(4.0))):
        form = function_form(b)
        rows = Relaxation(form).build(np.array([0.25, 0.5, -9.0]), np.array([0.5, 0.75, 9.0])).rows
        assert len(rows.lower) == 2
        assert rows.upper[1] - rows.lower[0] < 1e-13


def test_hulls_close_in_with_the_square_of_the_box():
    rng = np.random.default_rng(1)
    form = function_form(rng.normal(size=(4, 3)))
    relaxation = Relaxation(form)
    heights = []
    for width in (0.1, 0.01, 0.001):
        lower = np.array([0.4, 0.3, form.lower[2]])
        upper = np.array([0.4 + width, 0.3 + width, form.upper[2]])
        share = rng.uniform(size=(2, 50))
        low, high = envelope(relaxation.build(lower, upper).rows, *(lower[:2, None] + width * share))
        heights.append((high - low).max())
    assert heights[1] < 0.02 * heights[0]
    assert heights[2] < 0.02 * heights[1]


def test_a_basis_carries_over_though_facets_come_and_go():
    """Bounds from the basis of another box, with other facets, are those from none."""
    rng = np.random.default_rng(3)
    builder = SystemBuilder()
    u, v = builder.variable("u", 0, 1), builder.variable("v", 0, 1)
    f, g = (builder.bernstein(name, u, v, rng.normal(size=(4, 4))) for name in "fg")
    builder.equate(f * 0.5 + g + u - 0.6)
    form = canonical_form(builder.build())
    all_columns = np.arange(form.size)
    basis, seen = None, set()
    for _ in range(12):
        ends = wide_part(rng)
        lower, upper = form.lower.copy(), form.upper.copy()
        lower[:2], upper[:2] = ends.T
        names = Relaxation(form).build(lower, upper).names
        seen.add(tuple(names.tolist()))
        results = []
        for start in (None, basis):
            tightener = Tightener(form)
            low, high = lower.copy(), upper.copy()
            point = tightener.tighten(low, high, lambda _: all_columns, basis=start)
            results.append(None if point is None else np.concatenate([low, high]))
        basis = tightener.basis
        assert basis is not None and len(basis) == form.size + Relaxation(form).n_names
        assert (results[0] is None) == (results[1] is None)
        if results[0] is not None:
            # Nothing is asked of a side where a vertex came close to it.
            near = 0.02 * np.tile(upper - lower, 2) + 1e-9
            assert np.all(np.abs(results[0] - results[1]) <= near)
    assert len(seen) > 6


@pytest.mark.parametrize("degree", [(1, 1), (3, 2), (4, 4)])
def test_the_range_of_a_bernstein_function_over_a_part(exact, degree):
    rng = np.random.default_rng(2)
    b = rng.normal(size=(degree[0] + 1, degree[1] + 1))
    work = workspace(np.array([degree]))
    for _ in range(100):
        (il, iu), (jl, ju) = np.sort(rng.uniform(-0.1, 1.1, (2, 2)), axis=1)
        low, high = bernstein_range(b.ravel(), *degree, il, iu, jl, ju, work)
        x = members(np.array([il, jl]), np.array([iu, ju]), rng)
        assert Fraction(low) <= exact.bernstein(b, *x) <= Fraction(high)
    # Over a point the range is the value.
    low, high = bernstein_range(b.ravel(), *degree, 0.3, 0.3, 0.6, 0.6, work)
    assert high - low < 1e-13


def test_linear_rows_come_through_unchanged():
    builder = SystemBuilder()
    x, y = builder.variable("x", -1, 1), builder.variable("y", -1, 1)
    builder.equate(x * 2.0 - y * 3.0 + 0.5)
    builder.at_least_zero(Polynomial({(0, 1): 1.0, (1,): 4.0}))
    form = canonical_form(builder.build())
    rows = Relaxation(form).build(form.lower, form.upper).rows
    m = len(form.rows.value)
    assert rows.value[:m].tolist() == form.rows.value.tolist()
    assert rows.lower[:2].tolist() == form.rows.lower.tolist()
    assert rows.upper[:2].tolist() == form.rows.upper.tolist()
