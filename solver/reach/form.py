"""A task's contacts as a system, and which of its columns say where on the object's regions they are."""

from typing import Any

import numpy as np

from ...arrays import Indices
from ...geometry import Patch
from ...objects import Task
from ..formulate import Formulation, formulate
from ..polynomial import canonical_form
from ..proof import form_data

__all__ = ["hand_form", "region_columns"]


def region_columns(formulation: Formulation) -> list[Indices | None]:
    """For each contact the columns (2,) of its parameters on the object's patch; None where it has none."""
    columns: list[Indices | None] = []
    first = 0
    for contact in formulation.task.contacts:
        first += 2 if isinstance(contact.hand.region, Patch) else 0
        if isinstance(contact.object.region, Patch):
            columns.append(np.asarray(formulation.param_inputs[first : first + 2]))
            first += 2
        else:
            columns.append(None)
    return columns


def hand_form(task: Task) -> dict[str, Any]:
    """What a log says of the hand: the system of `task_form`, and the columns of the object's patches."""
    formulation = formulate(task)
    return {
        "system": form_data(canonical_form(formulation.system)),
        "columns": [None if pair is None else pair.tolist() for pair in region_columns(formulation)],
    }
