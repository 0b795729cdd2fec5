"""Whether an object is lost, at rest, or bound to stay where it is, by its poses as it moved."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...base.numeric.arrays import Array
from ..settings import HoldSettings
from .motion import slip_and_rotation

__all__ = ["CREEPS_ON", "Motion", "MotionWatch"]

CREEPS_ON = 20.0
"""A verdict alone is known once nothing would change if all went on as lately, so many times as fast."""


class Motion(NamedTuple):
    """How far an object has moved.

    Attributes:
        slip_m: largest displacement of what is watched.
        rotation_rad: angle by which it has turned.
    """

    slip_m: float
    rotation_rad: float

    def gone_on(self, times: float, lately: "Motion") -> "Motion":
        """After so many times what it did lately, or before it."""
        return Motion(self.slip_m + times * lately.slip_m, self.rotation_rad + times * lately.rotation_rad)


class MotionWatch:
    """Looks at an object by its poses.

    Where poses are asked for, the last seven numbers of an array are one, so positions of a model will do.

    Args:
        settings: limits, the budget of creep, and how often poses are sampled.
        points: points (n, 3) of the object, in its frame, whose displacement is the slip.
    """

    def __init__(self, settings: HoldSettings, points: Array):
        self._settings = settings
        self._points = points

    def curves(self, path: Array, reference: Array) -> tuple[Array, Array]:
        """Slip (k,) in m and rotation (k,) in rad since a reference, of a path (k, ...) of poses."""
        return slip_and_rotation(path[:, -7:], reference[-7:], self._points)

    def motion(self, pose: Array, reference: Array) -> Motion:
        """The motion from a reference to a pose."""
        slip, rotation = self.curves(pose[None], reference)
        return Motion(float(slip[0]), float(rotation[0]))

    def is_within(self, motion: Motion) -> bool:
        """Whether slip and rotation are below their limits; NaN is not."""
        limit = self._settings.rotation_limit_rad
        return bool(
            motion.slip_m < self._settings.slip_limit_m and (limit is None or motion.rotation_rad < limit)
        )

    def is_lost(self, motion: Motion, times: float = 1.0) -> bool:
        """Whether a limit is exceeded so many times."""
        return not self.is_within(Motion(motion.slip_m / times, motion.rotation_rad / times))

    def lately(self, poses: Sequence[Array] | Array, swings: int) -> Motion | None:
        """The motion in the last `rest_s`; None where it is too early to say.

        Args:
            poses: by sample, from when the motion began.
            swings: how many times `rest_s` must have gone by: at a turning point of its swing an object
                stands still as well.
        """
        settings = self._settings
        if settings.rest_s is None:
            return None
        back = round(settings.rest_s / settings.sample_s)
        return None if len(poses) <= swings * back else self.motion(poses[-1], poses[-1 - back])

    def is_slow(self, lately: Motion) -> bool:
        """Whether so much in `rest_s` is within the budget of creep."""
        settings = self._settings
        rest_s = settings.rest_s or 0.0
        slow = lately.slip_m <= settings.creep_budget_m_s * rest_s
        return slow and lately.rotation_rad <= settings.creep_budget_rad_s * rest_s

    def will_stay(self, motion: Motion, lately: Motion, seconds: float) -> bool:
        """Whether what has moved so far is within its limits at the end of a time, at many times its pace."""
        return self.is_within(motion.gone_on(self._times(seconds), lately))

    def keeps_to_its_side(self, motion: Motion, lately: Motion, seconds: float) -> bool:
        """Whether it will stay within its limits likewise or, beyond them, will stay there."""
        came_from = motion.gone_on(-self._times(seconds), lately)
        return self.will_stay(motion, lately, seconds) or not self.is_within(came_from)

    def _times(self, seconds: float) -> float:
        return CREEPS_ON * seconds / (self._settings.rest_s or np.inf)
