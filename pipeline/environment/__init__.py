"""Environments in Gymnasium's form: choose among K verified grasps, over a table or live physics.

What is asked for is imported then: a table needs neither solver nor simulator.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

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


def __getattr__(name: str) -> Any:
    for home, names in _HOMES.items():
        if name in names:
            value = getattr(import_module(f".{home}", __name__), name)
            globals()[name] = value
            return value
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
