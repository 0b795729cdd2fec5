"""How much of its limits a direction of a lift takes: where that is most, the grasp gives way first."""

from collections.abc import Sequence

import numpy as np

from ..settings import Direction, HoldSettings

__all__ = ["most_strained_first", "strain"]


def strain(slip_m: float, rotation_rad: float, settings: HoldSettings) -> float:
    """The larger share of the limits of slip and rotation; 1 and more is beyond a limit."""
    limit = settings.rotation_limit_rad
    turned = 0.0 if limit is None else rotation_rad / limit
    return max(slip_m / settings.slip_limit_m, turned)


def most_strained_first(settings: HoldSettings, strains: Sequence[float]) -> list[Direction]:
    """The directions of gravity by their strains, which stand in the order of the settings."""
    order = np.argsort([-share for share in strains], kind="stable")
    return [settings.directions[i] for i in order]
