"""Grasps as given are tried with the squeezes of their files; certified ones go out as they came."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from holdfast.geometry import pose
from holdfast.pipeline.formats import GraspFile, JointValues, Posture, read_grasps
from holdfast.pipeline.verify import GivenObject, JudgeSettings, as_record, reading_lines, verify, write_fixed

from .made import GRIPPER, file_of, gripper

GIVEN = GivenObject(str(GRIPPER / "block.yaml"))
ANSWERS = {"quaternion": "wxyz", "length": "m", "frame": "base"}


def with_squeezes(shares: list[float | None]) -> GraspFile:
    """The block between the pads, which squeeze by so many metres more; None for grasps without."""
    T = np.linalg.inv(pose(np.eye(3), np.array([0.0, 0.0, 0.09])))
    joints = np.array([-0.01, 0.01])
    # A gripper that stands alike in every grasp would be taken for one that has still to close.
    rows = np.array([joints * (1.0 + 1e-6 * i) for i in range(len(shares))])
    file = file_of(np.tile(T, (len(shares), 1, 1)), rows)
    squeezes = [None if s is None else Posture(None, JointValues(joints * (1.0 - s / 0.01))) for s in shares]
    pairs = zip(file.grasps, squeezes, strict=True)
    return replace(file, grasps=tuple(replace(grasp, squeeze=squeeze) for grasp, squeeze in pairs))


def test_the_squeeze_of_the_file_decides_and_the_record_says_so() -> None:
    settings = JudgeSettings(("holdfast",), nearby=False)
    found = verify([with_squeezes([0.0, 0.004])], gripper(), GIVEN, ANSWERS, settings)
    (read,) = found.pools
    assert read.squeezes == pytest.approx(np.array([[-0.01, 0.01], [-0.006, 0.006]]))
    assert any("squeezes of its own" in line for line in reading_lines(read))
    trials = [grasp.judged.trials["holdfast"] for grasp in found.grasps]
    # Pads that only touch let the block fall, which one of our own squeezes would not.
    assert [trial.held for trial in trials] == [False, True]
    record = as_record(found)
    assert record["readings"][0]["squeezes"] is True
    assert {grasp["presets"]["holdfast"]["squeezed_by"] for grasp in record["grasps"]} == {"file"}


def test_where_a_grasp_has_none_squeezes_are_planned() -> None:
    settings = JudgeSettings(("holdfast",), nearby=False)
    found = verify([with_squeezes([0.0, None])], gripper(), GIVEN, ANSWERS, settings)
    assert found.pools[0].squeezes is None
    assert {grasp.judged.trials["holdfast"].squeezed_by for grasp in found.grasps} == {"plan"}
    assert all(grasp.judged.trials["holdfast"].held for grasp in found.grasps)


@pytest.mark.parametrize(("format_", "suffix"), [("multigrippergrasp", ".json"), ("graspit", ".yaml")])
def test_certified_grasps_go_out_in_the_format_they_came_in(
    format_: str, suffix: str, tmp_path: Path
) -> None:
    file = replace(with_squeezes([None]), format=format_)
    found = verify([file], gripper(), GIVEN, ANSWERS, JudgeSettings((), nearby=True))
    assert found.fixed == 1
    (path,) = write_fixed(found, tmp_path)
    assert path.name == f"fixed_{format_}{suffix}"
    assert read_grasps(path).format == ("isaac_grasp" if suffix == ".yaml" else format_)
