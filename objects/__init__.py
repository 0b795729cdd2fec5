"""Objects and tasks: shape, convex pieces, mass, friction, regions; the built-in ones and the user's own."""

from .object_library import builtin_objects, load_object
from .object_model import ObjectModel, Part
from .physical_test import LiftTest, PhysicalTest, PressTest, TurnTest, describe_test
from .task import Contact, ObjectRegion, Task
from .task_library import builtin_tasks, load_task

__all__ = [
    "Contact",
    "LiftTest",
    "ObjectModel",
    "ObjectRegion",
    "Part",
    "PhysicalTest",
    "PressTest",
    "Task",
    "TurnTest",
    "builtin_objects",
    "builtin_tasks",
    "describe_test",
    "load_object",
    "load_task",
]
