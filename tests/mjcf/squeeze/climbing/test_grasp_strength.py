"""The slope of a grasp's strength is that of its value."""

from dataclasses import replace
from functools import cache

import holdfast.solver
import numpy as np
import pytest
from holdfast.geometry import rotation_exp
from holdfast.mjcf import HoldSettings, preset_settings
from holdfast.mjcf.squeeze.climbing.grasp_strength import StrengthMeasure
from holdfast.mjcf.squeeze.climbing.strengthen import strengthen
from holdfast.mjcf.squeeze.load_program import LoadProgram, load_program
from holdfast.mjcf.squeeze.pads import contact_pads
from holdfast.mjcf.squeeze.sparse_rows import SparseRows
from holdfast.mjcf.squeeze.statics import ForcePoints, grasp_statics
from holdfast.objects import load_task
from holdfast.solver import Configuration, ContactManifold, State
from scipy.sparse import csr_array

# Patches against patches, points and caps; objects carried whole and in parts, at rest, turned and pressed.
TASKS = ("upholding", "incision", "lid_lifting", "transportation", "holding", "tuning", "playing")
WIDE = ("transportation", "playing")


@cache
def case(name: str) -> tuple[ContactManifold, HoldSettings, tuple[State, State]]:
    """A task's manifold, settings that no load reaches, and a state as solved and as strengthened."""
    task = load_task(name)
    configuration = holdfast.solver.solve(task, candidates=1, seed=3).configurations[0]
    settings = replace(preset_settings("holdfast", task), planned_load=1.2)
    stronger = strengthen(replace(configuration, certificate=None), settings=settings)
    return ContactManifold(task), replace(settings, planned_load=50.0), (configuration.state, stronger.state)


def displaced(manifold: ContactManifold, state: State, dx: np.ndarray) -> State:
    """The state that a tangent step leads to, limits or not: a derivative must not see them."""
    n = manifold.n_q
    R = rotation_exp(dx[n + 3 : n + 6]) @ state.R_palm_object
    return State(state.q + dx[:n], R, state.p_palm_object + dx[n : n + 3], state.params + dx[n + 6 :])


def program(
    manifold: ContactManifold,
    settings: HoldSettings,
    state: State,
    spin_arms_m: np.ndarray,
    points: ForcePoints,
) -> LoadProgram:
    """The load program of a state by way of `grasp_statics`, which the measure does without."""
    statics = grasp_statics(Configuration(manifold.task, state, 0.0, None), settings, points)
    return load_program(statics, manifold.task, state, settings, subdivisions=1, spin_arms_m=spin_arms_m)


def whole(rows: SparseRows) -> np.ndarray:
    """Rows with their zeros, by another library."""
    shape = (len(rows), rows.n_columns)
    return csr_array((rows.values, rows.columns, rows.starts), shape=shape).toarray()


@pytest.mark.parametrize("name", TASKS)
@pytest.mark.parametrize("which", [0, 1])
def test_the_slope_is_that_of_the_program(name: str, which: int) -> None:
    """y dA x by finite differences of the whole program, direction by direction."""
    manifold, settings, states = case(name)
    measure = StrengthMeasure(manifold, settings, states[0])
    here = measure.at(states[which])
    assert here.optimum is not None
    slope = measure.gradient(here)
    arms = contact_pads(Configuration(manifold.task, states[0], 0.0, None), settings).spin_arms_m()
    points = contact_pads(Configuration(manifold.task, states[0], 0.0, None), settings).force_points()
    assert name not in WIDE or len(points.contact) > points.n_contacts
    step = 1e-6
    for k in range(manifold.n_tangent):
        dx = step * np.eye(manifold.n_tangent)[k]
        there = (displaced(manifold, here.state, sign * dx) for sign in (1.0, -1.0))
        ends = [program(manifold, settings, state, arms, points) for state in there]
        if here.balanced:
            x = here.optimum.x[: ends[0].n_unknowns]
            equal, upper = (
                whole(getattr(ends[0].rows, name)) - whole(getattr(ends[1].rows, name))
                for name in ("A_eq", "A_ub")
            )
            expected = here.optimum.equal @ equal[: len(here.optimum.equal)] @ x
            expected += here.optimum.upper @ upper @ x
        else:
            edges = here.optimum.x[: ends[0].balance.shape[1]]
            expected = here.optimum.equal[:6] @ (ends[0].balance - ends[1].balance) @ edges
        assert slope[k] == pytest.approx(expected / (2.0 * step), rel=1e-5, abs=1e-6 * np.abs(slope).max())


@pytest.mark.parametrize("stronger", [False, True])
def test_the_slope_is_that_of_the_value(stronger: bool, configurations: tuple[Configuration, ...]) -> None:
    """Both measures: unbalanced contact forces of a fresh configuration, the load of a stronger one."""
    manifold = ContactManifold(configurations[0].task)
    measure = StrengthMeasure(manifold, HoldSettings(), configurations[0].state)
    weak = [c for c in configurations if measure.at(c.state).value < 0.0]
    if stronger:
        weak = [
            strengthen(replace(c, certificate=None), settings=HoldSettings(planned_load=0.4)) for c in weak
        ]
    here = next(here for c in weak if (here := measure.at(c.state)).balanced is stronger)
    slope = measure.gradient(here)
    rng = np.random.default_rng(0)
    for _ in range(5):
        dx = rng.normal(size=manifold.n_tangent)
        ends = [measure.at(displaced(manifold, here.state, sign * 1e-5 * dx)).value for sign in (1, -1)]
        assert slope @ dx == pytest.approx((ends[0] - ends[1]) / 2e-5, rel=0.05, abs=1e-3)


@pytest.mark.parametrize("name", ["upholding", "lid_lifting", "service"])
def test_the_value_does_not_depend_on_what_was_measured_before(name: str) -> None:
    """Where forces balanced before, balance is first taken for granted: and seen to be missing."""
    manifold, settings, (solved, stronger) = case(name)
    before = StrengthMeasure(manifold, settings, solved)
    for state in (stronger, solved, stronger, stronger):
        alone = StrengthMeasure(manifold, settings, solved).at(state)
        found = before.at(state)
        assert found.value == pytest.approx(alone.value, rel=1e-6, abs=1e-9)
        assert found.balanced == alone.balanced
