"""The best with the hand: between what regions allow and configurations show, with a log that is checked."""

import hashlib
from collections.abc import Callable
from copy import deepcopy
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from holdfast.check_proof import check_proof
from holdfast.errors import InputError
from holdfast.objects import Task, load_task
from holdfast.solver import best_with_hand, hand_form, solve, statics_form
from holdfast.solver.contacts import ContactManifold
from holdfast.solver.proof import BoxRecord
from holdfast.solver.reach.best import _setup
from holdfast.solver.reach.climb import HandClimber
from holdfast.solver.reach.hand_reach import HandReach
from holdfast.solver.reach.objectives import MinusCarried, NeededFriction
from holdfast.solver.search import SearchOrder, Subtree
from holdfast.solver.statics import Standing, friction_up, load_problem, statics_problem
from holdfast.solver.statics.climb import Climber
from holdfast.solver.statics.friction_worker import FrictionSetup, FrictionWorker
from holdfast.solver.statics.log import StaticsLog
from holdfast.solver.statics.worker import StaticsRecord

from ...check_proof.logs import Records, line, read, write
from ..statics.twins import LIMITS

WIDTH = 0.02


@pytest.fixture(scope="module")
def task() -> Task:
    """Three contacts on three patches."""
    return load_task("handling")


@pytest.fixture(scope="module")
def reach(task: Task) -> HandReach:
    return HandReach(task)


@pytest.fixture(scope="module")
def far(reach: HandReach) -> tuple[np.ndarray, list[BoxRecord]]:
    """Where a small part of the regions begins that is out of the hand's reach, and what shows it."""
    rng = np.random.default_rng(0)
    while True:
        low = rng.uniform(0.0, 1.0 - WIDTH, 6)
        tree, taken = reach.refute(low, low + WIDTH, 40)
        assert taken <= 40
        if tree is not None and len(tree) >= 5:
            assert len(tree) == taken
            return low, tree


@pytest.fixture(scope="module")
def log(
    task: Task, far: tuple[np.ndarray, list[BoxRecord]], tmp_path_factory: pytest.TempPathFactory
) -> Path:
    """A log in which a small part of the regions is cut out, and shown to be out of the hand's reach.

    All else needs more friction than is claimed, as the root's twist shows.
    """
    low, tree = far
    path = tmp_path_factory.mktemp("reach") / "hand.proof"
    problem = statics_problem(task)
    problem = replace(problem, form=problem.form | {"hand": hand_form(task)})
    worker = FrictionWorker(FrictionSetup(problem=problem, limit=0.1, steps=3, order=SearchOrder.BEST_FIRST))
    (root,) = worker.roots
    box, is_refuted, _ = worker.refute(root, worker._maps(root))
    assert is_refuted
    writer = StaticsLog(path, problem)
    for k in range(6):
        for cut, inside, outside in ((low[k], "1", "0"), (low[k] + WIDTH, "0", "1")):
            writer.add(StaticsRecord(box, (k, float(cut))))
            writer.add(StaticsRecord(replace(box, path=box.path + outside), None))
            box = replace(box, path=box.path + inside)
    writer.add(StaticsRecord(box, None, tree))
    writer.finish(0.1)
    return path


@cache
def _form(task: Task) -> dict[str, Any]:
    return statics_form(task) | {"hand": hand_form(task)}


def test_value_and_bound_lie_about_what_the_hand_needs() -> None:
    best = best_with_hand(load_task("upholding"), gap=0.03)
    limit = LIMITS["upholding"]  # of the regions, which a hand can't beat
    assert best.example is not None and best.example.certified and best.gap <= 0.03
    assert limit * (1.0 - 1e-4) < best.value and best.bound <= best.value
    assert f"the hand holds it with friction {friction_up(best.value)}" in str(best) and "(proved)" in str(
        best
    )
    frictionless = str(replace(best, history=(Standing(0.0, 1e-4, 0.0),)))
    assert "next to no friction" in frictionless and "nothing is proved" not in frictionless
    problem = statics_problem(load_task("upholding"))
    climber = HandClimber(load_task("upholding"), problem, NeededFriction(problem))
    assert climber.cost(best.example.state) == pytest.approx(best.value, rel=1e-5)
    # Wherever local search begins, it ends near the least; caps in its way, which are curved, don't stop it.
    found = solve(load_task("upholding"), candidates=6, seed=1000)
    ends = [climber.climb(configuration.state)[1] for configuration in found]
    assert max(ends) < 1.02 * best.value and min(ends) > 0.999 * best.value


def test_costs_are_those_of_the_regions_points_and_climbs_lower_them(task: Task) -> None:
    problem = statics_problem(task)
    climber, points = HandClimber(task, problem, NeededFriction(problem)), Climber(problem)
    manifold = ContactManifold(task)
    for configuration in solve(task, candidates=2, seed=1):
        state = configuration.state
        params = state.params[np.concatenate(HandReach(task)._at)]
        assert climber.cost(state) == pytest.approx(points.needed_at(0, params), rel=1e-5)
        there, cost = climber.climb(state)
        assert cost <= climber.cost(state) and manifold.error_m(there) < 1e-9 and manifold.is_feasible(there)


def test_limits_that_a_state_is_at_do_not_mislead_its_climb(task: Task) -> None:
    """The least friction lies in corners of regions; slopes that were clipped there end climbs before it."""
    problem = statics_problem(task)
    climber = HandClimber(task, problem, NeededFriction(problem))
    found = solve(task, candidates=32, seed=0)
    start = sorted((configuration.state for configuration in found), key=climber.cost)[2]
    end, cost = climber.climb(start)
    assert cost < 0.1620  # 1000 climbs with such slopes came to 0.16199 at best
    assert climber.climb(end, at_last=True)[1] <= cost


def test_twists_say_how_the_load_that_is_carried_changes(task: Task) -> None:
    """About a place the cost is that of the worst twist; elsewhere it is no less than any twist says."""
    problem = load_problem(task)
    objective, manifold = MinusCarried(problem), ContactManifold(task)
    climber = HandClimber(task, problem, objective)
    rng = np.random.default_rng(5)
    gains = []
    starts = sorted((c.state for c in solve(task, candidates=4, seed=4)), key=climber.cost)
    for state in starts[:2]:
        steps = [size * rng.normal(size=manifold.n_tangent) for size in (1e-6, 1e-3, 0.03)]
        maps = [climber._maps(manifold.retract(state, step)) for step in steps]
        cuts = objective(climber._maps(state)).cuts(maps)
        assert cuts.values.max() == pytest.approx(climber.cost(state), rel=1e-3, abs=1e-4)
        least = (cuts.values[:, None] + cuts.changes).max(axis=0)
        costs = np.array([objective(there).cost for there in maps])
        assert (costs >= least - 1e-3 * abs(least) - 1e-4).all()
        assert costs[0] == pytest.approx(least[0], rel=1e-3, abs=1e-4)
        there, cost = climber.climb(state)
        assert cost <= climber.cost(state) and manifold.is_feasible(there)
        gains.append(climber.cost(state) - cost)
    assert max(gains) > 1.0  # times the load


def test_from_where_nothing_is_carried_the_climb_goes_by_the_friction_that_is_lacking() -> None:
    task = load_task("lid_lifting")
    problem = load_problem(task, max_force_N=30.0)
    climber = HandClimber(task, problem, MinusCarried(problem))
    lacking = HandClimber(task, problem, NeededFriction(problem, problem.friction))
    states = [configuration.state for configuration in solve(task, candidates=12, seed=0)]
    stuck = [state for state in states if climber.cost(state) >= 0.0]
    assert stuck and all(climber.cost(state) == pytest.approx(lacking.cost(state)) for state in stuck)
    ends = [climber.climb(state)[1] for state in stuck[-4:]]
    assert min(ends) < -1.0  # times the load


def test_a_hand_is_asked_as_much_as_is_allowed(task: Task, far: tuple[np.ndarray, list[BoxRecord]]) -> None:
    worker = _setup(task, "friction", None, None, traced=False).worker()
    low, _ = far
    box = replace(worker.roots[0], lower=low, upper=low + WIDTH)
    for allowed in (0, 30, 4000):
        done = worker.work(Subtree(box, 0, context=allowed))
        assert done.hand_boxes <= allowed
        assert done.hand_refuted == (allowed >= 4000)
        assert bool(done.subtree.open) == (allowed < 4000)


def test_a_hand_that_refutes_is_asked_more(task: Task) -> None:
    setup = _setup(task, "friction", None, None, traced=False)
    left = [setup.allowance(spent, 0, 100) for spent in (0, 5000, 8000, 10_000)]
    assert left == sorted(left, reverse=True)
    assert left[0] > 0 and left[-1] == 0
    assert setup.allowance(10_000, 5, 100) > 0
    assert setup.allowance(10_000, 0, 1000) > 0


def test_what_is_reached_is_never_refuted(task: Task, reach: HandReach) -> None:
    for configuration in solve(task, candidates=3, seed=2):
        at = configuration.state.params[np.concatenate(reach._at)]
        lower, upper = np.maximum(at - 0.01, 0.0), np.minimum(at + 0.01, 1.0)
        assert reach.refute(lower, upper, 300)[0] is None
        landed = reach.land(lower, upper, 20, 0)
        if landed is not None:
            there = landed.params[np.concatenate(reach._at)]
            assert np.all((there >= lower - 1e-9) & (there <= upper + 1e-9))


def test_the_checker_replays_what_is_out_of_reach(log: Path, task: Task) -> None:
    check = check_proof(log, _form(task))
    assert check.accepted, check.reason
    assert check.with_hand and check.friction == 0.1 and check.boxes == 25
    assert "regions" in check_proof(log, _form(load_task("upholding"))).reason
    assert "hand" in check_proof(log, statics_form(task)).reason


def _tree(change: Callable[[list[Any]], Any]) -> Callable[[Records], None]:
    return lambda records: change(records[-2]["unreached"])


TAMPERS: dict[str, Callable[[Records], None]] = {
    "a box left out": _tree(lambda tree: tree.pop()),
    "the root left out": _tree(lambda tree: tree.pop(0)),
    "no tree": _tree(lambda tree: tree.clear()),
    "a split left out": _tree(lambda tree: tree[0].__setitem__(2, None)),
    "nothing but the root": _tree(lambda tree: tree.__setitem__(slice(None), [["", [], None]])),
    "a step that shows nothing": _tree(lambda tree: tree[-1][1].append(["ray", [0], [1.0]])),
    "a box twice": _tree(lambda tree: tree.append(tree[-1])),
    "no list": lambda records: records[-2].update(unreached=7),
    "a twist beside it": lambda records: records[-2].update(twist=[1, 0, 0, 0, 0, 0]),
    "no hand": lambda records: records[1]["form"].pop("hand"),
    "another joint's limits": lambda records: records[1]["form"]["hand"]["system"]["lower"].__setitem__(
        0, 0.9
    ),
    "other columns": lambda records: records[1]["form"]["hand"]["columns"].reverse(),
    "columns out of range": lambda records: records[1]["form"]["hand"]["columns"].__setitem__(0, [0, 10**6]),
    "a column too few": lambda records: records[1]["form"]["hand"]["columns"].pop(),
    "a half left out": lambda records: records.pop(-2),
}


@pytest.mark.parametrize("name", TAMPERS)
def test_tampered_logs_are_refused(log: Path, task: Task, tmp_path: Path, name: str) -> None:
    records = deepcopy(read(log))
    TAMPERS[name](records)
    for sign in (False, True):
        if sign:
            end = {k: v for k, v in records[-1]["end"].items() if k != "sha256"}
            digest = _digest(records)
            records[-1] = {"end": {**end, "boxes": sum("box" in r for r in records), "sha256": digest}}
        check = check_proof(write(tmp_path / "forged.proof", records), _form(task))
        assert not check.accepted and check.reason


def _digest(records: Records) -> str:
    digest = hashlib.sha256()
    for record in records[:-1]:
        digest.update(line(record))
    return digest.hexdigest()


@pytest.mark.slow
def test_a_checkpoint_goes_on(tmp_path: Path) -> None:
    task, file = load_task("upholding"), tmp_path / "hand.checkpoint"
    first = best_with_hand(task, gap=0.05, checkpoint=file, seed=3)
    again = best_with_hand(task, gap=0.05, checkpoint=file, seed=3, resume=True)
    assert again.bound == first.bound and again.value == pytest.approx(first.value, rel=1e-3)


def test_goals_and_forces_are_checked(task: Task) -> None:
    with pytest.raises(InputError, match="friction or load"):
        best_with_hand(task, "beauty")
    with pytest.raises(InputError, match="goes with the load"):
        best_with_hand(task, "friction", max_force_N=3.0)
