"""The job that finds out more about a grasp that held: how much it would hold, and by which settings."""

from dataclasses import dataclass

from ...grasping import Extras, find_extras
from ...mjcf import Grasp, HoldSettings, strain
from ..records import Hold
from .crew import CrewSetup

__all__ = ["FindExtras", "strains_of"]


@dataclass(frozen=True, eq=False)
class FindExtras:
    """Margin and agreement of a grasp that has passed its test.

    Attributes:
        grasp: as its record has it.
        strains: how much of its limits each direction of gravity takes; None where the test is no lift.
    """

    grasp: Grasp
    strains: tuple[float, ...] | None = None

    def work(self, setup: CrewSetup) -> Extras:
        """Simulates what it takes."""
        return find_extras(
            self.grasp, held=True, settings=setup.hold, strains=self.strains, margin=True, agreement=True
        )

    def given_up(self, setup: CrewSetup) -> Extras:
        """Nothing is known beside the verdict."""
        return Extras()


def strains_of(hold: Hold, settings: HoldSettings) -> tuple[float, ...] | None:
    """How much of its limits each direction takes, by the record of a lift that was held; else None."""
    if hold.kind != "lift" or len(hold.directions) != len(settings.directions):
        return None
    return tuple(strain(entry.slip or 0.0, entry.rotation or 0.0, settings) for entry in hold.directions)
