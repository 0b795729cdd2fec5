"""Grippers as their makers publish them, imported with pads that decimals leave askew."""

import os
import runpy
from pathlib import Path

import numpy as np
import pytest
from holdfast.solver import Verdict, solve

ROOT = Path(__file__).resolve().parents[3]
MODELS = Path(os.environ.get("HOLDFAST_SHARED") or ROOT.parent / "shared") / "models"
JAWS = runpy.run_path(str(ROOT / "benchmarks" / "parts" / "jaws.py"))


@pytest.fixture(params=JAWS["PUBLIC"])
def gripper(request, tmp_path):
    if not MODELS.is_dir():
        pytest.skip(f"the models of public hands are not here ({MODELS}); HOLDFAST_SHARED names their folder")
    return JAWS["public_hand"](request.param, MODELS, tmp_path)


def test_its_pads_lie_flat_on_what_is_flat_and_along_cans(gripper, tmp_path):
    for name in ("box", "sheet", "tin ends", "can"):
        task = JAWS["jaw_task"](gripper, JAWS["thing"](name, tmp_path))
        result = solve(task, candidates=3, budget_s=60.0)
        assert result.verdict is Verdict.SOLVED
        for configuration in result.configurations:
            assert configuration.certified
            assert np.degrees(max(configuration.certificate.opposed_within_rad)) < 1e-3


def test_a_cone_is_none_of_these(gripper, tmp_path):
    task = JAWS["jaw_task"](gripper, JAWS["thing"]("cone", tmp_path))
    assert solve(task, candidates=1, budget_s=60.0).verdict is Verdict.INFEASIBLE


def test_its_parallel_axes_are_made_parallel(gripper):
    assert any("made parallel" in note for note in gripper.notes)
    directions = np.array([axis.direction for axis in gripper.axes])
    assert np.linalg.norm(directions, axis=1) == pytest.approx(1.0, abs=1e-15)
