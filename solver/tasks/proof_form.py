"""A task's polynomial system, as a proof log holds it."""

from typing import Any

from ...objects import Task
from ..formulate import formulate
from ..polynomial import canonical_form
from ..proof import form_data

__all__ = ["task_form"]


def task_form(task: Task) -> dict[str, Any]:
    """The canonical form of a task's system, as plain data for `holdfast.check_proof` to compare a log with.

    `check_proof(log, task_form(task))` says whether the log proves that this very task is infeasible.
    """
    return form_data(canonical_form(formulate(task).system))
