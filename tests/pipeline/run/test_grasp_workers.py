"""What comes out of the stages does not depend on the number of workers."""

from pathlib import Path

from holdfast.mjcf import HoldSettings
from holdfast.objects import load_task
from holdfast.pipeline.records.convert import to_solution
from holdfast.pipeline.records.records import GraspRecord
from holdfast.pipeline.run.grasp_workers import GraspJob, try_grasps
from holdfast.retraction import RetractionSettings
from holdfast.solver import solve


def test_workers_change_nothing() -> None:
    task = load_task("upholding")
    found = solve(task, candidates=3, seed=0).configurations
    grasps = [
        GraspRecord.model_validate(dict(to_solution(configuration, f"g{i:02d}")))
        for i, configuration in enumerate(found)
    ]
    short = HoldSettings(directions=((0.0, 0.0, 1.0),), hold_s=0.1, squeeze_s=0.1, settle_s=0.1)
    job = GraspJob("upholding", Path("run.json"), short, RetractionSettings())
    alone = list(try_grasps(grasps, job, task, workers=1, should_stop=lambda: False))
    together = list(try_grasps(grasps, job, task, workers=2, should_stop=lambda: False))
    assert alone == together
    assert [tried.record.id for tried in alone] == [grasp.id for grasp in grasps]


def test_nothing_new_is_begun_once_it_should_stop() -> None:
    task = load_task("upholding")
    grasp = GraspRecord.model_validate(dict(to_solution(solve(task, candidates=1).configurations[0], "g01")))
    job = GraspJob("upholding", Path("run.json"), HoldSettings(), RetractionSettings())
    assert list(try_grasps([grasp, grasp], job, task, workers=2, should_stop=lambda: True)) == []
