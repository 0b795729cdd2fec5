"""Propagation never loses a solution; refutes and narrows where it can."""

from collections.abc import Iterator
from fractions import Fraction

import numpy as np
import pytest
from holdfast.solver import solve
from holdfast.solver.contraction.hc4_canonical import Propagator
from holdfast.solver.formulate.formulate import formulate
from holdfast.solver.polynomial.canonical import CanonicalForm, canonical_form
from holdfast.solver.polynomial.polynomial import Polynomial, total
from holdfast.solver.polynomial.system import PolynomialSystem, SystemBuilder

Array = np.ndarray


def extend(form: CanonicalForm, x: list[Fraction]) -> list[Fraction]:
    out = [*x, *[Fraction(0)] * (form.size - len(x))]
    for k, i, j in form.products:
        out[k] = out[i] * out[j]
    return out


def planted_system(rng: np.random.Generator, exact) -> tuple[PolynomialSystem, list[Fraction]]:
    """Sparse equations of degree 1 to 3 with coefficients of full precision and an exact common root.

    The root's entries are powers of two with a sign, so that every monomial is one as well, and a term with
    any coefficient is cancelled exactly by another that carries a power of two times the same coefficient.
    """
    n = int(rng.integers(2, 7))
    builder = SystemBuilder()
    variables = [builder.variable(f"x{i}", -20.0, 20.0) for i in range(n)]
    x = [Fraction(2) ** int(rng.integers(-2, 3)) * int(rng.choice([-1, 1])) for _ in range(n)]
    if rng.uniform() < 0.5:
        u, v = builder.variable("u", 0.0, 1.0), builder.variable("v", 0.0, 1.0)
        x += [Fraction(int(k), 4) for k in rng.integers(0, 5, 2)]
        net = rng.integers(-16, 17, rng.integers(2, 5, 2)) / 4
        variables.append(builder.bernstein("f", u, v, net))
        x.append(exact.bernstein(net, *x[-2:]))
        builder.equate(variables[-1] * variables[0] - float(x[-1] * x[0]))
    if rng.uniform() < 0.5:
        variables.append(builder.define("d", variables[0] * variables[1] + variables[0]))
        x.append(x[0] * x[1] + x[0])
    for _ in range(int(rng.integers(1, n + 1))):
        builder.equate(_cancelling(rng, x, n))
    system = builder.build()
    assert all(exact.polynomial(e, x) == 0 for e in system.equations)
    return system, x


def _cancelling(rng: np.random.Generator, x: list[Fraction], n: int) -> Polynomial:
    terms: dict[tuple[int, ...], float] = {}
    pairs = []
    for _ in range(int(rng.integers(1, 4))):
        c = float(rng.normal())
        a, b = (tuple(sorted(int(i) for i in rng.integers(0, n, size))) for size in rng.integers(1, 4, 2))
        if a == b or a in terms or b in terms:
            continue
        ratio = np.prod([x[i] for i in a], dtype=object) / np.prod([x[i] for i in b], dtype=object)
        terms[a], terms[b] = c, -c * float(ratio)
        pairs += [a, b]
    rng.shuffle(pairs)
    return Polynomial({m: terms[tuple(m)] for m in map(tuple, pairs)})


def boxes_around(
    rng: np.random.Generator, form: CanonicalForm, lower: Array, upper: Array, count: int
) -> Iterator[tuple[Array, Array]]:
    """Boxes that hold [lower, upper]: from a point to the whole box, with sides on the solution itself."""
    n = form.size
    size = 10.0 ** rng.uniform(-16, 1.5, (count, 2, n)) * 10.0 ** rng.uniform(-3, 0, (count, 1, 1))
    size *= rng.uniform(size=(count, 2, n)) < rng.uniform(0.3, 1.0, (count, 1, 1))
    for below, above in size:
        yield np.maximum(lower - below, form.lower), np.minimum(upper + above, form.upper)


def contract_many(count_of_systems: int, boxes_each: int, seed: int, exact, keeping) -> None:
    rng = np.random.default_rng(seed)
    for _ in range(count_of_systems):
        system, x = planted_system(rng, exact)
        form = canonical_form(system)
        root = extend(form, x)
        boxes = boxes_around(rng, form, *exact.ends(root), boxes_each)
        keeping.check(root, boxes, Propagator(form).contract)


@pytest.mark.parametrize("systems", [100, pytest.param(500, marks=pytest.mark.slow)])
def test_never_loses_a_planted_root(systems, exact, keeping):
    contract_many(systems, 220, 0, exact, keeping)
    assert keeping.count >= 200 * systems
    assert keeping.narrowed > 0.2 * keeping.count  # else nothing was tried


@pytest.mark.slow
def test_never_loses_a_planted_root_in_a_million_boxes(exact, keeping):
    contract_many(4000, 250, 1, exact, keeping)
    assert keeping.count >= 1_000_000


def test_never_loses_an_exact_value_of_full_precision(exact):
    """Definitions at any inputs have an exact rational value; none of its columns may lose it."""
    rng = np.random.default_rng(2)
    for _ in range(150):
        builder = SystemBuilder()
        a, b, c = (builder.variable(name, -2.0, 2.0) for name in "abc")
        u, v = builder.variable("u", 0.0, 1.0), builder.variable("v", 0.0, 1.0)
        f = builder.bernstein("f", u, v, rng.normal(size=rng.integers(2, 5, 2)))
        g = builder.define("g", a * b * rng.normal() + c * c * rng.normal() + a * rng.normal() + rng.normal())
        h = builder.define("h", a * a * b * rng.normal() + g * f * rng.normal() - c)
        builder.at_least_zero(h * h)
        system = builder.build()
        form = canonical_form(system)
        propagator = Propagator(form)
        x = [Fraction(float(t)) for t in [*rng.uniform(-2, 2, 3), *rng.uniform(0, 1, 2)]]
        x += [Fraction(0)] * 3
        exact.define(system, x)
        root = extend(form, x)
        low, high = exact.ends(root)
        for lower, upper in boxes_around(rng, form, low, high, 20):
            assert propagator.contract(lower, upper)
            assert exact.within(root, lower, upper)


def test_keeps_every_sampled_point_of_a_surface():
    """On y = x^2, z = x y a dyadic x gives an exact point: no box may lose any that it holds."""
    builder = SystemBuilder()
    x, y, z = builder.variable("x", -2, 2), builder.variable("y", -5, 5), builder.variable("z", -9, 9)
    builder.equate(y - x * x)
    builder.equate(z - x * y)
    form = canonical_form(builder.build())
    propagator = Propagator(form)
    xs = np.arange(-512, 513) / 256
    points = np.zeros((len(xs), form.size))
    points[:, 0], points[:, 1], points[:, 2] = xs, xs**2, xs**3
    for k, i, j in form.products:
        points[:, k] = points[:, i] * points[:, j]
    rng = np.random.default_rng(3)
    refuted = 0
    for _ in range(4000):
        lower = rng.uniform(form.lower, form.upper)
        upper = np.minimum(lower + rng.exponential(2.0, form.size), form.upper)
        held = points[((lower <= points) & (points <= upper)).all(axis=1)]
        if propagator.contract(lower, upper):
            assert ((lower <= held) & (held <= upper)).all()
        else:
            refuted += 1
            assert len(held) == 0
    assert 1000 < refuted < 4000


def contracted(builder: SystemBuilder, **cuts: tuple[float, float]) -> dict[str, tuple[float, float]] | None:
    form = canonical_form(builder.build())
    lower, upper = form.lower.copy(), form.upper.copy()
    names = builder.names
    for name, (lo, hi) in cuts.items():
        lower[names.index(name)], upper[names.index(name)] = lo, hi
    if not Propagator(form).contract(lower, upper):
        return None
    return {name: (lower[i], upper[i]) for i, name in enumerate(names)}


def circle_and_line() -> SystemBuilder:
    builder = SystemBuilder()
    x, y = builder.variable("x", -3, 3), builder.variable("y", -3, 3)
    builder.equate(x * x + y * y - 1.0)
    builder.equate(x * 2.0 - y * 3.0 + builder.variable("z", -10, 10))
    return builder


def test_solves_each_constraint_for_each_of_its_variables():
    out = contracted(circle_and_line(), x=(0.6, 3.0), y=(0.1, 3.0))
    assert out is not None
    assert out["x"] == pytest.approx((0.6, np.sqrt(0.99)))
    assert out["y"] == pytest.approx((0.1, 0.8))
    assert out["z"] == pytest.approx((0.3 - 2 * np.sqrt(0.99), 2.4 - 1.2))


def test_squares_are_solved_on_either_branch():
    out = contracted(circle_and_line(), x=(-3.0, 0.1), y=(-0.5, 0.5))
    assert out is not None
    assert out["x"] == pytest.approx((-1.0, -np.sqrt(0.75)))


def test_products_are_divided_by_their_factors():
    builder = SystemBuilder()
    x, y, z = builder.variable("x", -4, 4), builder.variable("y", 0, 4), builder.variable("z", 1, 2)
    builder.equate(z - x * y)
    out = contracted(builder)
    assert out is not None
    assert out["x"] == pytest.approx((0.25, 4.0))
    assert out["y"] == pytest.approx((0.25, 4.0))


@pytest.mark.parametrize("place", [0, 16, 33])
def test_long_rows_are_summed_outward_before_and_behind_each_entry(place):
    """A large entry swallows 32 ones next to it, wherever in the row the entry stands that is solved for."""
    builder = SystemBuilder()
    ones = [builder.variable(f"x{i}", 1, 1) for i in range(32)]
    large, target = builder.variable("large", 2.0**54, 2.0**54), builder.variable("target", -(2.0**60), 0)
    for row in ([large, *ones], [*ones, large]):
        row.insert(place, target)
        builder.equate(total(row))
    out = contracted(builder)
    assert out is not None
    low, high = out["target"]
    assert low <= -(2.0**54) - 32 <= high


@pytest.mark.parametrize(
    "cuts",
    [
        {"x": (1.5, 3.0)},
        {"x": (0.9, 3.0), "y": (0.9, 3.0)},
        {"z": (6.0, 10.0)},
        {"x": (-0.1, 0.1), "y": (0, 0.9)},
    ],
)
def test_refutes_boxes_off_the_circle(cuts):
    assert contracted(circle_and_line(), **cuts) is None


def test_inequalities_and_functions_cut_as_well():
    builder = SystemBuilder()
    u, v = builder.variable("u", 0, 1), builder.variable("v", 0, 1)
    f = builder.bernstein("f", u, v, np.array([[0.0, 0.0], [0.0, 0.0], [1.0, 1.0]]))  # u^2
    builder.at_least_zero(f - 0.25)
    assert contracted(builder, u=(0.0, 0.45)) is None
    out = contracted(builder, u=(0.5, 0.75))
    assert out is not None
    assert out["f"] == pytest.approx((0.25, 0.5625), abs=1e-6)


# The formulation of real tasks


@pytest.fixture(scope="module")
def upholding_form(upholding):
    return canonical_form(formulate(upholding).system)


def test_keeps_certified_configurations(upholding, upholding_form):
    """A certificate's box holds a true solution, so each side of a contracted box must still meet it."""
    form = upholding_form
    rng = np.random.default_rng(4)
    propagator = Propagator(form)
    found = solve(upholding, candidates=6).configurations
    assert len(found) == 6
    for configuration in found:
        low, high = configuration.certificate.lower, configuration.certificate.upper
        low, high = _extend_box(form, low, high)
        for lower, upper in boxes_around(rng, form, low, high, 500):
            lower, upper = np.minimum(lower, low), np.maximum(upper, high)
            assert propagator.contract(lower, upper)
            assert (lower <= high).all() and (low <= upper).all()


def _extend_box(form: CanonicalForm, low: Array, high: Array) -> tuple[Array, Array]:
    low, high = (np.concatenate([end, np.zeros(form.size - len(end))]) for end in (low, high))
    for k, i, j in form.products:
        corners = np.outer([low[i], high[i]], [low[j], high[j]])
        room = 1e-15 * (1 + np.abs(corners).max())
        low[k], high[k] = corners.min() - room, corners.max() + room
    return low, high


def pythagorean(rng: np.random.Generator) -> tuple[Fraction, Fraction]:
    t = Fraction(int(rng.integers(1, 30)), int(rng.integers(30, 60)))
    return (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)


def rational_rotation(rng: np.random.Generator) -> list[Fraction]:
    """First two columns of a rotation with rational entries, from an integer quaternion."""
    w, x, y, z = (Fraction(int(k)) for k in rng.integers(1, 10, 4) * rng.choice([-1, 1], 4))
    n = w * w + x * x + y * y + z * z
    first = [(w * w + x * x - y * y - z * z) / n, 2 * (x * y + w * z) / n, 2 * (x * z - w * y) / n]
    return [*first, 2 * (x * y - w * z) / n, (w * w - x * x + y * y - z * z) / n, 2 * (y * z + w * x) / n]


def test_keeps_exact_solutions_of_the_grasp_equations(exact, upholding, make_task):
    """One cap on one flat patch has rational solutions; those stay, also where redundant rows round."""
    rng = np.random.default_rng(5)
    task = make_task(("index/tip", upholding.contacts[0].object.region))
    formulation = formulate(task)
    system = formulation.system
    form = canonical_form(system)
    propagator = Propagator(form)
    tried = 0
    while tried < 20:
        x = [Fraction(0)] * system.size
        for cosine, sine in formulation.angle_inputs.values():
            x[cosine], x[sine] = pythagorean(rng)
        for k, value in zip(formulation.rotation_inputs, rational_rotation(rng), strict=True):
            x[k] = value
        for k in formulation.param_inputs:
            x[k] = Fraction(int(rng.integers(0, 65)), 64)
        exact.define(system, x)
        assert all(exact.polynomial(e, x) == 0 for e in system.equations)
        root = extend(form, x)
        low, high = exact.ends(root)
        admissible = all(exact.polynomial(g, x) >= 0 for g in system.inequalities)
        if not admissible or not exact.within(root, form.lower, form.upper):
            continue
        tried += 1
        for lower, upper in boxes_around(rng, form, low, high, 60):
            assert propagator.contract(lower, upper)
            assert exact.within(root, lower, upper)
