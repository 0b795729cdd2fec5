"""Every solution in the box once, none outside of it, and no verdict that is not proved."""

import json
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from holdfast.errors import InputError
from holdfast.solver import SystemResult, Verdict, solve_system
from holdfast.solver.systems.file import system_from_data

COMPLETE, INFEASIBLE, UNDECIDED = Verdict.COMPLETE, Verdict.INFEASIBLE, Verdict.UNDECIDED


def solve_text(variables: dict[str, list[float]], equations: Sequence[str], **options: Any) -> SystemResult:
    problem = system_from_data({"variables": variables, "equations": list(equations)}, "test")
    return solve_system(problem.equations, problem.lower, problem.upper, **options)


def assert_solutions(result: SystemResult, points: Sequence[Sequence[float]], exact) -> None:
    """Complete, with exactly these points, each within the radius of one box and of no other."""
    assert result.verdict is (COMPLETE if points else INFEASIBLE)
    assert len(result.solutions) == len(points) and result.remaining == ()
    for point in points:
        near = [s for s in result.solutions if np.all(np.abs(s.middle - point) <= s.radius + 1e-12)]
        assert len(near) == 1 and near[0].certified
        assert near[0].radius < 1e-12 * (1.0 + np.abs(point).max())
        if all(isinstance(v, Fraction) for v in point):
            assert exact.within(point, near[0].lower, near[0].upper)


ROOT2, ROOT3 = 2**0.5, 3**0.5
UNIT = [-1.0, 1.0]


@pytest.mark.parametrize(
    ("variables", "equations", "points"),
    [
        # In the middle, in plain view.
        ({"x": [-2, 2], "y": [-2, 2]}, ["x**2 + y**2 - 1", "x*y"], [(1, 0), (-1, 0), (0, 1), (0, -1)]),
        ({"x": [-3, 2]}, ["x**3 - 2*x"], [(-ROOT2,), (0,), (ROOT2,)]),
        # On the rim of the box: in it.
        ({"x": [0, 1]}, ["x*(x - 1)"], [(0,), (1,)]),
        ({"x": [0, 0.3]}, ["10*x - 3"], [(0.3,)]),
        ({"x": [0.1, 2]}, ["(10*x - 1)*(x - 2)*(x - 3)"], [(0.1,), (2,)]),
        ({"x": [0, 5], "y": [-2, 2]}, ["x**2 + x", "y**2 - 2"], [(0, -ROOT2), (0, ROOT2)]),
        ({"x": [0, 1], "y": [0, 1]}, ["x*(x - 1)", "y*(y - 1)"], [(0, 0), (0, 1), (1, 0), (1, 1)]),
        ({"x": [-0.5, 0], "y": [-2, 2], "z": [0, 2]}, ["x*(y-z)", "y*y - 2 + x", "z**2 - 3"],
         [(0, -ROOT2, ROOT3), (0, ROOT2, ROOT3)]),
        ({"c": [0, 1], "s": UNIT}, ["c**2 + s**2 - 1", "3*c - 1 - s"], [(0, -1), (0.6, 0.8)]),
        # Just outside, by a hair: not in it.
        ({"x": [1e-9, 1]}, ["x*(x - 0.5)"], [(0.5,)]),
        ({"x": [5e-324, 1]}, ["x*(x - 0.5)"], [(0.5,)]),
        ({"x": [0, 0.33333333333333331]}, ["3*x - 1"], []),
        ({"x": [0.333333333333333331, 1]}, ["3*x - 1"], [(1 / 3,)]),
        ({"x": [0, 1.414213562373094]}, ["x**2 - 2"], []),
        ({"x": [0, 1.414213562373096]}, ["x**2 - 2"], [(ROOT2,)]),
        # Intervals that are points.
        ({"x": [1, 1]}, ["x - 1"], [(1,)]),
        ({"x": [1, 1]}, ["x - 2"], []),
        ({"x": [0.1, 0.1]}, ["10*x - 1"], [(0.1,)]),
        ({"x": [1, 1], "y": [0, 2]}, ["x - 1", "y**2 - 2*x"], [(1, ROOT2)]),
        ({"x": [3, 3], "y": [0, 2]}, ["y**2 - x"], [(3, ROOT3)]),
        ({"x": [3, 3], "y": [0, 1]}, ["y**2 - x"], []),
        # Constants, and more equations than unknowns.
        ({"x": UNIT}, ["1"], []),
        ({"x": UNIT, "y": UNIT}, ["x - y", "1e-300"], []),
        ({"x": UNIT}, ["x - 0.5", "x + 0.5"], []),
        ({"x": [-2, 2], "y": [-2, 2]}, ["x**2+y**2-1", "(x-1)**2+y**2-1", "(x+1)**2+y**2-1"], []),
        # Nothing real, or nothing at all.
        ({"x": [-1e9, 1e9]}, ["x**2 + 1"], []),
        ({"x": [-9, 9], "y": [-9, 9]}, ["x**2 + y**2 - 1", "x + y - 2"], []),
        # Far out, and of high degree: powers overflow.
        ({"x": [-1e9, 1e9]}, ["x**60 - 1"], [(-1,), (1,)]),
        ({"x": [-1e9, 1e9], "y": [-1e9, 1e9]}, ["x**30*y**30 - 1", "x - y"], [(-1, -1), (1, 1)]),
        ({"x": [-1e9, 1e9]}, ["1e300*x**2 - 4e300"], [(-2,), (2,)]),
        ({"x": [-1e9, 1e9]}, ["1e-300*x**2 - 4e-300"], [(-2,), (2,)]),
        ({"x": [-1e9, 1e9]}, ["x - 999999999"], [(999999999,)]),
        # Close together.
        ({"x": [0, 2]}, ["(x - 1)*(x - 1.00001)"], [(1,), (1.00001,)]),
        ({"x": [0, 11]}, ["*".join(f"(x - {k})" for k in range(1, 11))], [(k,) for k in range(1, 11)]),
        # Multiple roots of one unknown are roots, and its equations are one.
        ({"x": UNIT}, ["x**2"], [(0,)]),
        ({"x": [0, 1]}, ["x**2"], [(0,)]),
        ({"x": [-1, 3]}, ["(x - 1)**3"], [(1,)]),
        ({"x": [-1, 3]}, ["x**2*(x - 2)"], [(0,), (2,)]),
        ({"x": UNIT}, ["x - 0.5", "2*x - 1"], [(0.5,)]),
        ({"x": [-3, 3]}, ["(x**2 - 2)*(x - 1)", "(x**2 - 2)*(x + 1)**2"], [(-ROOT2,), (ROOT2,)]),
        ({"x": [0, 30]}, ["*".join(f"(x - {k})" for k in range(1, 21))], [(k,) for k in range(1, 21)]),
        ({"x": [0, 1.4142135623730951]}, ["x**2 - 2"], [(ROOT2,)]),
        ({"x": [0, 1.414213562373095]}, ["x**2 - 2"], []),
        # Factors of products are taken one at a time; points that several share are one.
        ({"x": UNIT, "y": UNIT}, ["x*(x - y)", "y*(x + y)"], [(0, 0)]),
        ({"x": [-3, 3], "y": [-3, 3]}, ["(x - 1)**2*(x + 1)", "x*y - 1"], [(-1, -1), (1, 1)]),
        ({"x": [-3, 3], "y": [-3, 3]}, ["(x - 1)*(x - 2)*(y - x)", "(y - 3)*(x + y - 1)"],
         [(1, 3), (1, 0), (2, 3), (2, -1), (3, 3), (0.5, 0.5)]),
        ({"x": [-3, 3], "y": [-3, 3]}, ["(x**2 - 2)*(x**2 + 1)", "(y - x)**2*(y + x - 9)"],
         [(-ROOT2, -ROOT2), (ROOT2, ROOT2)]),
        # Together, equations have a multiple root of one unknown.
        ({"x": UNIT, "y": UNIT}, ["x**2 - y", "y"], [(0, 0)]),
        ({"x": [-1, 3], "y": UNIT}, ["x**3 - 2*x**2 + y", "y"], [(0, 0), (2, 0)]),
        ({"x": [-3, 3], "y": [-3, 3]}, ["x**3 - 3*x**2 + y**2 - 1", "y**2 - x**2 - 1"],
         [(0, -1), (0, 1), (2, -5**0.5), (2, 5**0.5)]),
        # Keywords of a programming language are names like any other.
        ({"lambda": [0, 3], "_1": UNIT}, ["lambda**2 - 2", "_1 - lambda/2"], [(ROOT2, ROOT2 / 2)]),
    ],
)  # fmt: skip
def test_known_answers(variables, equations, points, exact):
    assert_solutions(solve_text(variables, equations), points, exact)


@pytest.mark.parametrize(
    ("variables", "equations", "point"),
    [
        ({"x": UNIT, "y": UNIT}, ["x**2 - y", "y + y**3"], (0, 0)),
        ({"x": [-2, 2], "y": [-2, 2]}, ["x**2 + y**2 - 1", "y - 1"], (0, 1)),
        ({"x": UNIT, "y": UNIT}, ["x*y", "x*(y - 0.5)"], (0, 0.7)),
        ({"x": UNIT, "y": UNIT, "z": UNIT}, ["x*y", "x*z", "y*z"], (0, 0, 0.3)),
        ({"x": UNIT, "y": UNIT}, ["x - y", "2*y - 2*x"], (0.4, 0.4)),
        # Consistent, with more equations than unknowns.
        ({"x": [-2, 2], "y": [-2, 2]}, ["x - 1", "x**2 + y**2 - 1", "y"], (1, 0)),
        ({"x": UNIT, "y": UNIT}, ["x - y", "x + y - 1", "2*x**2 - y"], (0.5, 0.5)),
        # Factors that vanish together, along a line and beside it.
        ({"x": UNIT, "y": UNIT}, ["x*(x - y)", "x*(x - 2*y)"], (0, 0.3)),
        # Fewer equations, and nothing that can be proved to be there.
        ({"x": UNIT, "y": UNIT}, ["x**2 + y**2"], (0, 0)),
    ],
)  # fmt: skip
def test_what_cannot_be_proved_is_undecided_and_kept(variables, equations, point):
    result = solve_text(variables, equations, budget_s=20.0)
    assert result.verdict is UNDECIDED
    kept = [*result.remaining, *((s.lower, s.upper) for s in result.solutions)]
    assert any(np.all(low - 1e-12 <= point) and np.all(point <= high + 1e-12) for low, high in kept)
    assert not any(s.certified for s in result.solutions)


def test_a_simple_root_beside_a_double_one_is_certified():
    result = solve_text({"x": [-1, 3], "y": [-1, 1]}, ["x**3 - 2*x**2 + y", "y + y**3"])
    assert result.verdict is UNDECIDED
    assert [s.middle[0] for s in result.solutions] == pytest.approx([2.0])
    assert any(low[0] <= 0 <= high[0] for low, high in result.remaining)


@pytest.mark.parametrize(
    ("variables", "equations"),
    [
        # x = -1 exactly, but that takes all three equations.
        ({"x": [-1, -0.5], "y": [0, 2], "z": [0, 2]}, ["x*(y-z)", "y*y - 2 + x", "z**2 - 3"]),
        # 5e-17 beside the root: closer than floats are to each other.
        ({"x": [0, 1.4142135623730951], "y": [1, 3]}, ["x**2 - y", "y - 2"]),
        ({"x": [0, 1.414213562373095], "y": [1, 3]}, ["x**2 - y", "y - 2"]),
    ],
)
def test_a_rim_that_cannot_be_told_is_undecided(variables, equations):
    result = solve_text(variables, equations)
    assert result.verdict is UNDECIDED
    assert result.solutions == () and len(result.remaining) == 1


def random_roots(rng: np.random.Generator) -> list[Fraction]:
    return sorted({Fraction(int(rng.integers(-12, 13)), int(rng.integers(1, 5))) for _ in range(3)})


def test_exactly_the_roots_in_the_closed_box(exact):
    """Random grids of rational roots, in boxes whose sides often stand on a root or a hair beside it."""
    rng = np.random.default_rng(0)
    on_rim = 0
    for _ in range(150):
        n = int(rng.integers(1, 3))
        roots = [random_roots(rng) for _ in range(n)]
        names = "xy"[:n]
        factors = ["*".join(f"({name} - ({r}))" for r in rs) for name, rs in zip(names, roots, strict=True)]
        mixed = factors if n == 1 else [f"{factors[0]} + {factors[1]}", f"{factors[0]} - 2*{factors[1]}"]
        problem = system_from_data(
            {"variables": {name: [-1, 1] for name in names}, "equations": mixed}, "test"
        )
        lower, upper = [], []
        for rs in roots:
            sides = []
            for _ in range(2):
                base = rs[int(rng.integers(len(rs)))] if rng.uniform() < 0.7 else Fraction(rng.normal() * 4)
                hair = Fraction(int(rng.integers(-1, 2)), 10 ** int(rng.integers(3, 25)))
                sides.append(base + hair * int(rng.uniform() < 0.4))
            if n > 1 and sides[0] == sides[1]:  # would leave more equations than unknowns
                sides[1] += 1
            lower.append(min(sides))
            upper.append(max(sides))
        wanted = [
            point
            for point in np.array(np.meshgrid(*roots, indexing="ij"), dtype=object).reshape(n, -1).T.tolist()
            if all(a <= v <= b for a, v, b in zip(lower, point, upper, strict=True))
        ]
        on_rim += any(v in (a, b) for p in wanted for a, v, b in zip(lower, p, upper, strict=True))
        assert_solutions(solve_system(problem.equations, lower, upper), wanted, exact)
    assert on_rim > 40


def test_unknowns_that_occur_nowhere_are_covered():
    result = solve_text({"x": [0, 2], "y": [0, 0.1], "z": [0, 0.1]}, ["x**2 - 2"])
    assert result.covers and result.verdict is COMPLETE
    assert all(s.certified for s in result.solutions)
    assert min(s.lower[1] for s in result.solutions) == 0 and max(s.upper[2] for s in result.solutions) >= 0.1


def test_equations_in_one_unknown_count_as_one():
    result = solve_text({"x": UNIT, "y": UNIT}, ["3*x - 1", "(x - 1/3)*(x + 5)"])
    assert result.covers and result.verdict is COMPLETE and all(s.certified for s in result.solutions)
    assert max(s.radius for s in result.solutions) <= 0.05
    assert all(abs(s.middle[0] - 1 / 3) < 1e-15 for s in result.solutions)


def test_a_point_on_a_line_of_another_factor_counts_as_undecided():
    result = solve_text({"x": UNIT, "y": UNIT}, ["x*y", "x*(y - 0.5)"], budget_s=5.0)
    assert result.verdict is UNDECIDED and result.solutions == ()
    result = solve_text({"x": UNIT, "y": UNIT}, ["x*(x - y)", "x*(x + y - 0.5)"], budget_s=5.0)
    (apart,) = result.solutions
    assert apart.middle == pytest.approx([0.25, 0.25]) and result.verdict is UNDECIDED


def test_no_equation_left_leaves_the_whole_box():
    result = solve_text({"x": [1, 1], "y": [0, 2]}, ["x - 1"])
    assert result.covers and result.verdict is COMPLETE
    (box,) = result.solutions
    assert box.lower.tolist() == [1, 0] and box.upper.tolist() == [1, 2]


def test_a_curve_is_covered():
    result = solve_text({"x": [-2, 2], "y": [-2, 2]}, ["x**2 + y**2 - 1"])
    assert result.covers and result.verdict is COMPLETE and result.remaining == ()
    for angle in np.linspace(0, 2 * np.pi, 500):
        at = np.array([np.cos(angle), np.sin(angle)])
        assert any(np.all(s.lower - 1e-12 <= at) and np.all(at <= s.upper + 1e-12) for s in result.solutions)
    assert max(np.max(s.upper - s.lower) for s in result.solutions) <= result.sigma == 0.05
    certified = [s for s in result.solutions if s.certified]
    assert len(certified) > 0.8 * len(result.solutions)
    for s in certified:  # a circle that meets a box has corners of the box, or tangent points, on both sides
        far = np.hypot(*np.maximum(np.abs(s.lower), np.abs(s.upper)))
        near = np.hypot(
            *np.where((s.lower <= 0) & (s.upper >= 0), 0, np.minimum(np.abs(s.lower), np.abs(s.upper)))
        )
        assert near <= 1.0 + 1e-12 and far >= 1.0 - 1e-12


def test_sigma_sets_the_size_of_a_cover():
    coarse, fine = (solve_text({"x": UNIT, "y": UNIT}, ["x*y - 0.1"], sigma=s) for s in (0.3, 0.02))
    assert coarse.sigma == 0.3 and len(coarse.solutions) < len(fine.solutions)
    assert all(np.all(s.upper - s.lower <= 0.02) for s in fine.solutions)


@pytest.mark.parametrize("sigma", [1e-300, 1e-12, 0.01])
def test_sigma_changes_no_simple_answer(sigma, exact):
    points = [(-ROOT2, 2.0), (ROOT2, 2.0)]
    result = solve_text({"x": [-3, 3], "y": [-3, 3]}, ["x**2 - y", "y - 2"], sigma=sigma)
    assert_solutions(result, points, exact)


def test_a_tiny_sigma_ends():
    """Boxes that floats can't split are not split; a double root, which keeps many, is kept with them."""
    result = solve_text(
        {"x": [-1e9, 1e9], "y": [-1, 1]}, ["x**2 - 6*x + 9 + y", "y + y**3"], sigma=1e-300, budget_s=1.0
    )
    assert result.verdict is UNDECIDED
    assert any(low[0] <= 3 <= high[0] for low, high in result.remaining)
    far = solve_text(
        {"x": [999999998, 1e9], "y": [0, 1]}, ["x - 999999999 + y", "x - 999999999 - y"], sigma=1e-300
    )
    assert far.verdict is COMPLETE and len(far.solutions) == 1


def test_a_sigma_wider_than_the_box_splits_nothing():
    result = solve_text({"x": [-3, 3], "y": [-3, 3]}, ["x**2 - y", "y - 2"], sigma=1e6)
    assert result.verdict is UNDECIDED and result.boxes == 1


def test_a_budget_that_is_spent_leaves_the_rest_undecided():
    names = [f"x{k}" for k in range(6)]
    equations = [
        f"{a}**3 - 2*{b}*{c} + 0.3"
        for a, b, c in zip(names, names[1:] + names, names[2:] + names, strict=False)
    ]
    result = solve_text({name: [-5, 5] for name in names}, equations, budget_s=1e-9)
    assert result.verdict is UNDECIDED and len(result.remaining) >= 1 and result.boxes == 1


def test_it_stops_when_told_and_says_where_it_stands():
    steps = []
    result = solve_text(
        {"x": [-2, 2], "y": [-2, 2]},
        ["x**2 + y**2 - 1"],
        on_progress=steps.append,
        should_stop=lambda: len(steps) >= 5,
    )
    assert result.verdict is UNDECIDED and result.boxes == len(steps) == 5
    assert [step.boxes for step in steps] == [1, 2, 3, 4, 5]
    assert steps[-1].open == len(result.remaining)


@pytest.mark.parametrize(
    ("lower", "upper"), [([0.0], [np.inf]), ([np.nan], [1.0]), ([1.0], [0.0]), ([0.0, 0.0], [1.0])]
)
def test_a_box_that_is_none_is_refused(lower, upper):
    with pytest.raises(InputError):
        solve_system([{((0, 1),): Fraction(1)}], np.array(lower), np.array(upper))


# The published systems --------------------------------------------------------------------------------------

QUICK = [
    "circle_hyperbola",
    "trilateration",
    "mickey",
    "rediff3",
    "noon3",
    "lorentz",
    "chandra4",
    "trinks",
    "brown5",
    "cyclohexane3D_emiris",
    "rpr3_6real",
    "puma",
    "puma_4real",
    "geneig",
    "noon4",
    "cyclic5",
    "boon",
    "wright",
    "caprasse",
    "eco6",
    "eco7",
    "s9_1",
    "tangents0",
    "kin1",
    "katsura5",
    "broydentri10",
    "sa_finger_point",
    "bezier_foot",
    "rpr3_inf_a",
    "rpr3_inf_b",
    "puma_inf_b",
    "kinema_inf",
    "conform1",
    "k4_plane_inf",
    "k5_space_inf",
    "fourbar_inf",
    "sa_finger_inf",
    "bezier_inf",
    "fourbar_curve",
    "viviani",
    "bezier_curve",
    "tangents2",
    "katsura6",
    "kinema",
    "game5two",
]
# Seconds each, and decided.
ENDS = ["eco8", "katsura7", "reimer5", "dietmaier_points"]
SLOW = ["katsura8", "virasoro", "dietmaier_cuik", "torus", "cyclohexane_9d", "bricard6R"]


@pytest.fixture(scope="session")
def published(published_data: Path) -> dict[str, dict[str, Any]]:
    path = published_data / "systems.json"
    return {entry["name"]: entry for entry in json.loads(path.read_text("utf-8"))["systems"]}


def solve_published(entry: dict[str, Any], budget_s: float) -> SystemResult:
    return solve_text(entry["variables"], entry["equations"], budget_s=budget_s)


def assert_none_lost(entry: dict[str, Any], result: SystemResult) -> None:
    """Published points, to the rounding of their print, lie in boxes; certified boxes are apart."""
    boxes = [*((s.lower, s.upper) for s in result.solutions), *result.remaining]
    low, high = (np.array(ends) for ends in zip(*boxes, strict=True)) if boxes else (None, None)
    for point in np.array(entry.get("solutions") or entry.get("sample_points") or []):
        room = 1e-6 * (1.0 + np.abs(point))
        assert low is not None and np.any(np.all((low - room <= point) & (point <= high + room), axis=1))
    if not result.covers:
        for i, a in enumerate(result.solutions):
            assert a.certified
            for b in result.solutions[:i]:
                assert np.abs(a.middle - b.middle).max() > a.radius + b.radius


def test_every_published_system_is_tried(published):
    assert sorted(QUICK + ENDS + SLOW) == sorted(published)


@pytest.mark.parametrize("name", [*QUICK, *(pytest.param(name, marks=pytest.mark.slow) for name in ENDS)])
def test_published_system(name, published):
    entry = published[name]
    result = solve_published(entry, 60.0 if name in QUICK else 300.0)
    count = entry["n_real_solutions"]
    assert result.verdict is (INFEASIBLE if count == 0 else COMPLETE)
    if count is None:
        assert result.covers
    else:
        assert len(result.solutions) == count
    assert_none_lost(entry, result)


@pytest.mark.slow
@pytest.mark.parametrize("name", SLOW)
def test_published_system_that_takes_long(name, published):
    """No wrong verdict, and no solution lost, however far it comes."""
    entry = published[name]
    result = solve_published(entry, 15.0)
    count = entry["n_real_solutions"]
    if count is None:
        assert result.verdict is not INFEASIBLE
        assert result.covers or result.verdict is UNDECIDED  # a set of solutions is never called finite
    else:
        assert len(result.solutions) <= count
        assert result.verdict is UNDECIDED or (result.verdict is COMPLETE and len(result.solutions) == count)
    assert_none_lost(entry, result)


@pytest.mark.parametrize("name", ["caprasse", "puma", "viviani"])
def test_twice_the_same_to_the_last_bit(name, published):
    one, two = (solve_published(published[name], 60.0) for _ in range(2))
    assert one.boxes == two.boxes and len(one.solutions) == len(two.solutions)
    for a, b in zip(one.solutions, two.solutions, strict=True):
        assert a.lower.tobytes() == b.lower.tobytes() and a.upper.tobytes() == b.upper.tobytes()
        assert a.certified == b.certified
