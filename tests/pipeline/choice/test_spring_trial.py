"""The trial by springs: laws of balance, and MuJoCo's hold tests as an oracle that shares no code with it."""

import numpy as np
import pytest
from holdfast.mjcf import Grasp, preset_settings
from holdfast.mjcf.squeeze import auc
from holdfast.pipeline.choice import load_dataset, task_of, to_grasp
from holdfast.pipeline.choice.spring_trial import LARGEST_STRAIN, _Springs, spring_strains

from .shipped import shipped_situation

DATA = load_dataset()
NAMES = ("f_spring_squeeze", "f_spring_hold", "f_spring_hold_2")


def columns() -> np.ndarray:
    return DATA.features[:, [DATA.feature_names.index(name) for name in NAMES]]


@pytest.fixture(scope="module")
def grasps() -> list[Grasp]:
    """Candidates of a situation of the shipped data set."""
    situation, candidates = shipped_situation(0)
    task = task_of(situation, "shipped")
    settings = preset_settings("holdfast", task)
    return [to_grasp(candidate, task, settings, "shipped") for candidate in candidates[:3]]


def test_kept_strains_are_those_of_the_kept_grasps(grasps: list[Grasp]) -> None:
    for grasp, kept in zip(grasps, columns(), strict=False):
        assert spring_strains(grasp.configuration, grasp.squeeze, grasp.squeeze.settings) == pytest.approx(
            tuple(kept), abs=1e-4
        )


def test_a_load_only_adds_to_the_squeeze() -> None:
    squeeze, hold, twice = columns().T
    assert (squeeze >= 0.0).all() and (twice <= LARGEST_STRAIN).all()
    assert (hold >= squeeze).all() and (twice >= squeeze).all() and twice.mean() > hold.mean()


def test_what_is_in_its_place_stays_there(grasps: list[Grasp]) -> None:
    """Nothing is off, so planned forces balance, and the squeeze moves nothing."""
    for grasp in grasps:
        springs = _Springs(grasp.configuration, grasp.squeeze, grasp.squeeze.settings)
        place, _ = springs.squeezed(np.zeros((1, 6)), np.array([0.6]))
        assert springs.strain(place, grasp.squeeze.settings) < 0.05


def test_a_heavier_load_moves_the_object_farther(grasps: list[Grasp]) -> None:
    grasp = grasps[0]
    settings = grasp.squeeze.settings
    springs = _Springs(grasp.configuration, grasp.squeeze, settings)
    still, friction = np.zeros((4, 6)), np.full(4, 0.6)
    place, slid = springs.squeezed(still, friction)
    loads = springs.weights(np.array([0.0, 0.2, 0.4, 8.0]), np.zeros((4, 3)), settings)[:, 0]
    strain = springs.strain(springs.loaded(place, slid, friction, loads) - place, settings)
    assert strain[0] < 0.01 and (np.diff(strain) > 0.0).all()
    # Before anything slides, twice the load goes twice as far.
    assert strain[2] == pytest.approx(2.0 * strain[1], rel=0.2)


@pytest.mark.parametrize("load", [0, 1])
def test_strains_tell_what_simulation_finds(load: int) -> None:
    """Within situations they order what MuJoCo held before what it did not."""
    strains = columns()[:, 1 + load]
    found = [
        auc(-strains[rows], DATA.held[rows, draw, load])
        for rows in DATA.groups()
        for draw in range(DATA.held.shape[1])
    ]
    assert np.mean([value for value in found if value is not None]) > 0.6
