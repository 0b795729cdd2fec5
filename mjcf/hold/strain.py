"""How much of its limits a direction of a lift takes, and of what is thought safe a grasp that is held.

Where the former is most, the grasp gives way first. The latter is the measure of how far a grasp is to be
relied on: the largest share of several limits, each with a reason of its own. What moves in the squeeze moves
farther on softer contacts; what is near its limits with less spin friction, or with one finger first, is lost
where patches are smaller or hands close unevenly; and all that friction resists goes with the normal force,
so the weakest contact is the first to slip or to let go.
"""

from collections.abc import Sequence

import numpy as np

from ...base.numeric.arrays import Array
from ..settings import Direction, HoldSettings

__all__ = ["most_strained_first", "strain", "whole_strain"]

# What can't be told from more, as files have no infinity.
_MOST = 1000.0


def strain(slip_m: float, rotation_rad: float, settings: HoldSettings) -> float:
    """The larger share of the limits of slip and rotation; 1 and more is beyond a limit."""
    limit = settings.rotation_limit_rad
    turned = 0.0 if limit is None else rotation_rad / limit
    return max(slip_m / settings.slip_limit_m, turned)


def whole_strain(
    squeeze_slip_m: float, normals_N: Array, trials: Sequence[float], settings: HoldSettings
) -> float:
    """How much of what is thought safe a grasp that is held takes: 1 and more is beyond it.

    Args:
        squeeze_slip_m: how far the squeeze itself has moved the object.
        normals_N: normal force at each contact (n,) after it.
        trials: strains, as `strain` has them, in what else it was put to: less spin friction, fingers first,
            and the load, as a share of what is firm.
        settings: of the test.

    Returns:
        The largest of these, of the squeeze's motion over `firm_limit_m`, and of `planned_force_N` over the
        force of the contact that presses least; 1000 at most, for a trial that broke down, too.
    """
    weakest_N = float(normals_N.min())
    weak = settings.planned_force_N / weakest_N if weakest_N > 0.0 else np.inf
    shares = [squeeze_slip_m / settings.firm_limit_m, *trials, weak if settings.planned_force_N else 0.0]
    return min(_MOST, max(share if np.isfinite(share) else _MOST for share in shares))


def most_strained_first(settings: HoldSettings, strains: Sequence[float]) -> list[Direction]:
    """The directions of gravity by their strains, which stand in the order of the settings."""
    order = np.argsort([-share for share in strains], kind="stable")
    return [settings.directions[i] for i in order]
