"""What is proved of a grasp beside its verdict, for its record: about the numbers as they are written."""

from pathlib import Path

from ...evidence import find_evidence
from ...mjcf import HoldSettings
from ...objects import Task
from ...retraction import RetractionSettings
from ..records import to_approach, to_state
from .recorded_grasp import to_grasp
from .stages import GraspT, with_evidence

__all__ = ["proved"]


def proved(record: GraspT, task: Task, settings: HoldSettings, source: str | Path) -> GraspT:
    """The record with its evidence, for `check-proof` to check.

    Args:
        record: of a grasp; what it had before is replaced.
        task: the task it is of.
        settings: those that its squeeze was planned for.
        source: where the record stands or will stand, for messages.
    """
    tried = to_grasp(record, task, settings, source)
    approach = None if record.approach is None else to_approach(record.approach, task.hand, source)
    margin_m = 0.0 if record.clearance is None else record.clearance.margin
    found = find_evidence(
        task,
        to_state(record, task, source),
        squeeze=None if tried is None else tried.squeeze,
        approach=approach,
        retraction=RetractionSettings(margin_m=margin_m),
    )
    return with_evidence(record, found)
