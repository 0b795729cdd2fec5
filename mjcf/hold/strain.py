"""How much of its limits a direction of a lift takes, and of what is thought safe a grasp that is held.

Where the former is most, the grasp gives way first. The latter is the measure of how far a grasp is to be
relied on: the largest of three shares, each of a limit of its own. What moves in the squeeze moves farther on
softer contacts; what is near its limits with less spin friction is lost where patches are smaller; and all
that friction resists goes with the normal force, so the weakest contact is the first to slip or to let go.
"""

from collections.abc import Sequence

import numpy as np

from ...base.numeric.arrays import Array
from ..settings import Direction, HoldSettings

__all__ = ["most_strained_first", "strain", "whole_strain"]

# A contact without force counts as pressing with this share of what is planned at least.
_NO_FORCE = 1e-3


def strain(slip_m: float, rotation_rad: float, settings: HoldSettings) -> float:
    """The larger share of the limits of slip and rotation; 1 and more is beyond a limit."""
    limit = settings.rotation_limit_rad
    turned = 0.0 if limit is None else rotation_rad / limit
    return max(slip_m / settings.slip_limit_m, turned)


def whole_strain(squeeze_slip_m: float, normals_N: Array, spun: float, settings: HoldSettings) -> float:
    """How much of what is thought safe a grasp that is held takes: 1 and more is beyond it.

    Args:
        squeeze_slip_m: how far the squeeze itself has moved the object.
        normals_N: normal force at each contact (n,) after it.
        spun: the strain with less spin friction, as `strain` has it; 0 where a test knows no such trial.
        settings: of the test.

    Returns:
        The largest of three: the squeeze's motion over `firm_limit_m`, `spun`, and `planned_force_N` over the
        force of the contact that presses least.
    """
    planned_N = settings.planned_force_N
    weak = planned_N / max(float(normals_N.min()), _NO_FORCE * planned_N) if planned_N > 0.0 else 0.0
    return max(squeeze_slip_m / settings.firm_limit_m, spun, weak)


def most_strained_first(settings: HoldSettings, strains: Sequence[float]) -> list[Direction]:
    """The directions of gravity by their strains, which stand in the order of the settings."""
    order = np.argsort([-share for share in strains], kind="stable")
    return [settings.directions[i] for i in order]
