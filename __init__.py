"""Holdfast: certified grasp synthesis with specified contact regions, retraction and a hold test.

`import holdfast as hf` is quick: what it offers (see `holdfast.api`) is imported when it is first asked for.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .gymnasium_ids import register_environments

if TYPE_CHECKING:
    from .api import (
        Grasp,
        MeshRun,
        Root,
        Roots,
        Run,
        best,
        hold,
        hold_many,
        load_configuration,
        make_grasp,
        roots,
        run,
        suggest,
    )
    from .errors import HoldfastError, InputError, MissingBackend, UnknownName
    from .hands import builtin_hands, load_hand
    from .objects import (
        LiftTest,
        PressTest,
        Task,
        TurnTest,
        builtin_objects,
        builtin_tasks,
        load_object,
        load_task,
    )
    from .solver import solve, solve_all

    __version__: str

__all__ = [
    "Grasp",
    "HoldfastError",
    "InputError",
    "LiftTest",
    "MeshRun",
    "MissingBackend",
    "PressTest",
    "Root",
    "Roots",
    "Run",
    "Task",
    "TurnTest",
    "UnknownName",
    "__version__",
    "best",
    "builtin_hands",
    "builtin_objects",
    "builtin_tasks",
    "hold",
    "hold_many",
    "load_configuration",
    "load_hand",
    "load_object",
    "load_task",
    "make_grasp",
    "roots",
    "run",
    "solve",
    "solve_all",
    "suggest",
]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = _version() if name == "__version__" else getattr(import_module(".api", __name__), name)
    globals()[name] = value
    return value


def _version() -> str:
    from importlib.metadata import PackageNotFoundError, version  # slow: it reads every installed package

    try:
        return version("holdfast")
    except PackageNotFoundError:  # the tree was imported without being installed
        return "0+unknown"


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


register_environments()
