"""Grasps in their written form with their evidence, as a run leaves them, made without simulation."""

import json
from dataclasses import asdict
from typing import Any

from holdfast.evidence import find_evidence
from holdfast.grasping import ReadyGrasp
from holdfast.mjcf import kind_of_test
from holdfast.pipeline.records import (
    GraspRecord,
    Hold,
    Squeeze,
    approach_record,
    as_written,
    to_json,
    to_solution,
    updated,
)
from holdfast.pipeline.run.stages import with_evidence


def written_grasp(grasp: ReadyGrasp) -> dict[str, Any]:
    """What a grasp file says of a grasp that was not simulated."""
    configuration, squeeze = grasp.configuration, grasp.squeeze
    task = configuration.task
    hold = Hold(
        preset=squeeze.settings.preset,
        settings=asdict(squeeze.settings),
        kind=kind_of_test(task),
        held=False,
        squeeze=Squeeze(targets={}, load_factor=squeeze.load_factor, spin_arms=squeeze.spin_arms_m.tolist()),
    )
    record = updated(
        GraspRecord.model_validate(to_solution(configuration, "g01").model_dump()),
        approach=approach_record(grasp.approach, task.hand),
        hold=hold,
    )
    found = find_evidence(task, as_written(configuration.state), squeeze=squeeze, approach=grasp.approach)
    read: dict[str, Any] = json.loads(json.dumps(to_json(with_evidence(record, found))))
    return read
