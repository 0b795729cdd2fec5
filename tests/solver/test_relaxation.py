"""Rows of the relaxation hold, exactly, at every point that satisfies the functions, and are tight."""

from fractions import Fraction

import numpy as np
import pytest
from holdfast.solver.bernstein_box import bernstein_range, workspace
from holdfast.solver.canonical import Rows, canonical_form
from holdfast.solver.polynomial import Polynomial
from holdfast.solver.relaxation import Relaxation
from holdfast.solver.system import SystemBuilder

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
        rows = relaxation.build(lower, upper)
        for below, above in margins(rows, x)[relaxation.n_linear :]:
            assert below >= 0 and above >= 0


def test_planes_of_a_product_touch_it_in_the_corners():
    """The tetrahedron of figure 5(b): in each corner of the rectangle all rows but two are tight."""
    form = products_system()
    relaxation = Relaxation(form)
    lower, upper = form.lower.copy(), form.upper.copy()
    lower[:3], upper[:3] = [-1.3, 0.2, 0.7], [0.4, 2.2, 0.9]
    rows = relaxation.build(lower, upper)
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
    rows = relaxation.build(lower, upper)
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


@pytest.mark.parametrize("degree", [(1, 1), (1, 3), (2, 2), (3, 3), (5, 2), (0, 3)])
def test_bands_hold_exactly_on_the_function(exact, degree):
    rng = np.random.default_rng(sum(degree))
    builder = SystemBuilder()
    u, v = builder.variable("u", 0, 1), builder.variable("v", 0, 1)
    b = rng.normal(size=(degree[0] + 1, degree[1] + 1))
    builder.bernstein("f", u, v, b)
    form = canonical_form(builder.build())
    relaxation = Relaxation(form)
    for _ in range(60):
        ends = np.sort(rng.uniform(size=(2, 2)) ** rng.uniform(0.2, 5.0), axis=1)
        if rng.uniform() < 0.2:
            ends[0, 1] = np.nextafter(ends[0, 0], 1.0)  # slopes of so narrow a box are mere noise
        lower, upper = np.append(ends[:, 0], form.lower[2]), np.append(ends[:, 1], form.upper[2])
        rows = relaxation.build(lower, upper)
        for _ in range(8):
            x = members(lower[:2], upper[:2], rng)
            x.append(exact.bernstein(b, *x))
            for below, above in margins(rows, x):
                assert below >= 0 and above >= 0


def test_bands_close_in_with_the_square_of_the_box():
    rng = np.random.default_rng(1)
    builder = SystemBuilder()
    u, v = builder.variable("u", 0, 1), builder.variable("v", 0, 1)
    builder.bernstein("f", u, v, rng.normal(size=(4, 3)))
    form = canonical_form(builder.build())
    relaxation = Relaxation(form)
    heights = []
    for width in (0.1, 0.01, 0.001):
        lower, upper = (
            np.array([0.4, 0.3, form.lower[2]]),
            np.array([0.4 + width, 0.3 + width, form.upper[2]]),
        )
        rows = relaxation.build(lower, upper)
        heights.append(rows.upper[-1] - rows.lower[-2])
    assert heights[1] < 0.02 * heights[0]
    assert heights[2] < 0.02 * heights[1]


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
    rows = Relaxation(form).build(form.lower, form.upper)
    m = len(form.rows.value)
    assert rows.value[:m].tolist() == form.rows.value.tolist()
    assert rows.lower[:2].tolist() == form.rows.lower.tolist()
    assert rows.upper[:2].tolist() == form.rows.upper.tolist()
