"""Environments in Gymnasium's form: choose among K verified grasps, over a table or live physics.

What is asked for is imported then: a table needs neither solver nor simulator.
"""

from typing import TYPE_CHECKING

from ...base.machine.late_names import late_names

if TYPE_CHECKING:
    from .choice_env import ChoiceEnv
    from .known_task_env import FRICTIONS, WEIGHTS, GraspChoiceEnv
    from .physics import NothingToChoose, Physics
    from .reward import Reward
    from .table import Table
    from .vector_env import TableVectorEnv

__all__ = [
    "FRICTIONS",
    "WEIGHTS",
    "ChoiceEnv",
    "GraspChoiceEnv",
    "NothingToChoose",
    "Physics",
    "Reward",
    "Table",
    "TableVectorEnv",
]

_HOMES = {
    "known_task_env": ("FRICTIONS", "WEIGHTS", "GraspChoiceEnv"),
    "choice_env": ("ChoiceEnv",),
    "physics": (
        "NothingToChoose",
        "Physics",
    ),
    "reward": ("Reward",),
    "table": ("Table",),
    "vector_env": ("TableVectorEnv",),
}

__getattr__, __dir__ = late_names(globals(), _HOMES)
