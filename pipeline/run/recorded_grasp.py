"""A grasp with its squeeze as a record describes it, to be simulated again."""

from pathlib import Path

import numpy as np

from ...base.numeric.arrays import Array
from ...errors import InputError
from ...mjcf import Grasp, HoldSettings, Squeeze
from ...objects import Task
from ...solver import Configuration
from ..records import GraspRecord, to_approach, to_state

__all__ = ["to_grasp"]


def to_grasp(record: GraspRecord, task: Task, settings: HoldSettings, source: str | Path) -> Grasp | None:
    """The grasp that was tested; None where there was no squeeze, or the record is of an earlier kind.

    What the plan carries under load is not written, so `Squeeze.loaded` is empty.

    Args:
        record: of a grasp that came to a test.
        task: the task it is of.
        settings: those that its squeeze was planned for.
        source: where the record stands, for messages.

    Raises:
        InputError: a record that is none of this task, or whose squeeze is none of its hand.
    """
    squeeze = None if record.hold is None else record.hold.squeeze
    if squeeze is None or record.approach is None:
        return None
    count = len(task.contacts)
    if {len(squeeze.contact_forces), len(squeeze.spin_arms), len(squeeze.yields)} != {count}:
        return None
    if len(squeeze.centres) not in (0, count):
        return None
    names = task.hand.independent_names
    # Not proved anew, which would refine it: what was tested is the state as it is written.
    configuration = Configuration(task, to_state(record, task, source), record.residual, None)
    return Grasp(
        configuration,
        Squeeze(
            targets=_by_joint(squeeze.targets, names, source, "hold.squeeze.targets"),
            efforts=_by_joint(squeeze.efforts, names, source, "hold.squeeze.efforts"),
            preload=np.array(squeeze.contact_forces),
            loaded=np.zeros((0, count, 4)),
            load_factor=squeeze.load_factor,
            settings=settings,
            spin_arms_m=np.array(squeeze.spin_arms),
            yields_m=np.array(squeeze.yields),
            centres_m=np.array(squeeze.centres or np.zeros((count, 2))),
            rule=squeeze.rule,
            path=np.array(
                [
                    _by_joint(place, names, source, f"hold.squeeze.path.{k}")
                    for k, place in enumerate(squeeze.path)
                ]
            ),
        ),
        to_approach(record.approach, task.hand, source),
    )


def _by_joint(values: dict[str, float], names: tuple[str, ...], source: str | Path, field: str) -> Array:
    if values.keys() != set(names):
        raise InputError(source, field, f"must give the {len(names)} independent joints {', '.join(names)}")
    return np.array([values[name] for name in names])
