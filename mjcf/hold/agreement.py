"""Whether a verdict is the grasp's or the simulator's: the same test with other numerical settings."""

from dataclasses import dataclass, replace

from ..model import Grasp
from ..settings import HoldSettings
from .hold import passes
from .result import HoldResult

__all__ = ["Agreement", "settings_agreement", "variants"]


@dataclass(frozen=True)
class Agreement:
    """Verdicts of one grasp.

    Attributes:
        held: the verdict to be repeated.
        variants: the verdict by each other setting.
    """

    held: bool
    variants: dict[str, bool]

    def __str__(self) -> str:
        count = sum(held == self.held for held in self.variants.values())
        verdict = "held" if self.held else "not held"
        return f"{verdict}; {count} of {len(self.variants)} other settings agree"

    @property
    def agree(self) -> bool:
        """Whether every setting says the same."""
        return all(held == self.held for held in self.variants.values())


def variants(settings: HoldSettings) -> dict[str, HoldSettings]:
    """The settings with half the time step, another solver, and twice the no-slip passes."""
    return {
        "half time step": replace(settings, timestep_s=0.5 * settings.timestep_s),
        "other solver": replace(settings, solver="Newton" if settings.solver != "Newton" else "CG"),
        "twice the no-slip passes": replace(settings, noslip_iterations=2 * settings.noslip_iterations),
    }


def settings_agreement(grasp: Grasp, result: HoldResult) -> Agreement:
    """Repeats a test with other settings.

    Args:
        grasp: the grasp; its squeeze stays as it was planned.
        result: the test to be repeated.
    """
    others = variants(result.settings)
    return Agreement(result.held, {name: passes(grasp, settings=other) for name, other in others.items()})
