"""Objects and tasks: shape, convex pieces, mass, friction, regions; the built-in ones and the user's own."""

from ..geometry.solids import MESH_FORMATS, light_mesh, looks_like_mesh, paint_files, read_mesh
from .contact import Contact, ObjectRegion
from .fit import Fit, fit_largest, fit_patch
from .object_library import ObjectSource, builtin_objects, load_object, names_object
from .object_model import ObjectModel, Part
from .physical_test import SIX, LiftTest, PhysicalTest, PressTest, TurnTest, describe_test, sphere
from .region_check import object_placement
from .size import UNITS_M, check_size, metres
from .standing_out import standing_out
from .task import Task, narrowed_limits
from .task_library import builtin_tasks, load_task
from .task_reference import split_reference, with_hand

__all__ = [
    "MESH_FORMATS",
    "SIX",
    "UNITS_M",
    "Contact",
    "Fit",
    "LiftTest",
    "ObjectModel",
    "ObjectRegion",
    "ObjectSource",
    "Part",
    "PhysicalTest",
    "PressTest",
    "Task",
    "TurnTest",
    "builtin_objects",
    "builtin_tasks",
    "check_size",
    "describe_test",
    "fit_largest",
    "fit_patch",
    "light_mesh",
    "load_object",
    "load_task",
    "looks_like_mesh",
    "metres",
    "names_object",
    "narrowed_limits",
    "object_placement",
    "paint_files",
    "read_mesh",
    "sphere",
    "split_reference",
    "standing_out",
    "with_hand",
]
