"""Certified configurations with squeezes, of tasks of every kind of test."""

import pytest
from holdfast.grasping import ReadyGrasp, make_grasp
from holdfast.mjcf import NotHoldable, Squeeze, plan_squeeze, preset_settings
from holdfast.objects import load_task
from holdfast.solver import Configuration, solve

Grasps = list[tuple[Configuration, Squeeze]]


def solved(name: str, count: int) -> Grasps:
    task = load_task(name)
    found = []
    for configuration in solve(task, candidates=count, seed=3).configurations:
        squeeze = plan_squeeze(configuration, settings=preset_settings("holdfast", task))
        if not isinstance(squeeze, NotHoldable):
            found.append((configuration, squeeze))
    return found


@pytest.fixture(scope="session")
def palm_grasp() -> ReadyGrasp:
    """One whose load is carried by a palm, over an area: no forces at points alone balance it."""
    (configuration, *_) = solve(load_task("transportation"), candidates=1, seed=7).configurations
    grasp = make_grasp(configuration)
    assert isinstance(grasp, ReadyGrasp)
    return grasp


@pytest.fixture(scope="session")
def grasps() -> Grasps:
    """Lifts of two, three and four contacts, a turn and a press; balanced and not, some wide of clear."""
    return [
        grasp
        for name in ("upholding", "handling", "service", "incision", "tuning", "playing")
        for grasp in solved(name, 3)
    ]
