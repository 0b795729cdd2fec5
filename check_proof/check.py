"""The verdict on a proof log."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .reading import Rejected, records
from .replay import Replay

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


def check_proof(path: str | Path, form: dict[str, Any] | None = None) -> ProofCheck:
    """Replays a proof log.

    Args:
        path: the log.
        form: where given, the log's system must be this one, to the last bit; for a task, plain data as
            `holdfast.solver.task_form` makes them. Without it, acceptance says that the system written in
            the log has no solution, whatever that system stands for.

    Raises:
        InputError: the file can't be read, or is no proof log of this version. A damaged one is rejected.
    """
    replay = Replay()
    try:
        with np.errstate(all="ignore"):
            replay.run(records(Path(path)), form)
    except Rejected as reason:
        return ProofCheck(False, replay.boxes, replay.steps, str(reason))
    return ProofCheck(True, replay.boxes, replay.steps, "")
