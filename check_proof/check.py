"""The verdict on a proof log."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .reading import Rejected, records
from .replay import Replay

if TYPE_CHECKING:
    from ..objects import Task

__all__ = ["ProofCheck", "check_proof"]


@dataclass(frozen=True)
class ProofCheck:
    """What came of checking a proof log.

    Attributes:
        accepted: whether the log proves that its system has no solution.
        boxes: boxes replayed.
        steps: relaxations, bounds and rays replayed.
        reason: why the log was rejected; empty where it was accepted.
    """

    accepted: bool
    boxes: int
    steps: int
    reason: str


def check_proof(path: str | Path, task: "Task | None" = None) -> ProofCheck:
    """Replays a proof log.

    Args:
        path: the log.
        task: where given, the log's system must be this task's, to the last bit. Without a task, acceptance
            says that the system written in the log has no solution, whatever that system stands for.

    Raises:
        InputError: the file can't be read, or is no proof log of this version. A damaged one is rejected.
    """
    replay = Replay()
    try:
        with np.errstate(all="ignore"):
            replay.run(records(Path(path)), None if task is None else _system_of(task))
    except Rejected as reason:
        return ProofCheck(False, replay.boxes, replay.steps, str(reason))
    return ProofCheck(True, replay.boxes, replay.steps, "")


def _system_of(task: "Task") -> Any:
    """The system that the package makes of a task, as a log writes it."""
    from ..solver.formulate import formulate
    from ..solver.polynomial import canonical_form
    from ..solver.proof import form_data

    return form_data(canonical_form(formulate(task).system))
