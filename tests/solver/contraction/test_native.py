"""Contraction of polynomial systems never loses a root, and encloses values, slopes and curvatures."""

from fractions import Fraction
from itertools import cycle, product

import numpy as np
import pytest
from holdfast.base.numeric.linalg import square_inverse
from holdfast.solver.certify.interval_newton import Certifier
from holdfast.solver.contraction.hc4_native import hc4
from holdfast.solver.contraction.native import CERTIFIED, EMPTY, _newton, contract_native
from holdfast.solver.contraction.shave import shave
from holdfast.solver.enclosure.native import NativeSystem
from holdfast.solver.enclosure.slopes import Expansion, centre_slopes, curvatures, values_and_slopes
from holdfast.solver.interval.roots import root_interval
from holdfast.solver.linear.vertices import contract_by_vertices
from holdfast.solver.polynomial.exact import ExactPolynomial, enclose_fraction, evaluate
from hypothesis import example, given, settings
from hypothesis import strategies as st

Array = np.ndarray
Monomial = tuple[tuple[int, int], ...]
often = settings(max_examples=300, deadline=None, derandomize=True)


def random_monomial(rng: np.random.Generator, n: int, degree: int) -> Monomial:
    exponents: dict[int, int] = {}
    for v in rng.integers(0, n, int(rng.integers(1, degree + 1))):
        exponents[int(v)] = exponents.get(int(v), 0) + 1
    return tuple(sorted(exponents.items()))


def random_fraction(rng: np.random.Generator, largest: int = 30) -> Fraction:
    return Fraction(int(rng.integers(-largest, largest + 1)), int(rng.integers(1, 12)))


def random_polynomial(rng: np.random.Generator, n: int, degree: int) -> ExactPolynomial:
    out: ExactPolynomial = {}
    for _ in range(int(rng.integers(1, 6))):
        out[random_monomial(rng, n, degree)] = random_fraction(rng) or Fraction(1)
    return out


def planted_system(rng: np.random.Generator) -> tuple[list[ExactPolynomial], list[Fraction]]:
    """Equations of degree 1 to 6 in 1 to 6 unknowns that all vanish at one rational point."""
    n = int(rng.integers(1, 7))
    m = max(1, n + int(rng.integers(-2, 2)))
    x = [random_fraction(rng, 9) * int(rng.integers(0, 5) > 0) for _ in range(n)]
    degree = int(rng.integers(1, 7))
    out = []
    for _ in range(m):
        equation = random_polynomial(rng, n, degree)
        rest = evaluate(equation, x)
        out.append({**equation, **({(): -rest} if rest else {})})
    assert all(evaluate(e, x) == 0 for e in out)
    return out, x


def box_around(rng: np.random.Generator, low: Array, high: Array) -> tuple[Array, Array]:
    """A box that holds [low, high]: from a point to a billion, with sides on the root itself."""
    n = len(low)
    size = 10.0 ** rng.uniform(-17, rng.choice([1.0, 3.0, 9.0]), (2, n)) * 10.0 ** rng.uniform(-3, 0)
    if rng.uniform() < 0.3:
        size = 2.0 ** np.floor(np.log2(size))  # so that slices end on simple numbers
    size *= rng.uniform(size=(2, n)) < rng.uniform(0.3, 1.0)
    return low - size[0], high + size[1]


KERNELS = 5


def apply(kernel: int, certifier: Certifier, lower: Array, upper: Array) -> bool:
    """Contracts in place; False where the box was found empty."""
    s, n = certifier.system, len(lower)
    if kernel == 0:
        return bool(hc4(s, lower, upper, 0.1, 30))
    if kernel == 1:
        return bool(_newton(s, lower, upper, certifier.workspace) != EMPTY)
    if kernel == 2:
        return bool(shave(s, lower, upper, np.arange(n), 8, 0.1, np.zeros(n), np.zeros(n)))
    if kernel == 3:
        return bool(contract_by_vertices(certifier.program, lower, upper, 0.02))
    return bool(contract_native(s, certifier.program, lower, upper, certifier.workspace, 4) != EMPTY)


def contract_many(systems: int, boxes_each: int, seed: int, exact, keeping) -> None:
    rng = np.random.default_rng(seed)
    for _ in range(systems):
        equations, x = planted_system(rng)
        certifier = Certifier(equations, len(x))
        kernels = cycle(range(KERNELS))
        low, high = exact.ends(x)
        boxes = (box_around(rng, low, high) for _ in range(boxes_each))
        keeping.check(x, boxes, lambda lo, hi, c=certifier, k=kernels: apply(next(k), c, lo, hi))


@pytest.mark.parametrize("systems", [70, pytest.param(350, marks=pytest.mark.slow)])
def test_never_loses_a_planted_root(systems, exact, keeping):
    contract_many(systems, 160, 0, exact, keeping)
    assert keeping.count >= 142 * systems
    assert keeping.narrowed > 0.2 * keeping.count  # else nothing was tried


@pytest.mark.slow
def test_never_loses_a_planted_root_in_a_million_boxes(exact, keeping):
    contract_many(8000, 128, 1, exact, keeping)
    assert keeping.count >= 1_000_000


def test_keeps_its_root_where_floats_overflow(exact):
    """Degree 60 over a billion is far beyond all floats, and so are quotients by what is next to zero."""
    rng = np.random.default_rng(2)
    for _ in range(400):
        n = int(rng.integers(1, 4))
        x = [random_fraction(rng, 4) for _ in range(n)]
        equations = []
        for _ in range(n):
            equation = random_polynomial(rng, n, 60)
            scale = Fraction(10) ** int(rng.integers(-400, 401))
            rest = evaluate(equation, x)
            equations.append({m: c * scale for m, c in {**equation, **({(): -rest} if rest else {})}.items()})
        certifier = Certifier(equations, n)
        low, high = exact.ends(x)
        for kernel in range(KERNELS):
            size = 10.0 ** rng.uniform(-300, 9.5, (2, n))
            lower, upper = low - size[0], high + size[1]
            with np.errstate(all="ignore"):
                assert apply(kernel, certifier, lower, upper)
            assert exact.within(x, lower, upper)


def derivative(p: ExactPolynomial, k: int) -> ExactPolynomial:
    out: ExactPolynomial = {}
    for monomial, c in p.items():
        exponents = dict(monomial)
        if k in exponents:
            e = exponents[k]
            exponents[k] -= 1
            key = tuple((v, f) for v, f in sorted(exponents.items()) if f)
            out[key] = out.get(key, Fraction(0)) + e * c
    return out


def holds(low: float, high: float, value: Fraction) -> bool:
    return (low == -np.inf or (np.isfinite(low) and Fraction(float(low)) <= value)) and (
        high == np.inf or (np.isfinite(high) and value <= Fraction(float(high)))
    )


def unpacked(system: NativeSystem, flat: Array, m: int, n: int) -> Array:
    """Lower and upper ends (2, m, n, n) of all second derivatives, those that are always zero included."""
    H = np.zeros((2, m, n, n))
    for p, (i, j) in enumerate(system.pair):
        for c in range(system.pair_start[p], system.pair_start[p + 1]):
            H[:, system.pair_user[c], i, j] = H[:, system.pair_user[c], j, i] = flat[:, c]
    return H


def test_values_slopes_and_curvatures_are_enclosed():
    rng = np.random.default_rng(3)
    for trial in range(150):
        n = int(rng.integers(1, 5))
        degree = 60 if trial % 5 == 0 else int(rng.integers(1, 7))
        equations = [random_polynomial(rng, n, degree) for _ in range(2)]
        certifier = Certifier(equations, n)
        system = certifier.system
        f, J, flat = np.zeros((2, 2)), np.zeros((2, 2, n)), np.zeros((2, len(system.pair_user)))
        J0, K = np.zeros((2, 2, n)), np.zeros((2, 2, n))
        lower = rng.normal(size=n) * 10.0 ** rng.uniform(-3, 9 if trial % 3 == 0 else 1, n)
        upper = lower + 10.0 ** rng.uniform(-12, 9 if trial % 3 == 0 else 1, n) * (rng.uniform(size=n) < 0.9)
        middle = 0.5 * (lower + upper)
        values_and_slopes(system, middle, middle, *f, *J0)
        values_and_slopes(system, lower, upper, *f, *J)
        curvatures(system, lower, upper, *flat)
        K[:] = J
        centre_slopes(system, middle, lower, upper, Expansion(*f, *J0, *K, *flat))
        H = unpacked(system, flat, 2, n)
        assert not np.isnan([*f.ravel(), *J.ravel(), *H.ravel(), *K.ravel()]).any()
        ends = list(zip(map(Fraction, lower.tolist()), map(Fraction, upper.tolist()), strict=True))
        for _ in range(4):
            x = [a + (b - a) * Fraction(int(rng.integers(0, 9)), 8) for a, b in ends]
            for e, p in enumerate(equations):
                assert holds(f[0, e], f[1, e], evaluate(p, x))
                for i in range(n):
                    slope = evaluate(derivative(p, i), x)
                    assert holds(J[0, e, i], J[1, e, i], slope)
                    assert holds(K[0, e, i], K[1, e, i], slope)
                    for j in range(n):
                        half = evaluate(derivative(derivative(p, i), j), x) / 2
                        assert holds(H[0, e, i, j], H[1, e, i, j], half)


def grid_system(rng: np.random.Generator, n: int) -> tuple[list[ExactPolynomial], list[list[Fraction]]]:
    """A system all of whose zeros are known: polynomials in one unknown each, mixed by a regular matrix."""
    factors, roots = [], []
    for k in range(n):
        values = sorted({random_fraction(rng, 12) for _ in range(int(rng.integers(1, 4)))})
        p: ExactPolynomial = {(): Fraction(1)}
        for r in values:
            q: ExactPolynomial = {}
            for m, c in p.items():
                raised = ((k, (m[0][1] if m else 0) + 1),)
                q[raised] = q.get(raised, Fraction(0)) + c
                q[m] = q.get(m, Fraction(0)) - r * c
            p = q
        factors.append(p)
        roots.append(values)
    while True:
        matrix = rng.integers(-3, 4, (n, n))
        if abs(np.linalg.det(matrix)) > 0.5:
            break
    equations = []
    for row in matrix:
        mixed: ExactPolynomial = {}
        for weight, p in zip(row.tolist(), factors, strict=True):
            for m, c in p.items():
                mixed[m] = mixed.get(m, Fraction(0)) + weight * c
        equations.append({m: c for m, c in mixed.items() if c})
    return equations, [list(point) for point in product(*roots)]


def test_certified_means_exactly_one_root(exact):
    rng = np.random.default_rng(4)
    certified = refuted = 0
    for _ in range(150):
        n = int(rng.integers(1, 4))
        equations, roots = grid_system(rng, n)
        certifier = Certifier(equations, n)
        for _ in range(40):
            root = roots[int(rng.integers(len(roots)))]
            at = np.array([float(v) for v in root]) + rng.normal(size=n) * 10.0 ** rng.uniform(-6, 1)
            size = 10.0 ** rng.uniform(-6, 1, (2, n))
            before = at - size[0], at + size[1]
            lower, upper = before[0].copy(), before[1].copy()
            held = [x for x in roots if exact.within(x, *before)]
            status = contract_native(
                certifier.system, certifier.program, lower, upper, certifier.workspace, 4
            )
            if status == EMPTY:
                assert not held
                refuted += 1
                continue
            assert all(exact.within(x, lower, upper) for x in held)
            if status == CERTIFIED:
                assert len(held) == 1
                certified += 1
            succeeded, part = certifier.test(0.5 * (before[0] + before[1]), before)
            assert all(exact.within(x, *part) for x in held)
            assert not succeeded or len(held) == 1
    assert certified > 300 and refuted > 300


def test_the_widest_unique_box_holds_one_root_and_refining_keeps_it(exact):
    rng = np.random.default_rng(5)
    for _ in range(60):
        n = int(rng.integers(1, 4))
        equations, roots = grid_system(rng, n)
        certifier = Certifier(equations, n)
        root = roots[int(rng.integers(len(roots)))]
        box = certifier.widest_unique(np.array([float(v) for v in root]), np.full(n, 100.0))
        assert box is not None
        assert [x for x in roots if exact.within(x, *box)] == [root]
        place = certifier.refine(box, np.full(n, 100.0))
        assert exact.within(root, *place)
        assert np.all(place[1] - place[0] <= 1e-15 * (1.0 + np.abs(place[0])))


sizes = st.one_of(
    st.sampled_from([0.0, 5e-324, 1e-320, 2.3e-308, 1e-30, 0.5, 1.0, 2.0, 27.0, 1e30, 1e308, np.inf]),
    st.floats(0, 100),
)
ends = st.tuples(sizes, st.sampled_from([-1.0, 1.0])).map(lambda pair: pair[0] * pair[1])


@often
@given(ends, ends, st.integers(1, 60), st.floats(-40, 40), st.floats(0, 20))
@example(5e-324, 5e-324, 2, -1.0, 2.0)
@example(-5e-324, 5e-324, 59, -1.0, 2.0)
@example(1.0, 1.0, 2, -1.0, 0.0)
@example(4.0, 4.0, 2, -2.0, 4.0)
@example(-8.0, -8.0, 3, -2.0, 0.0)
def test_roots_keep_every_point_whose_power_fits(a, b, n, start, width):
    al, au = min(a, b), max(a, b)
    if al == np.inf or au == -np.inf:
        return
    xl, xu = start, start + width
    lo, hi = root_interval(al, au, n, xl, xu)
    for k in range(9):
        x = Fraction(xl) + (Fraction(xu) - Fraction(xl)) * Fraction(k, 8)
        if holds(al, au, x**n):
            assert Fraction(lo) <= x <= Fraction(hi)
    for x in (lo, hi) if lo <= hi else ():
        assert xl <= x <= xu


@often
@given(st.fractions(), st.integers(-400, 400))
@example(Fraction(1), 400)
@example(Fraction(-1), 309)
@example(Fraction(1, 3), -330)
def test_enclosing_fractions(value, exponent):
    exact_value = value * Fraction(10) ** exponent
    low, high = enclose_fraction(exact_value)
    assert holds(low, high, exact_value)
    with np.errstate(over="ignore"):
        assert low == high or high == np.nextafter(low, np.inf)


def test_an_inverse_beyond_all_floats_is_refused():
    rows, columns, Y = np.zeros(2, dtype=np.int64), np.zeros(2, dtype=np.int64), np.zeros((2, 2))
    for bad in (np.inf, np.nan):
        J = np.array([[1.0, bad], [0.0, 1.0]])
        assert not square_inverse(J, np.ones(2), rows, columns, Y) or np.isfinite(Y).all()
    assert not square_inverse(np.array([[1.0, 1.0], [1.0, 1.0]]), np.ones(2), rows, columns, Y)
    assert square_inverse(np.array([[0.0, 2.0], [4.0, 0.0]]), np.ones(2), rows, columns, Y)
    assert np.allclose(Y @ np.array([[0.0, 2.0], [4.0, 0.0]])[:, columns], np.eye(2))
