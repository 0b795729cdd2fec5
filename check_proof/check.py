"""The verdict on a proof log."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from .load import LoadReplay
from .log_replay import LogReplay
from .reading import LOAD, STATICS, LogHead, Rejected, head_of, records
from .replay import Replay
from .statics import StaticsReplay
from .statics_tree import StaticsTree

__all__ = ["ProofCheck", "check_proof"]


@dataclass(frozen=True)
class ProofCheck:
    """What came of checking a proof log.

    Attributes:
        accepted: whether the log proves that its system has no solution.
        boxes: boxes replayed.
        steps: relaxations, bounds and rays replayed.
        reason: why the log was rejected; empty where it was accepted.
        kind: `configurations`: the log is about those of a system; `statics`: about forces that balance;
            `load`: about how much contacts carry.
        friction: of a log of statics that was accepted, the coefficient up to which it proves that no forces
            at points of its regions balance each other.
        multiple: of a log of the load that was accepted, the multiple of the weight of which it proves that
            no points of its regions carry more whichever way gravity acts.
        force_N: largest normal force that such a log allows any contact.
        with_hand: whether such a log, or one of statics, is about what a hand reaches of its regions.
    """

    accepted: bool
    boxes: int
    steps: int
    reason: str
    kind: str
    friction: float | None = None
    multiple: float | None = None
    force_N: float | None = None
    with_hand: bool = False


def check_proof(
    path: str | Path, form: dict[str, Any] | Callable[[LogHead], dict[str, Any]] | None = None
) -> ProofCheck:
    """Replays a proof log.

    Args:
        path: the log.
        form: where given, the log's system must be this one, to the last bit; for a task, plain data as
            `holdfast.solver.task_form` makes them, `statics_form` for a log of statics, or `load_form` for
            one of the load, whose largest forces are the log's own; for logs about a hand with `hand_form` as
            their `hand`; or what makes them for such a log. Without it, acceptance says that what the log
            holds has no solution, whatever that stands for.

    Raises:
        InputError: the file can't be read, or is no proof log of this version. A damaged one is rejected.
    """
    log = records(Path(path))
    first = next(log)
    head = head_of(first[1])
    kind = head.kind
    replay: LogReplay = StaticsReplay() if kind == STATICS else LoadReplay() if kind == LOAD else Replay()
    try:
        with np.errstate(all="ignore"):
            replay.run(chain([first], log), form(head) if callable(form) else form)
    except Rejected as reason:
        return ProofCheck(False, replay.boxes, replay.steps, str(reason), kind)
    accepted = ProofCheck(True, replay.boxes, replay.steps, "", kind)
    if isinstance(replay, StaticsTree):
        accepted = replace(accepted, with_hand=replay.hand is not None)
    if isinstance(replay, StaticsReplay):
        return replace(accepted, friction=replay.claimed)
    if isinstance(replay, LoadReplay):
        return replace(accepted, multiple=replay.claimed, force_N=max(replay.forces_N))
    return accepted
