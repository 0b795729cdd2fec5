"""The least friction: climbed to, refuted below, the same however it is computed."""

import numpy as np
import pytest
from holdfast.errors import InputError
from holdfast.objects import load_task
from holdfast.solver.search import SearchOrder
from holdfast.solver.statics import best_friction
from holdfast.solver.statics.climb import Climber
from holdfast.solver.statics.friction_worker import FrictionSetup
from holdfast.solver.statics.problem import statics_problem
from holdfast.solver.statics.search import StaticsSearch

from .twins import LIMITS, caps, pinch


@pytest.mark.parametrize("name", sorted(LIMITS))
def test_value_and_bound_meet_at_the_limit(name):
    best = best_friction(load_task(name), budget_s=120.0)
    assert best.bound < LIMITS[name] * (1.0 + 1e-4) and best.value > LIMITS[name] * (1.0 - 1e-4)
    assert 0.0 < best.gap <= 0.02
    climber = Climber(statics_problem(load_task(name)))
    # Right at the limit the hull's distance from the origin is lost in rounding.
    assert climber.balances(best.example.root, best.example.params, best.value * (1.0 + 1e-4))
    bounds, values = zip(*[(now.bound, now.value) for now in best.history], strict=True)
    assert list(bounds) == sorted(bounds) and list(values) == sorted(values, reverse=True)
    assert f"needs friction {np.ceil(best.value * 1e4) / 1e4:.4f}" in str(best)


def test_of_a_leaning_pinch_it_is_the_tangent():
    best = best_friction(pinch(0.3), gap=1e-3)
    assert np.isclose(best.value, np.tan(0.3), rtol=1e-5)
    assert best.value * 0.998 < best.bound < np.tan(0.3)


def test_no_sampled_points_need_less_than_is_refuted():
    for task in (load_task("handling"), load_task("upholding"), caps(1.2, 0.4)):
        best = best_friction(task, budget_s=60.0)
        climber, rng = Climber(statics_problem(task)), np.random.default_rng(1)
        sampled = [climber.random(rng) for _ in range(500)]
        assert not any(climber.balances(root, params, best.bound) for root, params in sampled)


def test_wide_contacts_need_less():
    """Faces that are parallel but set off by 6 mm each face each other over discs that reach so far."""
    task = pinch(0.3, turned=True)
    points, wide = best_friction(task), best_friction(task, reach_m=0.007)
    some = best_friction(task, reach_m=0.003)
    assert np.isclose(points.value, np.tan(0.3), rtol=1e-4)
    assert wide.needs_none and points.bound > some.value > 0.1 and some.bound > 0.9 * some.value


def test_regions_that_face_each_other_need_none():
    best = best_friction(load_task("lid_lifting"))
    assert best.needs_none and best.gap == 0.0 and "next to no friction" in str(best)


def test_regions_that_look_the_same_way_never_hold():
    best = best_friction(pinch(0.5 * np.pi))
    assert best.example is None and best.value == np.inf and best.gap == 1.0
    assert best.bound >= 1.0 and "no points were found that hold it" in str(best)


def test_a_budget_that_ends_early_leaves_what_is_known():
    best = best_friction(load_task("handling"), budget_s=0.0)
    assert best.bound <= LIMITS["handling"] < best.value < np.inf
    assert best.gap > 0.02


def search(**options) -> StaticsSearch:
    problem = statics_problem(load_task("handling"))
    setup = FrictionSetup(
        problem=problem, limit=0.95 * LIMITS["handling"], steps=3, order=SearchOrder.BEST_FIRST
    )
    return StaticsSearch(setup, **options)


def what(done: StaticsSearch) -> tuple[float, int, int]:
    """What a search has shown, and how far it went for that."""
    return done.shown, done.state.processed, done.state.depth


@pytest.mark.usefixtures("at_once")
def test_the_same_with_workers():
    alone, shared = search(), search(workers=2)
    for one in (alone, shared):
        one.finish(budget_s=120.0)
    assert what(shared) == what(alone) and alone.shown == 0.95 * LIMITS["handling"]


def test_the_same_after_a_checkpoint(tmp_path):
    whole, path = search(), tmp_path / "search.ckpt"
    whole.finish(budget_s=120.0)
    begun = search(checkpoint=path)
    begun.finish(budget_s=120.0, enough=lambda: begun.state.processed >= 20)
    assert 20 <= begun.state.processed < whole.state.processed
    resumed = search(checkpoint=path, resume=True)
    resumed.finish(budget_s=120.0)
    assert what(resumed) == what(whole)


def test_best_goes_on_from_a_checkpoint(tmp_path):
    task = load_task("handling")
    path, steps = tmp_path / "best.ckpt", []

    def stop_soon() -> bool:
        steps.append(1)
        return len(steps) >= 5

    begun = best_friction(task, gap=0.04, checkpoint=path, should_stop=stop_soon)
    assert begun.progress.boxes > 0 and begun.gap > 0.04
    resumed = best_friction(task, gap=0.04, checkpoint=path, resume=True)
    assert resumed.gap <= 0.04 and resumed.progress.boxes > begun.progress.boxes
    with pytest.raises(InputError, match="another task"):
        best_friction(task, gap=0.05, checkpoint=path, resume=True)
    with pytest.raises(InputError, match="exists"):
        best_friction(task, gap=0.04, checkpoint=path)


@pytest.mark.parametrize(
    "bad", [{"gap": 0.0}, {"gap": 1.0}, {"gap": float("nan")}, {"seed": -1}, {"workers": 0}]
)
def test_arguments_that_cannot_be_used(bad):
    with pytest.raises(InputError):
        best_friction(load_task("upholding"), **bad)
