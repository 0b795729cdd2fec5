"""Verdicts on whether regions can hold a load: known answers, twins, the statics of the hold test."""

import numpy as np
import pytest
from holdfast.errors import InputError
from holdfast.geometry import Patch
from holdfast.mjcf import preset_settings
from holdfast.mjcf.squeeze.load_program import cone_edges
from holdfast.mjcf.squeeze.pads import contact_pads
from holdfast.mjcf.squeeze.statics import WRENCH_SCALE, grasp_statics
from holdfast.objects import load_task
from holdfast.solver import Verdict, solve
from holdfast.solver.search import SearchOrder, Subtree
from holdfast.solver.statics import refute_balance, why_not
from holdfast.solver.statics.friction_worker import FrictionSetup
from holdfast.solver.statics.problem import statics_problem
from holdfast.solver.statics.worker import StaticsBox
from scipy.optimize import linprog

from .twins import LIMITS, caps, pinch


@pytest.mark.parametrize("lean", [0.05, 0.3, 0.8])
def test_a_leaning_pinch_holds_from_the_tangent_on(lean):
    task = pinch(lean)
    below, above = (refute_balance(task, friction=share * np.tan(lean)) for share in (0.999, 1.001))
    assert below.verdict is Verdict.INFEASIBLE and below.refuted == below.friction
    assert above.verdict is Verdict.SOLVED and np.isclose(above.example.friction, np.tan(lean), rtol=1e-4)


@pytest.mark.parametrize("name", sorted(LIMITS))
@pytest.mark.parametrize("share", [0.5, 0.9, 0.95, 0.98, 1.02, 1.1])
def test_twins_are_refuted_below_the_limit_and_solved_above(name, share):
    result = refute_balance(load_task(name), friction=share * LIMITS[name], budget_s=60.0)
    assert result.verdict is (Verdict.INFEASIBLE if share < 1.0 else Verdict.SOLVED)
    assert (result.example is None) == (share < 1.0)


def test_caps_that_look_away_from_each_other_are_refuted():
    """Both lean the same way by more than their half angle: no two of their points face each other."""
    task = caps(lean_rad=1.2, half_angle_rad=0.4)
    assert refute_balance(task, friction=0.3, budget_s=30.0).verdict is Verdict.INFEASIBLE
    assert refute_balance(task, friction=3.0).verdict is Verdict.SOLVED
    # Whole spheres do face each other; they are two charts each.
    assert refute_balance(caps(1.2, np.pi), friction=0.05).verdict is Verdict.SOLVED


def test_it_does_not_apply_where_nothing_must_balance_itself():
    for name in ("service", "tuning", "playing"):
        task = load_task(name)
        assert why_not(task)
        with pytest.raises(InputError, match="says nothing of this task"):
            refute_balance(task)
    assert why_not(load_task("handling")) == ""


def test_no_friction_at_all():
    assert refute_balance(load_task("handling"), friction=0.0, budget_s=60.0).verdict is Verdict.INFEASIBLE


def params_of(configuration):
    """Parameters (2 n,) of the object's patches."""
    found, k = [], 0
    for contact in configuration.task.contacts:
        k += 2 * isinstance(contact.hand.region, Patch)
        assert isinstance(contact.object.region, Patch)
        found.append(configuration.state.params[k : k + 2])
        k += 2
    return np.clip(np.concatenate(found), 0.0, 1.0)


def imbalance(configuration, settings):
    """How far forces in the hold test's cones are from balancing each other, by its own statics."""
    statics = grasp_statics(configuration, settings)
    mu = settings.sliding_friction(configuration.task.object)
    arms = contact_pads(configuration, settings).largest_arms_m()
    blocks = []
    for i, arm in enumerate(arms):
        blocks.append((WRENCH_SCALE[:, None] * statics.G[:, 4 * i : 4 * i + 4]) @ cone_edges(mu, mu * arm, 2))
    edges = np.hstack(blocks)
    k = edges.shape[1]
    A = np.vstack([np.hstack([edges, np.eye(6), -np.eye(6)]), np.append(np.ones(k), np.zeros(12))])
    cost = np.append(np.zeros(k), np.ones(12))
    return linprog(cost, A_eq=A, b_eq=np.append(np.zeros(6), 1.0), method="highs").fun


def refutes(worker, lower, upper):
    """Whether the tree's first step refutes a box."""
    done = worker.work(Subtree(StaticsBox(lower, upper, 0), 0)).subtree
    return not done.open and not done.undecided


@pytest.mark.slow
@pytest.mark.parametrize("name", ["upholding", "handling", "incision", "lid_lifting", "family:mug:31"])
def test_boxes_round_what_the_hold_test_balances_are_not_refuted(name):
    task = load_task(name)
    settings = preset_settings("holdfast", task)
    problem, friction = statics_problem(task), settings.sliding_friction(task.object)
    worker = FrictionSetup(problem=problem, limit=friction, steps=0, order=SearchOrder.DEPTH_FIRST).worker()
    rng = np.random.default_rng(5)
    balanced = unbalanced = 0
    for configuration in solve(task, candidates=40, seed=11, budget_s=60.0):
        params, off = params_of(configuration), imbalance(configuration, settings)
        if off <= 1e-9:
            balanced += 1
            for width in (1e-6, 1e-4, 1e-3, 0.02, 0.1, 0.3):
                lower = np.clip(params - width * rng.random(len(params)), 0.0, 1.0)
                upper = np.clip(params + width * rng.random(len(params)), 0.0, 1.0)
                assert not refutes(worker, lower, upper)
        elif off > 0.03:
            unbalanced += 1
            lower, upper = np.clip(params - 1e-4, 0.0, 1.0), np.clip(params + 1e-4, 0.0, 1.0)
            assert refutes(worker, lower, upper)
    assert balanced + unbalanced >= 10


def test_solve_says_so_first_and_only_when_asked():
    from dataclasses import replace

    task = load_task("handling")
    slippery = replace(task, object=replace(task.object, friction=0.15))
    result = solve(slippery, statics=True)
    assert result.verdict is Verdict.INFEASIBLE and result.lacks_friction and len(result) == 0
    assert "can't hold the load with friction 0.15" in str(result)
    plain = solve(slippery, candidates=1)
    assert plain.verdict is Verdict.SOLVED and plain.statics is None
    asked = solve(task, candidates=1, statics=True)
    assert asked.statics.verdict is Verdict.SOLVED and not asked.lacks_friction
    same = solve(task, candidates=1)
    assert np.array_equal(asked[0].state.q, same[0].state.q)
    assert solve(load_task("service"), candidates=1, statics=True).statics is None
