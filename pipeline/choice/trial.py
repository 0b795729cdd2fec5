"""The trial of a candidate under a draw, and how near to its limits it came."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...mjcf import Grasp, HoldResult, HoldSettings, hold_disturbed, strain
from .draws import to_disturbance
from .trial_outcome import TrialOutcome

__all__ = ["MOVED", "try_under"]

MOVED = "moved in the squeeze"


def try_under(
    grasp: Grasp, conditions: NDArray[np.float32], loads: Sequence[float], settings: HoldSettings
) -> list[TrialOutcome]:
    """Tries a grasp under a draw (see `draws.CONDITIONS`), at loads that ascend.

    Where it fails, larger loads are not simulated: it is taken to fail there as well.
    """
    results = hold_disturbed(
        grasp, to_disturbance(conditions), settings=settings, loads=loads, until_failed=True
    )
    return [_outcome(result) for result in results]


def _outcome(result: HoldResult) -> TrialOutcome:
    settings = result.settings
    moved = strain(result.squeeze_slip_m, result.squeeze_rotation_rad, settings)
    if not result.kept_place:
        return TrialOutcome(False, _negative(moved), MOVED)
    # A turn is not measured by how far the object turns: that is what it is for.
    turns = result.kind == "lift"
    strains = [
        strain(entry.slip_m, entry.rotation_rad if turns else 0.0, settings) for entry in result.directions
    ]
    worst = max(moved, *strains)
    last = next((entry for entry in result.directions if not entry.held), result.directions[-1])
    if result.held:
        return TrialOutcome(True, float(np.clip(1.0 - worst, 0.0, 1.0)), last.outcome.value)
    return TrialOutcome(False, _negative(worst), last.outcome.value)


def _negative(worst: float) -> float:
    """A margin of what failed; where the simulation broke down, the worst."""
    return float(np.clip(1.0 - worst, -1.0, 0.0)) if np.isfinite(worst) else -1.0
