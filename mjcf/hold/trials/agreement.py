"""Whether a verdict is the grasp's or the simulator's: the same test with other numerical settings."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from ...model import Grasp
from ...settings import Direction, HoldSettings
from ..checks import trial_settings
from ..hold import closed_hand, passes
from ..lift import Lift
from ..result import HoldResult

__all__ = ["Agreement", "settings_agreement", "variants", "verdict_agreement"]

# Ratio of frictional to normal impedance that keeps creep small without no-slip passes, and the largest one
# that all solvers can handle.
_STIFF, _CONVERGING = 1000.0, 10.0
# So many of the directions in which a grasp gives way first decide for all.
_DECISIVE = 2


@dataclass(frozen=True)
class Agreement:
    """Verdicts of one grasp.

    Attributes:
        held: the verdict to be repeated.
        variants: the verdict by each other setting.
        directions: of gravity in which others were tried, of a lift; empty for all of them.
    """

    held: bool
    variants: dict[str, bool]
    directions: tuple[Direction, ...] = ()

    def __str__(self) -> str:
        count = sum(held == self.held for held in self.variants.values())
        verdict = "held" if self.held else "not held"
        return f"{verdict}; {count} of {len(self.variants)} other settings agree"

    @property
    def agree(self) -> bool:
        """Whether every setting says the same."""
        return all(held == self.held for held in self.variants.values())


def variants(settings: HoldSettings) -> dict[str, HoldSettings]:
    """The settings with half the time step, another solver, and the other way against creep."""
    if settings.noslip_iterations:
        name, other = "no no-slip passes", replace(settings, noslip_iterations=0, impratio=_STIFF)
    else:
        name, other = "no-slip passes", replace(settings, noslip_iterations=20, impratio=_CONVERGING)
    # First-order solvers do not converge where friction is a thousand times as stiff as the normal direction.
    solved = settings if settings.impratio <= _CONVERGING else other
    return {
        "half time step": replace(settings, timestep_s=0.5 * settings.timestep_s),
        "other solver": replace(solved, solver="Newton" if settings.solver != "Newton" else "CG"),
        name: other,
    }


def settings_agreement(grasp: Grasp, result: HoldResult) -> Agreement:
    """Repeats a test with other settings.

    Args:
        grasp: the grasp; its squeeze stays as it was planned.
        result: the test to be repeated.
    """
    return verdict_agreement(grasp, result.held, settings=result.settings)


def verdict_agreement(
    grasp: Grasp,
    held: bool,
    *,
    settings: HoldSettings | None = None,
    weakest: Sequence[Direction] | None = None,
    lift: Lift | None = None,
) -> Agreement:
    """`settings_agreement` where only the verdict is at hand.

    All begin with the hand closed on the object as the usual settings close it: nothing presses yet there. Of
    a lift that is known to give way first in some directions, these alone are tried: of what holds in
    them, next to nothing fails in others.

    Args:
        grasp: the grasp.
        held: the verdict to be repeated.
        settings: of the test; None takes what the squeeze was planned for.
        weakest: the directions of gravity by how little they would carry, that one first; None where that is
            not known, and all of them are tried.
        lift: of this grasp with these settings, which may have closed the hand; None closes it.
    """
    settings = trial_settings(grasp, settings)
    tried = None if weakest is None else tuple(weakest[:_DECISIVE])
    closed = closed_hand(grasp, settings, lift)
    verdicts = {
        name: passes(grasp, settings=other, directions=tried, closed=closed)
        for name, other in variants(settings).items()
    }
    return Agreement(held, verdicts, tried or ())
