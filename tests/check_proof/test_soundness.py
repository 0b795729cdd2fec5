"""No log refutes what has a solution, and what the checker concludes holds in rational arithmetic."""

import copy
from collections.abc import Iterator
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from holdfast.check_proof.box import Box
from holdfast.check_proof.propagation import propagate
from holdfast.check_proof.relaxation import Planes, bound, relax
from holdfast.check_proof.system import LoggedSystem
from holdfast.solver.polynomial.canonical import CanonicalForm, canonical_form
from holdfast.solver.polynomial.system import PolynomialSystem, SystemBuilder
from holdfast.solver.proof.log import form_data

from .logs import FEASIBLE, INFEASIBLE, Records, boxes_of, check, read, sealed, search


def exact_solution(system: PolynomialSystem, exact: Any, inputs: dict[int, float]) -> list[Fraction]:
    x = [Fraction(0)] * system.size
    for k, value in inputs.items():
        x[k] = Fraction(value)
    exact.define(system, x)
    return x


def test_the_feasible_systems_are_feasible(exact):
    for name, values in (("circle", {0: 0.5, 1: 0.75}), ("saddle", {0: 0.25, 1: 0.5})):
        system = FEASIBLE[name]
        x = exact_solution(system, exact, values)
        assert all(exact.polynomial(equation, x) == 0 for equation in system.equations)
        assert exact.within(x, system.lower, system.upper)


def mutate(records: Records, rng: np.random.Generator) -> Records:
    """Some changes to the hints of a log; the system stays."""
    records = copy.deepcopy(records)
    for _ in range(int(rng.integers(0, 4))):
        boxes = boxes_of(records)
        record = boxes[int(rng.integers(len(boxes)))]
        steps = [s for s in record["steps"] if s[0] != "over"]
        overs = [s for s in record["steps"] if s[0] == "over"]
        match int(rng.integers(0, 10)):
            case 0 if steps:
                duals = steps[int(rng.integers(len(steps)))][-1]
                for _ in range(min(len(duals), 3)):
                    duals[int(rng.integers(len(duals)))] *= float(rng.choice([-1.0, 0.0, 1e3, 1e300, 1.01]))
            case 1 if steps:
                step = steps[int(rng.integers(len(steps)))]
                step[-1] = (rng.normal(size=len(step[-1])) * 10.0 ** rng.integers(-5, 9)).tolist()
            case 2 if steps:
                step = steps[int(rng.integers(len(steps)))]
                step[:] = ["ray", *step[-2:]]
            case 3 if "split" in record:
                record["split"][1] += float(rng.normal() * rng.choice([1e-9, 0.1, 3.0]))
            case 4:
                records.remove(record)
                if len(boxes) == 1:
                    return records
            case 5:
                record.pop("split", None)
                records = [r for r in records if r is record or not below(r, record)]
            case 6 if overs:
                over = overs[int(rng.integers(len(overs)))]
                side, k = int(rng.integers(1, 3)), int(rng.integers(len(over[1])))
                over[side][k] += float(rng.normal() * rng.choice([1e-7, 1e-3, 1.0]))
            case 7 if overs:
                over = overs[int(rng.integers(len(overs)))]
                over[1], over[2] = over[2], over[1]
            case 8 if overs and overs[-1][3]:
                plane = overs[-1][3][int(rng.integers(len(overs[-1][3])))]
                k = int(rng.integers(1, 3))
                plane[k] = plane[k] * float(rng.choice([-1.0, 0.0, 1.01, 1e9])) + float(
                    rng.choice([0.0, 0.1])
                )
            case _ if steps:
                step = steps[int(rng.integers(len(steps)))]
                if step[0] == "bound":
                    step[2] = "lower" if step[2] == "upper" else "upper"
    return sealed(records)


def below(record: dict[str, Any], ancestor: dict[str, Any]) -> bool:
    path = record.get("box")
    return path is not None and path != ancestor["box"] and path.startswith(ancestor["box"])


def with_form(records: Records, form: CanonicalForm) -> Records:
    return [{"form": form_data(form)} if "form" in r else r for r in records]


@pytest.mark.parametrize("name", FEASIBLE)
def test_no_log_refutes_a_system_with_a_solution(name, tmp_path):
    """Hints for the infeasible twin, and hints of a search that calls the solution's box empty, mutated."""
    path = tmp_path / "honest.proof"
    assert search(INFEASIBLE[name], path)
    twin = with_form(read(path), canonical_form(FEASIBLE[name]))
    assert not search(FEASIBLE[name], path, most=40)
    rng = np.random.default_rng(0)
    for source in (twin, read(path)):
        for _ in range(150):
            assert check(mutate(source, rng), tmp_path) != ""


@pytest.mark.parametrize("name", INFEASIBLE)
def test_what_is_accepted_is_a_whole_tree(name, tmp_path):
    path = tmp_path / "honest.proof"
    assert search(INFEASIBLE[name], path)
    honest, rng = read(path), np.random.default_rng(1)
    accepted = 0
    for _ in range(150):
        records = mutate(honest, rng)
        if check(records, tmp_path) != "":
            continue
        accepted += 1
        splits = {r["box"] for r in boxes_of(records) if "split" in r}
        leaves = {r["box"] for r in boxes_of(records)} - splits
        assert sum(Fraction(1, 2 ** len(leaf)) for leaf in leaves) == 1
        assert all(leaf[:k] in splits for leaf in leaves for k in range(len(leaf)))
    assert 10 < accepted < 140


def planted(seed: int, exact: Any) -> tuple[PolynomialSystem, LoggedSystem, list[Fraction]]:
    """Equations, a definition and a Bernstein function with an exact solution, products included."""
    rng = np.random.default_rng(seed)
    root = [*(rng.integers(-8, 9, 4) / 8).tolist(), *(rng.integers(0, 9, 2) / 8).tolist()]
    builder = SystemBuilder()
    x = [builder.variable(f"x{i}", -2.0, 2.0) for i in range(4)]
    u, v = (builder.variable(name, 0.0, 1.0) for name in "uv")
    net = rng.integers(-8, 9, rng.integers(1, 5, 2)) / 4
    x += [u, v, builder.define("w", x[0] * x[1] - x[2] * 0.5), builder.bernstein("z", u, v, net)]
    for _ in range(4):
        i, j, k = rng.integers(0, 6, 3)
        value = x[i] * x[j] * float(rng.integers(-4, 5)) + x[k] * x[k] * 0.5 + x[i] * 3.0
        builder.equate(value - value.evaluate(np.array([*root, 0.0, 0.0])))
        builder.at_least_zero(x[6] * x[k] - x[7] + 100.0)
    system = builder.build()
    form = canonical_form(system)
    solution = exact_solution(system, exact, dict(enumerate(root))) + [Fraction(0)] * (form.size - 8)
    for k, i, j in form.products:
        solution[k] = solution[i] * solution[j]
    return system, LoggedSystem(form_data(form)), solution


def boxes_around(solution: list[Fraction], exact: Any, count: int, seed: int) -> Iterator[tuple[Any, Any]]:
    """Boxes that hold the point: wide, tiny, with ends at the point or no width at all."""
    rng = np.random.default_rng(seed)
    below_, above = (np.array([end(x) for x in solution]) for end in (exact.below, exact.above))
    for _ in range(count):
        size = 10.0 ** rng.uniform(-14, 1, (2, len(solution))) * (rng.uniform(size=(2, len(solution))) < 0.8)
        yield below_ - size[0], above + size[1]


@pytest.mark.parametrize("seed", range(12))
def test_propagation_of_the_checker_loses_nothing(seed, exact):
    _, system, solution = planted(seed, exact)
    narrowed = 0
    for lower, upper in boxes_around(solution, exact, 40, seed):
        box = Box(lower.copy(), upper.copy())
        with np.errstate(all="ignore"):
            propagate(system, box)
        assert exact.within(solution, box.lower, box.upper)
        assert np.all((lower <= box.lower) & (box.upper <= upper))
        narrowed += np.any(box.upper - box.lower < 0.9 * (upper - lower))
    assert narrowed > 20


def random_planes(system: LoggedSystem, rng: np.random.Generator) -> Planes:
    """Slopes of any size, several of them for a function."""
    function = rng.integers(0, system.n_functions, 5)
    a_i, a_j = rng.normal(size=(2, 5)) * 10.0 ** rng.integers(-12, 12, (2, 5))
    return Planes(function, a_i, a_j * (rng.uniform(size=5) < 0.7))


@pytest.mark.parametrize("seed", range(12))
def test_relaxations_and_bounds_of_the_checker_hold(seed, exact):
    _, system, solution = planted(seed, exact)
    rng = np.random.default_rng(seed)
    for lower, upper in boxes_around(solution, exact, 12, seed + 100):
        box = Box(lower, upper)
        with np.errstate(all="ignore"):
            rows = relax(system, box, random_planes(system, rng))
        n_rows = len(rows.lower)
        sums = [Fraction(0)] * n_rows
        for r, j, value in zip(rows.row.tolist(), rows.column.tolist(), rows.value.tolist(), strict=True):
            sums[r] += Fraction(value) * solution[j]
        for total, least, most in zip(sums, rows.lower.tolist(), rows.upper.tolist(), strict=True):
            assert (least == -np.inf or Fraction(least) <= total) and (
                most == np.inf or total <= Fraction(most)
            )
        for size in (1e-320, 1e-3, 1.0, 1e8, 1e290, 1e308):
            duals = rng.normal(size=n_rows).clip(-1, 1) * size * (rng.uniform(size=n_rows) < 0.5)
            j, sign = int(rng.integers(system.n)), float(rng.choice([-1.0, 1.0]))
            with np.errstate(all="ignore"):
                assert not bound(rows, duals, None, 0.0, box) > 0.0
                least = bound(rows, duals, j, sign, box)
            assert least == -np.inf or Fraction(least) <= Fraction(sign) * solution[j]
