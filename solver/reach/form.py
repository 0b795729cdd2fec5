"""A task's contacts as a system, and which of its columns say where on the object's regions they are."""

from typing import Any

from ...objects import Task
from ..contacts import region_params
from ..formulate import formulate
from ..polynomial import canonical_form
from ..proof import form_data

__all__ = ["hand_form"]


def hand_form(task: Task) -> dict[str, Any]:
    """What a log says of the hand: the system of `task_form`, and the columns of the object's patches."""
    formulation = formulate(task)
    return {
        "system": form_data(canonical_form(formulation.system)),
        "columns": [formulation.param_inputs[where].tolist() or None for _, where in region_params(task)],
    }
