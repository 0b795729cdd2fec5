"""The checker's cosines and sines against another series, and logs whose couplings were tampered with."""

import copy
import dataclasses
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from holdfast.check_proof import check_proof
from holdfast.check_proof.box import Box
from holdfast.check_proof.cosine import ERROR, ONE, PI, cosine_and_sine, to_units
from holdfast.check_proof.trig import TrigFunction
from holdfast.hands import Axis, Coupling
from holdfast.objects import Task
from holdfast.solver import Verdict, solve, task_form

from ..exact import Exact
from .logs import Records, check, forged, linkage, plates, read, sealed, search, write

RATIOS = [1.05851325, 0.87, 0.8024, 1.13, 2.5, 1.0, 0.01, 37.0]
# The first forty digits, as printed in every table.
DIGITS = "3141592653589793238462643383279502884197"


def test_pi_has_the_digits_of_the_tables():
    assert str(PI * 10**39 >> 128)[:36] == DIGITS[:36]


def test_cosine_and_sine_are_off_by_less_than_they_say():
    rng = np.random.default_rng(0)
    numbers = [*rng.uniform(-55, 55, 300), *(k * np.pi / 4 for k in range(-20, 21)), 0.0, 1e-300]
    for x in map(float, numbers):
        got = cosine_and_sine(to_units(Fraction(x)))
        for value, exact in zip(got, Exact.cosine_and_sine(Fraction(x)), strict=True):
            assert abs(value - exact * ONE) < ERROR / 20


def cases(seed: int, count: int) -> Iterator[tuple[TrigFunction, float, float, np.random.Generator]]:
    rng = np.random.default_rng(seed)
    for _ in range(count):
        ratio, offset = float(rng.choice(RATIOS)), float(rng.uniform(-3, 3))
        a = float(rng.uniform(-3, 3))
        width = float(10.0 ** rng.uniform(-8, 0.5) / max(1.0, ratio / 2.5))
        yield TrigFunction(1, 0, bool(rng.integers(2)), ratio, offset), a, a + width, rng


def values(f: TrigFunction, a: float, b: float, rng: np.random.Generator) -> list[tuple[Fraction, Fraction]]:
    """Points of [a, b] and the function there."""
    at = [Fraction(x) for x in (a, b, *rng.uniform(a, b, 10).tolist())]
    angles = [Fraction(f.ratio) * x + Fraction(f.offset) for x in at]
    return [(x, Exact.cosine_and_sine(angle)[f.is_sine]) for x, angle in zip(at, angles, strict=True)]


def test_ranges_and_lines_hold_all_points():
    for f, a, b, rng in cases(1, 200):
        points = values(f, a, b, rng)
        lo, hi = f.range_over(a, b)
        slope = float(rng.normal()) * (f.ratio if rng.uniform() < 0.7 else 3.0)
        least, most = f.beside_line(slope, a, b)
        for x, value in points:
            assert Fraction(lo) <= value <= Fraction(hi)
            assert Fraction(least) <= value - Fraction(slope) * x <= Fraction(most)
        assert most - least < abs(slope) * (b - a) + (hi - lo) + 1e-12
        assert hi - lo <= f.ratio * (b - a) + 1e-15


def test_a_box_is_narrowed_and_loses_no_point():
    narrowed = 0
    for f, a, b, rng in cases(2, 200):
        points = values(f, a, b, rng)
        least, most = (float(points[3][1]) + s * 10.0 ** rng.uniform(-9, 0) for s in (-1, 1))
        box = Box(np.array([a, least]), np.array([b, most]))
        f.narrow(box)
        for x, value in points:
            if Fraction(least) <= value <= Fraction(most):
                assert Exact.within([x, value], box.lower, box.upper)
        narrowed += box.upper[0] - box.lower[0] < 0.9 * (b - a)
    assert narrowed > 70


def test_what_is_far_or_empty_is_no_trouble():
    f = TrigFunction(1, 0, False, 1.0585, 0.1)
    for a, b in ((-1e300, 1e300), (2e3, 2e3)):
        assert f.range_over(a, b) == (-1.0, 1.0)
        assert f.beside_line(0.5, a, b) == (-np.inf, np.inf)
    assert f.beside_line(0.5, 1.0, 0.0) == (-np.inf, np.inf)
    assert f.beside_line(1e308, 0.0, 1.0)[1] <= 1.1 and f.beside_line(1e308, 0.0, 100.0)[0] == -np.inf
    empty = Box(np.array([np.inf, -1.0]), np.array([-np.inf, 1.0]))
    f.narrow(empty)
    assert empty.is_empty
    out_of_reach = Box(np.array([0.0, 1.5]), np.array([1.0, 2.0]))
    f.narrow(out_of_reach)
    assert out_of_reach.is_empty
    tiny = TrigFunction(1, 0, True, 1e-320, 0.0)
    assert tiny.range_over(-1.0, 1.0)[1] < 1e-30 and tiny.beside_line(1.0, -1.0, 1.0)[1] >= 1.0


def coupled_plates(half_thickness: float, ratio: float, offset: float) -> Task:
    """`plates`, for a hand whose outer joints follow by any ratio."""
    task = plates(half_thickness)

    def follow(axis: Axis) -> Axis:
        if axis.coupling is None:
            return axis
        coupling = Coupling(axis.coupling.master, ratio, offset)
        return dataclasses.replace(axis, coupling=coupling, lower=-6.0, upper=6.0)

    links = tuple(
        dataclasses.replace(link, axes=tuple(follow(axis) for axis in link.axes)) for link in task.hand.links
    )
    hand = dataclasses.replace(task.hand, links=links)
    return dataclasses.replace(task, hand=hand, limits=np.array(hand.limits))


@pytest.fixture(scope="module")
def coupled(tmp_path_factory: pytest.TempPathFactory) -> tuple[Task, Path]:
    task, path = coupled_plates(0.105, 1.05851325, 0.1), tmp_path_factory.mktemp("coupled") / "plate.proof"
    assert solve(task, candidates=1, budget_s=300, proof=path).verdict is Verdict.INFEASIBLE
    return task, path


@pytest.fixture
def records(coupled: tuple[Task, Path]) -> Records:
    return read(coupled[1])


def test_a_hand_with_any_ratio_is_refuted_and_the_log_accepted(coupled, records):
    task, path = coupled
    result = check_proof(path, task_form(task))
    assert result.accepted, result.reason
    assert len(records[1]["form"]["trig"]) >= 4
    n_bernstein = len(records[1]["form"]["functions"])
    lines = [plane for r in records if "box" in r for s in r["steps"] if s[0] == "over" for plane in s[3]]
    assert any(plane[0] >= n_bernstein for plane in lines), "no line beside a cosine was needed"


@pytest.mark.parametrize(("ratio", "offset"), [(1.0585, 0.1), (1.05851325, 0.1001)])
def test_the_log_is_not_that_of_another_hand(coupled, ratio, offset):
    other = coupled_plates(0.105, ratio, offset)
    assert check_proof(coupled[1], task_form(other)).reason == "the log's system is not that of the task"


@pytest.mark.parametrize("place", [2, 3, 4])
def test_a_tampered_coupling_with_a_fresh_checksum_is_rejected(coupled, records, place, tmp_path):
    """Kind, ratio or offset of each function: never the task's system, and no refutation either."""
    task, _ = coupled
    form = records[1]["form"]
    kept = copy.deepcopy(form["trig"])
    for function in form["trig"]:
        function[place] = 1 - function[place] if place == 2 else function[place] * 0.7 + 0.2
    path = write(tmp_path / "forged.proof", sealed(records))
    assert check_proof(path, task_form(task)).reason == "the log's system is not that of the task"
    assert not check_proof(path).accepted
    form["trig"] = kept
    form["trig"][0][3] = float(np.nextafter(form["trig"][0][3], 9.0))
    path = write(tmp_path / "forged.proof", sealed(records))
    assert check_proof(path, task_form(task)).reason == "the log's system is not that of the task"


def test_lines_with_other_slopes_prove_nothing(records, tmp_path):
    n = len(records[1]["form"]["functions"])

    def flip(plane: list[float]) -> None:
        if plane[0] >= n:
            plane[1] = -plane[1]

    def steepen(plane: list[float]) -> None:
        if plane[0] >= n:
            plane[1] += 1e200

    for change in (flip, steepen):
        assert check(forged(records, change), tmp_path) != ""


@pytest.mark.parametrize(
    "function",
    [
        None, [], [0, 1, 0, 1.0], [0, 1, 2, 1.0, 0.0], [0, 1, 0, 0.0, 0.0], [0, 1, 0, -1.0, 0.0],
        [0, 1, 0, "1", 0.0], [0, 10**6, 0, 1.0, 0.0], [-1, 1, 0, 1.0, 0.0], [0, 1, True, 1.0, 0.0],
        [0, 1, 0, 1.0, None],
    ],
)  # fmt: skip
def test_a_function_that_makes_no_sense_is_rejected(records, function, tmp_path):
    records[1]["form"]["trig"].append(function)
    assert check(sealed(records), tmp_path) != ""


@pytest.mark.parametrize("reach", [0.6, 1.0, 1.5, 1.9])
def test_no_log_refutes_a_linkage_that_comes_there(reach, tmp_path):
    """By the intermediate value theorem it does; a search that calls its last boxes empty proves nothing."""
    path = tmp_path / "linkage.proof"
    assert not search(linkage(reach), path, most=20)
    assert "is not shown to be empty" in check_proof(path).reason


def test_a_linkage_that_is_too_short_is_refuted(tmp_path):
    path = tmp_path / "linkage.proof"
    assert search(linkage(1.95), path)
    assert check_proof(path).accepted
