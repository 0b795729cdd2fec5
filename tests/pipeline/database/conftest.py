"""Run folders that no run has made: any number of grasps, at no cost."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from holdfast.base.files.output_file import write_json
from holdfast.pipeline.records import RunRecord, to_json


def made_grasp(k: int, rng: np.random.Generator) -> dict[str, object]:
    """A grasp with numbers that mean nothing, as far as it may have come: solved, clear, tested, held."""
    stage = int(rng.integers(4))
    quaternion = rng.normal(size=4)
    grasp: dict[str, object] = {
        "id": f"g{k:02d}",
        "joints": {f"joint_{i}": float(rng.normal()) for i in range(5)},
        "object": {
            "position": rng.normal(size=3).tolist(),
            "quaternion": (quaternion / np.linalg.norm(quaternion)).tolist(),
        },
        "parameters": rng.uniform(size=4).tolist(),
        "contacts": [
            {"hand": "index/tip", "object": "side", "point": [0.1, -0.0, 1e-300], "normal": [0, 0, 1],
             "gap": float(rng.normal()), "normal_angle": 0.0}
        ],
        "certified": bool(rng.integers(2)),
        "residual": float(abs(rng.normal())),
    }  # fmt: skip
    if stage >= 1:
        grasp["clearance"] = {
            "before": -0.001, "after": float(rng.normal()), "status": "retracted", "worst_pair": ["a", "b"],
        }  # fmt: skip
        grasp["quality"] = {"epsilon": float(rng.uniform())}
    if stage >= 2:
        held = stage == 3
        direction = {
            "gravity": [0.0, 0.0, -9.81], "held": held, "outcome": "held" if held else "slipped",
            "slip": 0.001 if held else None, "rotation": 0.1, "curve": [(0.0, 0.0), (1.0, 0.001)],
        }  # fmt: skip
        squeeze = {"targets": {"joint_0": 0.1}, "normal_forces": [3.0, 4.0], "load_factor": 1.5}
        grasp["hold"] = {
            "preset": "holdfast", "settings": {"gravity": 9.81, "directions": [[1.0, 0.0, 0.0]]},
            "held": held, "narrow": False, "margin": 2.5 if held else None, "directions": [direction],
            "squeeze": squeeze,
        }  # fmt: skip
    return grasp


@pytest.fixture
def make_run(tmp_path: Path) -> Callable[..., Path]:
    """Makes a run folder below the test's folder with so many grasps."""

    def make(name: str = "run", count: int = 8, seed: int = 0) -> Path:
        rng = np.random.default_rng(seed)
        rounds = [{"seed": 0, "verdict": "solved", "seconds": 1, "boxes": 2, "lps": 3, "found": count}]
        record = RunRecord.model_validate(
            {
                "holdfast": "0.1.0", "task": "pinch <&> \u00e9", "task_source": "upholding",
                "task_fingerprint": "0" * 16, "hand": "sa", "object": "box", "seed": seed,
                "made": {"date": "2026-01-01T00:00:00+00:00", "system": "Linux x86_64", "cores": 2,
                         "workers": 1, "budget": 60.0, "versions": {"numpy": "2.0"}},
                "settings": {"candidates": count, "hold.friction": None},
                "verdict": "held", "complete": True,
                "solve": {"verdict": "solved", "seconds": 1, "boxes": 2, "lps": 3, "sigma": 0.1,
                          "rounds": rounds},
                "grasps": [made_grasp(k + 1, rng) for k in range(count)],
            }
        )  # fmt: skip
        folder = tmp_path / "runs" / name
        write_json(folder / "run.json", to_json(record))
        return folder

    return make
