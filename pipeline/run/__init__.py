"""The stages chained into a run that can be stopped and gone on with."""

from .run import run_task
from .settings import RunSettings
from .stages import new_grasp, with_clearing, with_trial, without_squeeze

__all__ = ["RunSettings", "new_grasp", "run_task", "with_clearing", "with_trial", "without_squeeze"]
