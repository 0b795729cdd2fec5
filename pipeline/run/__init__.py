"""The stages chained into a run that can be stopped and gone on with."""

from .begin import folder_name, free_folder
from .chooser import Chooser
from .proving import proved
from .recorded_grasp import to_grasp
from .run import choose_folder, run_task
from .settings import RunSettings
from .stages import new_grasp, with_clearing, with_quality, with_trial, without_squeeze

__all__ = [
    "Chooser",
    "RunSettings",
    "choose_folder",
    "folder_name",
    "free_folder",
    "new_grasp",
    "proved",
    "run_task",
    "to_grasp",
    "with_clearing",
    "with_quality",
    "with_trial",
    "without_squeeze",
]
