"""Runs of an object that has no task: from a mesh file to held grasps."""

from .outcome import Attempt, ObjectRun
from .request import GraspRequest, ObjectFiles
from .run_object import run_object

__all__ = ["Attempt", "GraspRequest", "ObjectFiles", "ObjectRun", "run_object"]
