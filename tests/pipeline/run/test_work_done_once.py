"""Within a run nothing is certified, planned or simulated again because it went through its written form."""

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from holdfast.base.numeric.arrays import Array
from holdfast.mjcf import hold_test, plan_squeeze
from holdfast.pipeline.run import RunSettings, run_task
from holdfast.solver import State, certify_state, solve


def recorded(patch: pytest.MonkeyPatch, function: Callable[..., Any]) -> list[tuple[Any, ...]]:
    """Has each call of a function recorded, as its first arguments, wherever it is imported."""
    calls: list[tuple[Any, ...]] = []

    def call(*args: Any, **options: Any) -> Any:
        calls.append(args)
        return function(*args, **options)

    for name, module in list(sys.modules.items()):
        if name.startswith("holdfast"):
            for alias, value in list(vars(module).items()):
                if value is function:
                    patch.setattr(module, alias, call)
    return calls


def row_of(state: State) -> Array:
    """All numbers of a state (n,)."""
    return np.concatenate([state.q, state.p_palm_object, state.R_palm_object.ravel(), state.params])


@pytest.mark.usefixtures("small_pictures")
def test_a_run_plans_and_simulates_each_grasp_once_and_certifies_no_state_twice(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    certified = recorded(monkeypatch, certify_state)
    squeezed = recorded(monkeypatch, plan_squeeze)
    # Other squeezes of a grasp that does not stand the usual one have plans of their own.
    monkeypatch.setattr("holdfast.mjcf.squeeze.alternatives.plan_squeeze", plan_squeeze)
    tested = recorded(monkeypatch, hold_test)
    asked = recorded(monkeypatch, solve)
    record = run_task("upholding", tmp_path, RunSettings(candidates=3, wanted=1))
    best = record.grasps[0]
    assert record.complete and best.is_held
    assert (tmp_path / "media" / f"{best.id}_hold.png").is_file()  # the film shows the test of the run
    simulated = [grasp for grasp in record.grasps if grasp.hold is not None and grasp.hold.directions]
    assert len(asked) == 1
    assert len(squeezed) == sum(grasp.is_clear for grasp in record.grasps) == 3
    # Once with the usual squeeze; others come in only where that one moves the object.
    usual = [grasp for (grasp,) in tested if not grasp.squeeze.rule]
    assert len(usual) == len(simulated) == 3
    assert len({id(grasp) for (grasp,) in tested}) == len(tested)
    # Once as the solver's record has it, and then only where strengthening or retraction has moved it.
    # What is proved beside the verdicts speaks of the written numbers, and certifies them at the end.
    states = [row_of(state) for _, state in certified]
    states, proved = states[:-3], states[-3:]
    assert all(min(np.abs(state - other).max() for other in states) < 1e-9 for state in proved)
    assert len(states) >= len(record.grasps)
    apart = [np.abs(a - b).max() for i, a in enumerate(states) for b in states[:i]]
    assert min(apart) > 1e-6


@pytest.mark.usefixtures("small_pictures")
def test_a_resumed_run_draws_what_it_reads(
    run_path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It has no other way than the written form; the pictures are those of the unbroken run, or nearly so."""
    path = tmp_path / "resumed"

    def tested_all() -> bool:
        return len(list(path.glob("grasps/*.json"))) == 3

    stopped = run_task("upholding", path, RunSettings(candidates=3, wanted=1), should_stop=tested_all)
    assert not stopped.complete and all(grasp.is_done for grasp in stopped.grasps)
    tested = recorded(monkeypatch, hold_test)
    record = run_task("upholding", path, RunSettings(candidates=3, wanted=1), resume=True)
    assert record.complete and len(tested) == 1
    drawn = sorted(file.name for file in (path / "media").iterdir())
    assert drawn == sorted(file.name for file in (run_path / "media").iterdir())
