"""A system and what presolve makes of it have the same solutions, and the latter is no larger."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from holdfast.geometry import Cap, PointRegion
from holdfast.hands import forward_kinematics
from holdfast.objects import Contact, ObjectRegion, Task
from holdfast.solver.certify.krawczyk import ExistenceTest
from holdfast.solver.contraction.hc4_canonical import Propagator
from holdfast.solver.enclosure.straight_line import StraightLineProgram
from holdfast.solver.formulate.formulate import formulate
from holdfast.solver.polynomial.canonical import CanonicalForm, canonical_form
from holdfast.solver.polynomial.polynomial import Polynomial, total
from holdfast.solver.polynomial.presolve import presolve
from holdfast.solver.polynomial.system import BernsteinFunction, PolynomialSystem, SystemBuilder
from holdfast.solver.search.result import Verdict
from holdfast.solver.tasks.certify import TaskCertifier
from holdfast.solver.tasks.solve import solve

SEEDS = range(20)


def dyadic(rng: np.random.Generator, most: int = 6) -> float:
    return float(rng.integers(-most, most + 1)) / 4.0


# Inputs and definitions that `planted_system` fixes or ties.
INPUTS, DEFINITIONS = {"fixed", "twin", "other"}, {"scaled", "alike", "same", "renamed"}


def planted_system(rng: np.random.Generator, degrees: tuple[int, ...] = (1, 2, 3, 5)) -> PolynomialSystem:
    """Fixed and tied variables of every kind among others, in rows of these degrees."""
    builder = SystemBuilder()
    free = [builder.variable(f"x{i}", -2.0, 2.0) for i in range(4)]
    u, v = builder.variable("u", 0.0, 1.0), builder.variable("v", 0.0, 1.0)
    at = dyadic(rng)
    fixed = builder.variable("fixed", at, at)
    twin = builder.variable("twin", -1.5, 2.0)
    other = builder.variable("other", -2.0, 2.0)
    builder.equate(twin - free[0] * float(rng.choice([1.0, -1.0, 0.5, -2.0])) - dyadic(rng, 2))
    builder.equate(other * 2.0 - dyadic(rng))
    scaled = builder.define("scaled", free[1] * -2.0 + 0.25)
    product = free[0] * free[1] - free[2] * 0.5
    first = builder.define("first", product)
    alike = builder.define("alike", product * -0.5 + 1.0, -4.0, 4.0)
    same = builder.define("same", u + 0.0 * v)
    renamed = builder.define("renamed", u * fixed)
    functions = [
        builder.bernstein(f"f{k}", w, v, rng.integers(-8, 9, (3, 4)) / 4.0) for k, w in enumerate((u, same))
    ]
    known = [*free, u, v, fixed, twin, other, scaled, first, alike, renamed, *functions]

    def random_row(degree: int) -> Polynomial:
        factors = [
            [known[int(i)] for i in rng.integers(0, len(known), int(rng.integers(1, degree + 1)))]
            for _ in range(3)
        ]
        rows = []
        for group in factors:
            term = Polynomial.constant(float(rng.integers(1, 5)))
            for factor in group:
                term = term * factor
            rows.append(term)
        return total(rows) + dyadic(rng)

    for degree in degrees:
        builder.at_least_zero(random_row(degree) + 20.0)
    row = random_row(2)
    builder.imply(row * 0.0)
    builder.at_least_zero(free[3] - twin)
    builder.at_least_zero((free[3] - twin) * 2.0)
    return builder.build()


def contradicts(system: PolynomialSystem) -> bool:
    return any(e.terms == {(): 1.0} for e in system.equations)


def solves(exact, system: PolynomialSystem, x: list[Fraction]) -> bool:
    """Whether the inputs of x, whose definitions are filled in, solve the system."""
    exact.define(system, x)
    rows = (*system.equations, *system.redundant)
    return (
        exact.within(x, system.lower, system.upper)
        and all(exact.polynomial(e, x) == 0 for e in rows)
        and all(exact.polynomial(g, x) >= 0 for g in system.inequalities)
    )


def random_point(system: PolynomialSystem, rng: np.random.Generator) -> list[Fraction]:
    return [
        Fraction(int(rng.integers(0, 9)), 8) * Fraction(float(hi) - float(lo)) + Fraction(float(lo))
        if np.isfinite(lo) and np.isfinite(hi) else Fraction(0)
        for lo, hi in zip(system.lower, system.upper, strict=True)
    ]  # fmt: skip


def used_columns(form: CanonicalForm) -> set[int]:
    return {*form.rows.column.tolist(), *form.products.ravel().tolist(), *form.functions.kij.ravel().tolist()}


@pytest.mark.parametrize("seed", SEEDS)
def test_solutions_stay_and_no_new_ones_come(exact, seed):
    rng = np.random.default_rng(seed)
    system = planted_system(rng)
    presolved = presolve(system)
    assert presolved.names == system.names
    kept = 0
    for _ in range(60):
        x = random_point(presolved, rng)
        holds = solves(exact, presolved, x)
        again = list(x)
        # The inputs of the system are inputs or definitions of the presolved one.
        assert solves(exact, system, again) is holds
        assert not holds or again == x
        kept += holds
    # Of random points of the system itself nearly none keeps its ties; those that do are solutions of both.
    for _ in range(20):
        x = random_point(system, rng)
        holds = solves(exact, system, x)
        again = list(x)
        assert not holds or (solves(exact, presolved, again) and again == x)
    assert not (kept and contradicts(presolved))


def test_the_planted_systems_have_solutions(exact):
    counts = []
    for seed in SEEDS:
        rng = np.random.default_rng(seed)
        presolved = presolve(planted_system(rng))
        counts.append(sum(solves(exact, presolved, random_point(presolved, rng)) for _ in range(60)))
    assert np.count_nonzero(counts) > len(counts) / 2
    assert np.sum(counts) > 60


@pytest.mark.parametrize("degrees", [(1, 2, 2), (1, 2, 3, 5), (4, 5, 5)], ids=str)
@pytest.mark.parametrize("seed", SEEDS)
def test_nothing_grows(seed, degrees):
    system = planted_system(np.random.default_rng(seed), degrees)
    presolved = presolve(system)
    before, after = canonical_form(system), canonical_form(presolved)
    assert len(used_columns(after)) <= len(used_columns(before))
    assert len(after.products) <= len(before.products)
    assert len(presolved.inputs) <= len(system.inputs)
    assert len(presolved.equations) <= len(system.equations) + contradicts(presolved)


@pytest.mark.parametrize("seed", SEEDS)
def test_what_was_planted_is_replaced(seed):
    system = planted_system(np.random.default_rng(seed), (1, 2, 2))
    presolved = presolve(system)
    if contradicts(presolved):
        return
    assert {system.names[i] for i in set(system.inputs) - set(presolved.inputs)} == INPUTS
    assert len(presolved.equations) == len(system.equations) - 2
    assert len(presolved.inequalities) < len(system.inequalities)
    assert not presolved.redundant
    used: set[int] = set()
    for part in (*presolved.definitions.values(), *presolved.equations, *presolved.inequalities):
        used |= {part.i, part.j} if isinstance(part, BernsteinFunction) else part.variables
    assert not {system.names[i] for i in used} & (INPUTS | DEFINITIONS)


@pytest.mark.parametrize("seed", SEEDS)
def test_presolving_twice_is_presolving_once(seed):
    once = presolve(planted_system(np.random.default_rng(seed)))
    twice = presolve(once)
    assert np.array_equal(once.lower, twice.lower) and np.array_equal(once.upper, twice.upper)
    for name in ("equations", "redundant", "inequalities"):
        assert [p.terms for p in getattr(once, name)] == [p.terms for p in getattr(twice, name)]
    assert list(once.definitions) == list(twice.definitions)
    for a, b in zip(once.definitions.values(), twice.definitions.values(), strict=True):
        assert a is b or (isinstance(a, Polynomial) and isinstance(b, Polynomial) and a.terms == b.terms)


def test_enclosures_and_certificates_speak_of_replaced_variables(exact):
    builder = SystemBuilder()
    x, y = builder.variable("x", 0.0, 2.0), builder.variable("y", -2.0, 2.0)
    builder.equate(y + x * 0.5)
    builder.equate(x * x + y * y * 4.0 - 2.0)
    presolved = presolve(builder.build())
    assert (len(presolved.inputs), len(presolved.equations)) == (1, 1)
    proved = ExistenceTest(StraightLineProgram(presolved)).prove(np.array([0.9, 0.0]))
    assert proved is not None
    assert proved.lower[0] <= 1.0 <= proved.upper[0]
    assert proved.lower[1] <= -0.5 <= proved.upper[1]
    assert (proved.upper - proved.lower).max() < 1e-12


def contradictions():
    builder = SystemBuilder()
    x = builder.variable("x", 1.0, 1.0)
    builder.equate(x - 2.0)
    yield "fixed elsewhere", builder
    builder = SystemBuilder()
    x, y = builder.variable("x", 0.0, 1.0), builder.variable("y", 2.0, 3.0)
    builder.equate(x - y)
    yield "equal, but apart", builder
    builder = SystemBuilder()
    x, y = builder.variable("x", 0.5, 0.5), builder.variable("y", 0.25, 0.25)
    builder.at_least_zero(y * 2.0 - x - 2.0**-40)
    yield "an inequality", builder
    builder = SystemBuilder()
    x, y, z = (builder.variable(n, -1.0, 1.0) for n in "xyz")
    builder.equate(x - y)
    builder.equate(y - z)
    builder.equate(x - z - 2.0**-40)
    yield "a chain of equal ones", builder
    builder = SystemBuilder()
    x = builder.variable("x", -1.0, 1.0)
    builder.equate(builder.define("a", x * x) - builder.define("b", x * x * 2.0) * 0.5 - 1e-30)
    yield "definitions alike", builder
    builder = SystemBuilder()
    builder.equate(builder.variable("x", -1.0, 1.0) * 2.0 - 3.0)
    yield "a value out of its interval", builder


@pytest.mark.parametrize(("what", "builder"), list(contradictions()))
def test_contradictory_fixings_are_refuted_at_once(what, builder):
    system = presolve(builder.build())
    form = canonical_form(system)
    assert not Propagator(form).contract(form.lower.copy(), form.upper.copy())
    assert presolve(system) is system
    assert ExistenceTest(StraightLineProgram(system)).prove(np.full(system.size, 0.5)) is None


def test_what_would_have_to_be_rounded_stays():
    builder = SystemBuilder()
    x, y = builder.variable("x", -1.0, 1.0), builder.variable("y", -1.0, 1.0)
    builder.equate(x * 0.1 - y * 0.3)
    builder.define("z", x * 0.1)
    builder.at_least_zero(Polynomial.variable(2) * 0.1)
    system = builder.build()
    presolved = presolve(system)
    assert [e.terms for e in presolved.equations] == [e.terms for e in system.equations]
    assert [g.terms for g in presolved.inequalities] == [{(2,): 0.1}]


def test_redundant_rows_that_are_rounding_alone_are_dropped():
    builder = SystemBuilder()
    x, y = builder.variable("x", 0.5, 1.0), builder.variable("y", 0.5, 1.0)
    builder.equate(x * x + y * y - 1.0)
    builder.imply(x * y * -4.4e-16)  # what is left of two columns of a rotation that are perpendicular
    builder.imply(x * x + y * y - 1.0 + x * y * 4.4e-16)
    system = presolve(builder.build())
    assert len(system.redundant) == 1
    form = canonical_form(system)
    assert Propagator(form).contract(form.lower.copy(), form.upper.copy())


def test_a_fixed_parameter_of_a_bernstein_function_stays():
    builder = SystemBuilder()
    u, v = builder.variable("u", 0.5, 0.5), builder.variable("v", 0.0, 1.0)
    builder.equate(builder.bernstein("f", u, v, np.arange(9.0).reshape(3, 3)) - 3.5)
    presolved = presolve(builder.build())
    assert isinstance(presolved.definitions[2], BernsteinFunction)
    assert presolved.definitions[2].i == 0 and presolved.lower[0] == presolved.upper[0] == 0.5


# Tasks


@pytest.fixture(scope="module")
def with_fixed_joints(upholding: Task) -> Task:
    """The joints of a grasp's thumb and a coupled finger can't move from where they are."""
    state = solve(upholding, candidates=1).configurations[0].state
    limits = upholding.limits.copy()
    for name in ("thumb_base", "thumb_pip", "index_pip"):
        j = upholding.hand.independent_names.index(name)
        limits[j] = state.q[j]
    return replace(upholding, limits=limits)


def test_fixed_joints_are_no_variables(upholding, with_fixed_joints):
    free, fixed = formulate(upholding), formulate(with_fixed_joints)
    names = upholding.hand.independent_names
    gone = {names[j] for j in set(free.angle_inputs) - set(fixed.angle_inputs)}
    assert gone == {"thumb_base", "thumb_pip", "index_pip"}
    assert len(fixed.system.inputs) == len(free.system.inputs) - 6
    assert fixed.system.dimension == free.system.dimension - 3
    assert len(canonical_form(fixed.system).products) < len(canonical_form(free.system).products)


def test_grasps_with_fixed_joints_are_certified_where_they_are(with_fixed_joints):
    result = solve(with_fixed_joints, candidates=3)
    assert result.configurations
    certifier = TaskCertifier(with_fixed_joints)
    limits = with_fixed_joints.limits
    fixed = limits[:, 0] == limits[:, 1]
    for configuration in result.configurations:
        assert configuration.certified
        assert np.array_equal(configuration.state.q[fixed], limits[fixed, 0])
        assert configuration.residual_m < 1e-12
        assert certifier.manifold.is_feasible(configuration.state)


def everything_fixed(base: Task, *, apart_m: float = 0.0) -> Task:
    """A fingertip's cap touches a point of a fixed object, or is apart from it, and nothing can move."""
    region = base.hand.regions["index/tip"]
    cap = region.region
    assert isinstance(cap, Cap)
    q = base.limits.mean(axis=1)
    T = forward_kinematics(base.hand, base.hand.expand(q))[region.link]
    n = T[:3, :3] @ cap.axis
    point = PointRegion(T[:3, :3] @ cap.centre + T[:3, 3] + (cap.radius + apart_m) * n, -n, off_surface=True)
    contact = Contact(region, ObjectRegion("point", point))
    limits = np.column_stack([q, q])
    return replace(base, contacts=(contact,), limits=limits, T_palm_object=np.eye(4))


def test_joints_keep_their_room_where_equations_would_hold_of_numbers_alone(upholding):
    """A grasp in which nothing can move is one up to rounding, which must not speak against it."""
    task = everything_fixed(upholding)
    assert not formulate(task).system.is_overdetermined
    result = solve(task, candidates=1)
    assert result.verdict is Verdict.SOLVED
    assert solve(everything_fixed(upholding, apart_m=1e-6), candidates=1).verdict is Verdict.INFEASIBLE
    state = solve(upholding, candidates=1).configurations[0].state
    limits = np.column_stack([state.q, state.q])
    still = replace(upholding, limits=limits, T_palm_object=state.T_palm_object)
    assert solve(still, candidates=1).verdict is Verdict.SOLVED
    assert not formulate(replace(upholding, limits=limits)).angle_inputs


def test_what_counts_as_overdetermined():
    builder = SystemBuilder()
    x, y, z = (builder.variable(n, -1.0, 1.0) for n in "xyz")
    square = builder.define("square", x * x)
    builder.equate(square - 0.25)
    assert not builder.build().is_overdetermined
    builder.equate(x * square - 0.125)
    assert builder.build().is_overdetermined, "two equations in x, though y and z are free"
    builder.equations.pop()
    builder.equate(y * x + z)
    builder.equate(z * y - square)
    assert not builder.build().is_overdetermined
    builder.equate(Polynomial.constant(1e-17))
    assert builder.build().is_overdetermined


def test_the_systems_of_tasks_are_presolved(upholding):
    system = formulate(upholding).system
    again = presolve(system)
    for name in ("equations", "redundant", "inequalities"):
        assert [p.terms for p in getattr(again, name)] == [p.terms for p in getattr(system, name)]
    assert len(canonical_form(again).products) == len(canonical_form(system).products)
