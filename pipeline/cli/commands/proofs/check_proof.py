"""`holdfast check-proof FILE`, of a proof log or of a grasp file."""

import argparse
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from .....base.files.json_file import read_json
from .....base.text.console import emit, emit_json
from .....base.text.significant import significant
from .....check_proof import (
    CONFIGURATIONS,
    LOAD,
    STATICS,
    LogHead,
    ProofCheck,
    check_grasp,
    check_proof,
)
from .....evidence import grasp_form
from .....objects import Task, load_task
from .....solver import hand_form, load_form, statics_form, task_form
from ....records import load_grasp_task, read_grasp

__all__ = ["main"]

_ACCEPTED, _REJECTED = 0, 4
# What a log of each kind has to be about, for a task.
_FORMS: dict[str, Callable[[Task], dict[str, Any]]] = {
    CONFIGURATIONS: task_form,
    STATICS: statics_form,
    LOAD: load_form,
}


def main(arguments: argparse.Namespace) -> int:
    """Replays a proof log, or what a grasp file says was proved, and says whether it is."""
    if arguments.file.endswith(".json"):
        return _check_grasp(arguments)
    path, task = Path(arguments.file), load_task(arguments.task) if arguments.task else None
    check = check_proof(path, None if task is None else partial(_form, task))
    if arguments.json:
        emit_json(
            arguments.json,
            {
                "accepted": check.accepted,
                "kind": check.kind,
                "boxes": check.boxes,
                "steps": check.steps,
                "friction": check.friction,
                "multiple": check.multiple,
                "max_force": check.force_N,
                "with_hand": check.with_hand,
                "reason": check.reason,
                "task": None if task is None else task.name,
            },
        )
    if arguments.json != "-":
        emit(_sentence(check, task))
        emit(f"{check.boxes} boxes and {check.steps} steps replayed")
    return _ACCEPTED if check.accepted else _REJECTED


def _form(task: Task, head: LogHead) -> dict[str, Any]:
    """What a log with such a head has to be about, for a task."""
    form = _FORMS[head.kind](task)
    return form | {"hand": hand_form(task)} if head.may_be_of_hand else form


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
                said.append(f"forces balance the load with {significant(check.slack_N, 3)} N to spare")
            if check.clear:
                said.append("nothing sinks in" + (", nor on the way there" if check.approach else ""))
            emit(f"accepted: {'; '.join(said)}")
    return _ACCEPTED if check.accepted else _REJECTED


def _sentence(check: ProofCheck, task: Task | None) -> str:
    if not check.accepted:
        return f"rejected: {check.reason}"
    if check.friction is not None:
        return _of_statics(check, check.friction, task)
    if check.multiple is not None:
        whose = "those in the log; --task checks whose they are" if task is None else f"those of {task.name}"
        by = "by the hand " if check.with_hand else ""
        return (
            f"accepted: regions carry {by}at most {check.multiple:.6g} times the weight with "
            f"{check.force_N:g} N a contact, whichever way gravity acts: {whose}"
        )
    if task is None:
        return "accepted: the system in the log has no solution; --task checks whose system it is"
    return f"accepted: {task.name} is infeasible"


def _of_statics(check: ProofCheck, friction: float, task: Task | None) -> str:
    """What a log of statics proves of a task depends on the task's own friction."""
    who = "the hand on " if check.with_hand else ""
    holds = f"can't hold the load with friction {friction:.6g} or less"
    if task is None:
        return f"accepted: {who}the regions in the log {holds}; --task checks whose regions they are"
    if task.object.friction > friction:
        own = f"its own friction is {task.object.friction:g}"
        return f"accepted: {who}the regions of {task.name} {holds}; {own}"
    return (
        f"accepted: {task.name} is infeasible: {who}its regions {holds}, and its own is "
        f"{task.object.friction:g}"
    )
