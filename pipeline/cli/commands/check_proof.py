"""`holdfast check-proof FILE`."""

import argparse
from pathlib import Path

from ....check_proof import check_proof
from ....console import emit, emit_json
from ....objects import load_task
from ....solver import task_form

__all__ = ["main"]

_ACCEPTED, _REJECTED = 0, 4


def main(arguments: argparse.Namespace) -> int:
    """Replays a proof log and says whether it proves what it claims."""
    task = load_task(arguments.task) if arguments.task else None
    check = check_proof(Path(arguments.file), None if task is None else task_form(task))
    if arguments.json:
        emit_json(
            arguments.json,
            {
                "accepted": check.accepted,
                "boxes": check.boxes,
                "steps": check.steps,
                "reason": check.reason,
                "task": None if task is None else task.name,
            },
        )
    if arguments.json != "-":
        emit(_sentence(check.accepted, check.reason, None if task is None else task.name))
        emit(f"{check.boxes} boxes and {check.steps} steps replayed")
    return _ACCEPTED if check.accepted else _REJECTED


def _sentence(accepted: bool, reason: str, task: str | None) -> str:
    if not accepted:
        return f"rejected: {reason}"
    if task is None:
        return "accepted: the system in the log has no solution; --task checks whose system it is"
    return f"accepted: {task} is infeasible"
