"""The model that a task's test simulates, as MJCF."""

import numpy as np
from numpy.typing import NDArray

from ...objects import LiftTest
from ...solver import Configuration
from ..settings import HoldSettings
from .grasp import grasp_mjcf
from .stand import stand_mjcf

__all__ = ["trial_mjcf"]


def trial_mjcf(
    configuration: Configuration,
    settings: HoldSettings | None = None,
    targets: NDArray[np.float64] | None = None,
    pregrasp: NDArray[np.float64] | None = None,
) -> str:
    """Hand and object as the task's test has them: `grasp_mjcf` for a lift, `stand_mjcf` for the others."""
    build = grasp_mjcf if isinstance(configuration.task.test, LiftTest) else stand_mjcf
    return build(configuration, settings, targets, pregrasp)
