"""A task's contacts as a system, and which of its columns say where on the object's regions they are."""

from typing import Any

import numpy as np

from ...arrays import Indices
from ...objects import Task
from ..contacts import PATCH, ContactManifold
from ..formulate import formulate
from ..polynomial import canonical_form
from ..proof import form_data

__all__ = ["hand_form", "region_params"]


def region_params(task: Task) -> list[Indices | None]:
    """For each contact which (2,) of a state's parameters are on the object's patch; None without one."""
    tables = ContactManifold(task).tables
    firsts, kinds = tables.first_param[1::2].tolist(), tables.kind[1::2].tolist()
    return [np.arange(f, f + 2) if kind == PATCH else None for f, kind in zip(firsts, kinds, strict=True)]


def hand_form(task: Task) -> dict[str, Any]:
    """What a log says of the hand: the system of `task_form`, and the columns of the object's patches."""
    formulation = formulate(task)
    return {
        "system": form_data(canonical_form(formulation.system)),
        "columns": [
            None if at is None else formulation.param_inputs[at].tolist() for at in region_params(task)
        ],
    }
