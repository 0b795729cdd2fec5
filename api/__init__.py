"""The front door for Python: `import holdfast as hf` offers all that this room lists.

task = hf.load_task("upholding")
grasp = hf.make_grasp(hf.solve(task, candidates=3)[0])
if grasp:
print(hf.hold(grasp))
"""

from ..errors import HoldfastError, InputError, MissingBackend, UnknownName
from ..hands import builtin_hands, load_hand
from ..objects import (
    LiftTest,
    PressTest,
    Task,
    TurnTest,
    builtin_objects,
    builtin_tasks,
    load_object,
    load_task,
)
from ..solver import solve, solve_all
from .best_grasp import best
from .grasp import Grasp, hold, hold_many, load_configuration, make_grasp
from .polynomial_roots import Root, Roots, roots
from .suggestions import suggest
from .whole_run import MeshRun, Run, run

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
