"""Proof logs: those that the solver writes are accepted, and no other log proves what is not so."""

import ast
import copy
import gzip
import hashlib
import json
import sys
from collections.abc import Callable, Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from holdfast.check_proof import check_proof
from holdfast.check_proof.box import Box
from holdfast.check_proof.propagation import propagate
from holdfast.check_proof.relaxation import Planes, bound, relax
from holdfast.check_proof.system import LoggedSystem
from holdfast.errors import InputError
from holdfast.geometry import BezierPatch, Patch
from holdfast.objects import Task
from holdfast.solver import Verdict, solve
from holdfast.solver.contraction.prune import Pruner
from holdfast.solver.polynomial.canonical import CanonicalForm, canonical_form
from holdfast.solver.polynomial.system import PolynomialSystem, SystemBuilder
from holdfast.solver.proof.log import BoxRecord, BoxTrace, ProofWriter, form_data

Records = list[dict[str, Any]]


# Logs


def read(path: Path) -> Records:
    return [json.loads(line) for line in gzip.decompress(path.read_bytes()).splitlines()]


def line(record: dict[str, Any]) -> bytes:
    return json.dumps(record, separators=(",", ":")).encode() + b"\n"


def write(path: Path, records: Records) -> Path:
    path.write_bytes(gzip.compress(b"".join(map(line, records)), 1))
    return path


def sealed(records: Records) -> Records:
    """With counts and checksum to match, as a forger would write them."""
    body = [r for r in records if "end" not in r]
    digest = hashlib.sha256()
    for record in body:
        digest.update(line(record))
    boxes = [r for r in body if "box" in r]
    steps = sum(len(r["steps"]) for r in boxes)
    end = {"boxes": len(boxes), "steps": steps, "sha256": digest.hexdigest()}
    return [*body, {"end": end}]


def boxes_of(records: Records) -> Records:
    return [r for r in records if "box" in r]


def steps_of(records: Records, kind: str) -> list[list[Any]]:
    return [s for r in boxes_of(records) for s in r["steps"] if s[0] == kind]


# Systems


def circle(product: float, *, at: tuple[float, float] = (0.5, 0.75)) -> PolynomialSystem:
    """x^2 + y^2 = 13/16 with x y = `product`: at most 13/32; (1/2, 3/4) solves it for 3/8."""
    builder = SystemBuilder()
    x, y = (builder.variable(name, -2.0, 2.0) for name in "xy")
    builder.equate(x * x + y * y - (at[0] ** 2 + at[1] ** 2))
    builder.equate(x * y - product)
    return builder.build()


def saddle(height: float) -> PolynomialSystem:
    """z = f(u, v), a biquadratic, and u v = 1/8 with z = `height`; 11/32 is f at (1/4, 1/2)."""
    builder = SystemBuilder()
    u, v = builder.variable("u", 0.0, 1.0), builder.variable("v", 0.0, 1.0)
    z = builder.bernstein("z", u, v, np.array([[0.0, 0.5, 0.0], [0.5, 0.25, 0.75], [0.0, 1.0, 0.5]]))
    builder.equate(u * v - 0.125)
    builder.equate(z - height)
    return builder.build()


def search(system: PolynomialSystem, path: Path, tightened: int = 2, most: int = 200) -> bool:
    """Branch and prune with a log; a box that can't be refuted is called empty, which gives False."""
    form = canonical_form(system)
    pruner = Pruner(form, system.inputs)
    writer = ProofWriter(path, form, "toy")
    stack, honest = [pruner.root], True
    while stack:
        box = stack.pop()
        trace = BoxTrace(form)
        pruned = pruner.prune(box, tightened=tightened, trace=trace)
        most -= 1
        is_small = pruned is not None and bool(np.all((pruned.upper - pruned.lower)[system.inputs] < 0.05))
        if pruned is None or is_small or most < 0:
            honest &= pruned is None
            writer.add(BoxRecord(box.path, trace.steps, None))
        else:
            writer.add(BoxRecord(box.path, trace.steps, pruner.cut(pruned)))
            stack.extend(pruner.split(pruned))
    writer.finish()
    return honest


INFEASIBLE = {"circle": circle(0.41), "saddle": saddle(0.37)}
FEASIBLE = {"circle": circle(0.375), "saddle": saddle(11 / 32)}


@pytest.fixture(scope="module")
def plates(make_task: Callable[..., Task]) -> Callable[[float, int], Task]:
    def make(half_thickness: float, degree: int = 1) -> Task:
        """Opposite faces of a plate, 40 mm square, plane or bulging by 3 mm."""
        w, side = 0.02, np.linspace(-1.0, 1.0, degree + 1)
        x, y = np.meshgrid(side, side, indexing="ij")
        bulge = 0.003 * (1.0 - x**2) * (1.0 - y**2)
        top = np.stack([w * x, w * y, half_thickness + bulge], axis=-1)
        bottom = (top * np.array([1.0, 1.0, -1.0]))[:, ::-1]
        regions = [Patch(BezierPatch(net)) for net in (bottom, top)]
        return make_task(("index/tip", regions[0]), ("thumb/tip", regions[1]))

    return make


@pytest.fixture(scope="module")
def proved(plates: Callable[..., Task], tmp_path_factory: pytest.TempPathFactory) -> tuple[Task, Path]:
    """A plate that two fingers can't span, and the proof."""
    task, path = plates(0.11), tmp_path_factory.mktemp("proof") / "plate.proof"
    result = solve(task, candidates=1, budget_s=300, proof=path)
    assert result.verdict is Verdict.INFEASIBLE
    assert len(boxes_of(read(path))) == result.boxes > 3
    return task, path


@pytest.fixture
def records(proved: tuple[Task, Path]) -> Records:
    return read(proved[1])


def check(records: Records, folder: Path) -> str:
    """The reason why forged records are rejected; empty where they are not."""
    return check_proof(write(folder / "forged.proof", records)).reason


# Honest logs


def test_a_proof_is_accepted_for_its_task_and_for_no_other(proved, plates):
    task, path = proved
    check = check_proof(path, task)
    assert check.accepted and check.reason == ""
    assert check.boxes > 3 and check.steps > check.boxes
    assert check_proof(path).accepted
    other = check_proof(path, plates(0.1100001))
    assert not other.accepted and "not that of the task" in other.reason


def test_proofs_are_small_and_say_the_same_each_time(plates, tmp_path):
    files = [tmp_path / "a.proof", tmp_path / "b.proof"]
    for path in files:
        assert solve(plates(0.13), candidates=1, proof=path).verdict is Verdict.INFEASIBLE
        assert check_proof(path).accepted
    assert files[0].read_bytes() == files[1].read_bytes()
    assert files[0].stat().st_size < 100_000


def test_curved_faces_and_pure_search_are_proved_as_well(plates, tmp_path):
    task, path = plates(0.13, 2), tmp_path / "curved.proof"
    assert solve(task, pure=True, budget_s=300, proof=path).verdict is Verdict.INFEASIBLE
    assert any(f for f in read(path)[1]["form"]["functions"])
    assert check_proof(path, task).accepted


@pytest.mark.parametrize("name", INFEASIBLE)
@pytest.mark.parametrize("tightened", [0, 2])
def test_small_systems(name, tightened, tmp_path):
    path = tmp_path / "toy.proof"
    assert search(INFEASIBLE[name], path, tightened)
    check = check_proof(path)
    assert check.accepted, check.reason
    assert check.boxes > 1
    assert (check.steps > 0) == (tightened > 0)


def test_nothing_is_written_where_nothing_is_proved(plates, tmp_path):
    assert solve(plates(0.01), candidates=1, proof=tmp_path / "a").verdict is Verdict.SOLVED
    assert solve(plates(0.11), candidates=1, budget_s=0.0, proof=tmp_path / "b").verdict is Verdict.UNDECIDED
    assert list(tmp_path.iterdir()) == []


def test_a_place_that_can_not_be_written_is_refused_before_the_search(plates, tmp_path):
    with pytest.raises(InputError, match="can't be written"):
        solve(plates(0.11), proof=tmp_path)


def test_the_search_is_the_same_with_a_log(plates, tmp_path):
    with_log = solve(plates(0.13), candidates=1, proof=tmp_path / "p")
    without = solve(plates(0.13), candidates=1)
    assert (with_log.boxes, with_log.lps) == (without.boxes, without.lps)


# Tampering


def test_any_change_breaks_the_seal(records, tmp_path):
    """Even one that leaves a valid proof, such as a multiplier written differently."""
    assert check(records, tmp_path) == ""
    for number, record in enumerate(records):
        record["remark"] = 1
        # What stands beside the checksum itself means nothing.
        assert (check(records, tmp_path) == "") == ("end" in record), number
        del record["remark"]
    changed = copy.deepcopy(records)
    changed[-1]["end"]["boxes"] += 1
    assert check(changed, tmp_path) != ""
    assert check([*records, {"end": {}}], tmp_path) == "something follows the last record"


def test_rays_are_needed_and_flipped_they_are_none(records, tmp_path):
    refuted = [r for r in boxes_of(records) if r["steps"] and r["steps"][-1][0] == "ray"]
    assert refuted
    needed = flipped = 0
    for record in refuted:
        ray = record["steps"].pop()
        is_needed = "is not shown to be empty" in check(sealed(records), tmp_path)
        needed += is_needed
        record["steps"].append(["ray", ray[1], [-y for y in ray[2]]])
        if is_needed:
            assert "a ray does not show what it should" in check(sealed(records), tmp_path)
        largest = int(np.argmax(np.abs(ray[2])))
        record["steps"][-1] = ["ray", ray[1], [-y if k == largest else y for k, y in enumerate(ray[2])]]
        flipped += "a ray does not show what it should" in check(sealed(records), tmp_path)
        record["steps"][-1] = ray
    # The checker propagates further than the solver, and a ray may have strength to spare.
    assert 2 * needed >= len(refuted) and 2 * flipped >= len(refuted)


def test_bounds_that_are_missing_leave_boxes_open(records, tmp_path):
    for record in boxes_of(records):
        record["steps"] = [s for s in record["steps"] if s[0] != "bound"]
    assert check(sealed(records), tmp_path) != ""


def test_multipliers_may_not_be_those_of_another_bound(records, tmp_path):
    """Each bound's multipliers go to the next one: as bounds they are valid, but worthless."""
    bounds = steps_of(records, "bound")
    duals = [b[3:] for b in bounds]
    for step, other in zip(bounds, duals[1:] + duals[:1], strict=True):
        step[3:] = other
    assert check(sealed(records), tmp_path) != ""


@pytest.mark.parametrize("move", [-0.3, 0.3, 50.0])
def test_a_split_somewhere_else_is_not_what_was_refuted(records, tmp_path, move):
    (first,) = [r for r in boxes_of(records) if r["box"] == ""]
    first["split"][1] += move
    assert check(sealed(records), tmp_path) != ""


def test_a_split_of_another_column_is_not_what_was_refuted(records, tmp_path):
    (first,) = [r for r in boxes_of(records) if r["box"] == ""]
    first["split"][0] += 1
    assert check(sealed(records), tmp_path) != ""


def test_every_child_is_needed_and_only_once(records, tmp_path):
    for k, record in enumerate(records):
        if "box" not in record:
            continue
        without = sealed(records[:k] + records[k + 1 :])
        assert check(without, tmp_path) != "", k
        twice = sealed(records[: k + 1] + records[k:])
        assert "not open" in check(twice, tmp_path), k


def test_a_leaf_is_not_made_by_saying_so(records, tmp_path):
    for record in [r for r in boxes_of(records) if "split" in r and len(r["box"]) <= 1]:
        others = [r for r in boxes_of(records) if not r["box"].startswith(record["box"])]
        leaf = {"box": record["box"], "steps": record["steps"]}
        claimed = sealed([*records[:2], *sorted([*others, leaf], key=lambda r: len(r["box"]))])
        assert "is not shown to be empty" in check(claimed, tmp_path)


def test_a_child_does_not_come_before_its_parent(records, tmp_path):
    order = [*records[:2], *reversed(boxes_of(records))]
    assert "not open" in check(sealed(order), tmp_path)
    order = [records[0], *records[2:-1], records[1]]
    assert check(sealed(order), tmp_path) != ""


def test_a_box_smaller_than_propagation_gives_is_refused(records, tmp_path):
    for _, lower, upper, _ in steps_of(records, "over")[:3]:
        kept = list(lower)
        k = int(np.argmax(np.subtract(upper, lower)))
        lower[k] = 0.5 * (lower[k] + upper[k])
        assert "propagation does not give the box" in check(sealed(records), tmp_path)
        lower[:] = kept


def test_a_box_larger_than_it_need_be_proves_less(records, tmp_path):
    for _, lower, upper, _ in steps_of(records, "over"):
        lower[:], upper[:] = [x - 1.0 for x in lower], [x + 1.0 for x in upper]
    assert check(sealed(records), tmp_path) != ""


def test_the_system_is_that_of_the_task_to_the_last_bit(proved, records, tmp_path):
    task, path = proved
    form = records[1]["form"]
    for change in ("coefficient", "side", "bound", "product"):
        kept = copy.deepcopy(form)
        if change == "coefficient":
            form["rows"][20][1][0] = float(np.nextafter(form["rows"][20][1][0], 9.0))
        elif change == "side":
            form["rows"][0][2] -= 1e-9
        elif change == "bound":
            form["upper"][3] += 1e-9
        else:
            form["products"][5][1] = form["products"][5][0]
        forged = write(tmp_path / "form.proof", sealed(records))
        assert check_proof(forged, task).reason == "the log's system is not that of the task"
        form.clear()
        form.update(kept)
    # Written back as it was, the form is the task's again.
    assert check_proof(write(tmp_path / "same.proof", sealed(records)), task).accepted
    assert check_proof(path, task).accepted


def test_a_system_made_easier_to_solve_is_no_longer_refuted(records, tmp_path):
    """The rows with a constant, such as lengths and unit norms, get room on both sides."""
    for row in records[1]["form"]["rows"]:
        row[2], row[3] = (
            None if end is None else end + room for end, room in ((row[2], -5.0), (row[3], 5.0))
        )
    assert check(sealed(records), tmp_path) != ""


# Planes beside Bernstein functions


@pytest.fixture(scope="module")
def curved(tmp_path_factory: pytest.TempPathFactory) -> Records:
    """The log of a system that is refuted by planes beside its function."""
    path = tmp_path_factory.mktemp("proof") / "curved.proof"
    assert search(INFEASIBLE["saddle"], path)
    return read(path)


def forged(records: Records, change: Callable[[list[Any]], object]) -> Records:
    """The log with each plane `[function, slope, slope]` changed in place."""
    records = copy.deepcopy(records)
    for *_, planes in steps_of(records, "over"):
        for plane in planes:
            change(plane)
    return sealed(records)


def test_slopes_are_those_that_the_multipliers_were_made_for(curved, tmp_path):
    """Any slopes give valid planes; with others than the log's the multipliers prove nothing."""
    assert sum(len(planes) for *_, planes in steps_of(curved, "over")) >= 4
    assert check(forged(curved, lambda plane: None), tmp_path) == ""

    def swap(plane: list[Any]) -> None:
        plane[1:] = plane[:0:-1]

    def flip(plane: list[Any]) -> None:
        plane[1] = -plane[1]

    def flatten(plane: list[Any]) -> None:
        plane[1:] = [0.0, 0.0]

    def steepen(plane: list[Any]) -> None:
        plane[2] += 1e200

    for change in (swap, flip, flatten, steepen):
        assert check(forged(curved, change), tmp_path) != "", change.__name__


def test_a_slope_that_is_off_by_a_little_proves_a_little_less(curved, tmp_path):
    def nudge(plane: list[Any]) -> None:
        plane[1] *= 1.0 + 1e-9

    assert check(forged(curved, nudge), tmp_path) == ""


def test_planes_can_not_be_left_out(curved, tmp_path):
    without = copy.deepcopy(curved)
    for over in steps_of(without, "over"):
        over[3].clear()
    assert "an index is out of range" in check(sealed(without), tmp_path)


@pytest.mark.parametrize(
    "plane",
    [None, [], [0, 1.0], [0, 1.0, 1.0, 1.0], [1, 1.0, 1.0], [-1, 1.0, 1.0], [0, "1", 1.0], [0.0, 1.0, 1.0]],
)
def test_a_plane_that_makes_no_sense_is_rejected(curved, plane, tmp_path):
    records = copy.deepcopy(curved)
    steps_of(records, "over")[0][3].append(plane)
    assert check(sealed(records), tmp_path) != ""


# The law: what has a solution can't be refuted, whatever a log says.


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


# What the checker concludes is so: against rational arithmetic


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


# Files that are damaged, or no logs at all


def test_truncated_files_are_not_accepted(proved, tmp_path):
    data = proved[1].read_bytes()
    path = tmp_path / "cut.proof"
    for size in [0, 1, 10, *range(100, len(data), len(data) // 25), len(data) - 9, len(data) - 1]:
        path.write_bytes(data[:size])
        try:
            assert not check_proof(path).accepted
        except InputError as error:
            assert size < 500 and "\n" not in str(error)
    text = gzip.decompress(data)
    for part in (text[: len(text) // 2], text[:-1], text[: text.rindex(b'{"end"')]):
        path.write_bytes(gzip.compress(part))
        assert not check_proof(path).accepted


def test_bytes_that_flip_are_not_accepted(proved, tmp_path):
    text = bytearray(gzip.decompress(proved[1].read_bytes()))
    path, rng = tmp_path / "flipped.proof", np.random.default_rng(2)
    for at in rng.integers(100, len(text), 60).tolist():
        changed = bytearray(text)
        changed[at] ^= 1 << int(rng.integers(8))
        path.write_bytes(gzip.compress(changed, 1))
        assert not check_proof(path).accepted


def _packed(text: bytes) -> bytes:
    # The time inside a gzip header would give the test another name in each process that collects it.
    return gzip.compress(text, mtime=0)


@pytest.mark.parametrize(
    "content",
    [
        pytest.param(b"", id="nothing"),
        pytest.param(b"not a log\n", id="text"),
        pytest.param(_packed(b""), id="packed nothing"),
        pytest.param(_packed(b"\xff\xfe\x00"), id="not UTF-8"),
        pytest.param(_packed(b"[1, 2]\n"), id="a list"),
        pytest.param(_packed(b'{"grasp": 1}\n'), id="other fields"),
        pytest.param(_packed(b'{"holdfast_proof": 99}\n'), id="another version"),
        pytest.param(_packed(b"[" * 100_000 + b"\n"), id="nested too deep"),
        pytest.param(_packed(b'{"holdfast_proof": 3}'), id="no end of line"),
    ],
)
def test_other_files_are_bad_input(content, tmp_path):
    path = tmp_path / "other"
    path.write_bytes(content)
    with pytest.raises(InputError) as error:
        check_proof(path)
    assert str(error.value).count("\n") == 0 and "other" in str(error.value)


@pytest.mark.parametrize(("version", "advice"), [(2, "write it anew"), (99, "a newer Holdfast wrote it")])
def test_logs_of_other_versions_are_refused(records, version, advice, tmp_path):
    records[0]["holdfast_proof"] = version
    with pytest.raises(InputError, match=f"version {version}, where only version 3 .*{advice}"):
        check_proof(write(tmp_path / "other.proof", sealed(records)))


def test_a_missing_file_and_a_folder_are_bad_input(tmp_path):
    for path in (tmp_path, tmp_path / "missing"):
        with pytest.raises(InputError):
            check_proof(path)


FORM = {"lower": [0.0], "upper": [1.0], "rows": [], "products": [], "functions": []}


@pytest.mark.parametrize(
    "form",
    [
        None,
        [],
        {},
        {**FORM, "lower": [float("nan")]},
        {**FORM, "lower": [True]},
        {**FORM, "lower": [10**400]},
        {**FORM, "lower": [0.0, 0.0]},
        {**FORM, "rows": [1]},
        {**FORM, "rows": [[[0], [1.0], 2.0]]},
        {**FORM, "rows": [[[1], [1.0], 2.0, None]]},
        {**FORM, "rows": [[[-1], [1.0], 2.0, None]]},
        {**FORM, "rows": [[[0], [1.0, 1.0], 2.0, None]]},
        {**FORM, "rows": [[[0], [float("inf")], 2.0, None]]},
        {**FORM, "products": [[0, 0]]},
        {**FORM, "products": [[0, 0, 1]]},
        {**FORM, "products": [[0, 0, 0.0]]},
        {**FORM, "functions": [[[0, 0, 0], [1, 1], [1.0]]]},
        {**FORM, "functions": [[[0, 0, 0], [10**9, 1], [1.0]]]},
    ],
)
def test_a_system_that_makes_no_sense_is_rejected(form, tmp_path):
    records = [{"holdfast_proof": 3}, {"form": form}, {"box": "", "steps": []}]
    assert check(sealed(records), tmp_path) != ""


@pytest.mark.parametrize(
    "record",
    [
        {},
        {"box": 0, "steps": []},
        {"box": "0", "steps": []},
        {"box": ""},
        {"box": "", "steps": [1]},
        {"box": "", "steps": [[]]},
        {"box": "", "steps": [["magic"]]},
        {"box": "", "steps": [["ray", [0], [1.0]]]},
        {"box": "", "steps": [["over", [0.0], [], []]]},
        {"box": "", "steps": [["over", [], [], []], ["ray", [99], [1.0]]]},
        {"box": "", "steps": [["over", [], [], []], ["ray", [0], [float("nan")]]]},
        {"box": "", "steps": [["over", [], [], []], ["ray", [0], [1e308]]]},
        {"box": "", "steps": [["over", [], [], []], ["bound", 0, "both", [], []]]},
        {"box": "", "steps": [["over", [], [], []], ["bound", 7, "lower", [], []]]},
        {"box": "", "steps": [], "split": [0, float("nan")]},
        {"box": "", "steps": [], "split": [5, 0.5]},
        {"box": "", "steps": [], "split": None},
    ],
)
def test_a_record_that_makes_no_sense_is_rejected(record, tmp_path):
    row = [[0], [1.0], -1.0, 2.0]
    head = [{"holdfast_proof": 3}, {"form": {**FORM, "rows": [row]}}]
    body = [*head, record]
    records = [*body, {"end": {"boxes": 1, "steps": 1, "sha256": ""}}]
    assert check(records, tmp_path) not in ("", "the log was changed after it was written")


def test_a_log_without_a_system_or_with_two_proves_nothing(records, tmp_path):
    assert check(sealed([records[0]]), tmp_path) != ""
    assert check(sealed([records[0], *boxes_of(records)]), tmp_path) != ""
    assert "second" in check(sealed([*records[:2], records[1], *boxes_of(records)]), tmp_path)


# The checker itself


def test_the_checker_uses_nothing_of_the_solver():
    folder = Path(sys.modules["holdfast.check_proof"].__file__).parent
    first, later = set(), set()
    for source in folder.glob("*.py"):
        tree = ast.parse(source.read_text("utf-8"))
        for node in ast.walk(tree):
            names = first if node in tree.body else later
            if isinstance(node, ast.Import):
                names |= {alias.name.split(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom):
                names.add("." * node.level + (node.module or ""))
    own = {f".{source.stem}" for source in folder.glob("*.py")}
    foreign = {name for name in first if name.split(".")[0] not in sys.stdlib_module_names} - own
    assert foreign == {"numpy", "numpy.typing", "..errors"}
    # Formulating a task is the one thing left to the package.
    assert later == {"..objects", "..solver.formulate", "..solver.polynomial", "..solver.proof"}
