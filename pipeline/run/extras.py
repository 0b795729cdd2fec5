"""The job that finds out more about a grasp that held: how much it would hold, and by which settings."""

from dataclasses import dataclass

from ...grasping import Extras, find_extras
from ...mjcf import Grasp
from .crew import CrewSetup

__all__ = ["FindExtras"]


@dataclass(frozen=True, eq=False)
class FindExtras:
    """Margin and agreement of a grasp that has passed its test.

    Attributes:
        grasp: as its record has it.
    """

    grasp: Grasp

    def work(self, setup: CrewSetup) -> Extras:
        """Simulates what it takes."""
        return find_extras(self.grasp, held=True, settings=setup.hold, margin=True, agreement=True)

    def given_up(self, setup: CrewSetup) -> Extras:
        """Nothing is known beside the verdict."""
        return Extras()
