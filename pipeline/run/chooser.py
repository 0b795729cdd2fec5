"""What a run expects of whoever chooses among its grasps."""

from collections.abc import Sequence
from typing import Protocol

from ...base.numeric.arrays import Array
from ...grasping import ReadyGrasp
from ...objects import Task

__all__ = ["Chooser"]


class Chooser(Protocol):
    """Tells which of several grasps is likely to be held."""

    @property
    def policy(self) -> str:
        """Its name."""

    @property
    def digest(self) -> str:
        """Hash of all that its scores depend on."""

    def check(self, task: Task) -> None:
        """Looks whether it can judge grasps of a task.

        Raises:
            InputError: it can't, and why.
        """

    def scores(self, made: Sequence[ReadyGrasp]) -> Array:
        """Scores (n,) of grasps of one task, the highest of those to be tested first."""
