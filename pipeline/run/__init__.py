"""The stages chained into a run that can be stopped and gone on with."""

from .run import RunSettings, run_task
from .stages import Extras, clear_grasp, hold_grasp, place_grasp

__all__ = ["Extras", "RunSettings", "clear_grasp", "hold_grasp", "place_grasp", "run_task"]
