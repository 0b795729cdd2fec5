"""`holdfast check-proof FILE`, of a proof log or of a grasp file."""

import argparse
from pathlib import Path

from ....check_proof import check_grasp, check_proof
from ....console import emit, emit_json
from ....evidence import grasp_form
from ....files import read_json
from ....objects import load_task
from ....solver import task_form
from ...records import load_grasp_task, read_grasp

__all__ = ["main"]

_ACCEPTED, _REJECTED = 0, 4


def main(arguments: argparse.Namespace) -> int:
    """Replays a proof log, or what a grasp file says was proved, and says whether it is."""
    if arguments.file.endswith(".json"):
        return _check_grasp(arguments)
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


def _check_grasp(arguments: argparse.Namespace) -> int:
    """A grasp file: its contacts, balance and clearance."""
    path = Path(arguments.file)
    task = load_grasp_task(read_grasp(path), path, arguments.task)
    check = check_grasp(read_json(path), grasp_form(task))
    if arguments.json:
        emit_json(
            arguments.json,
            {
                "accepted": check.accepted,
                "slack": check.slack_N,
                "clear": check.clear,
                "approach": check.approach,
                "reason": check.reason,
                "task": task.name,
            },
        )
    if arguments.json != "-":
        if not check.accepted:
            emit(f"rejected: {check.reason}")
        else:
            said = [f"the contacts of {task.name} truly hold"]
            if check.slack_N is not None:
                said.append(f"forces balance the load with {check.slack_N:.3g} N to spare")
            if check.clear:
                said.append("nothing sinks in" + (", nor on the way there" if check.approach else ""))
            emit(f"accepted: {'; '.join(said)}")
    return _ACCEPTED if check.accepted else _REJECTED


def _sentence(accepted: bool, reason: str, task: str | None) -> str:
    if not accepted:
        return f"rejected: {reason}"
    if task is None:
        return "accepted: the system in the log has no solution; --task checks whose system it is"
    return f"accepted: {task} is infeasible"
