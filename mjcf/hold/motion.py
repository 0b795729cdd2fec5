"""How far an object has moved, and whether it is lost, at rest, or bound to stay where it is.

Poses are as MuJoCo keeps them: position, then quaternion (w, x, y, z).
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array
from ..settings import HoldSettings

__all__ = [
    "CREEPS_ON",
    "LOOK_EVERY",
    "SWINGS",
    "SWINGS_OF_TRIAL",
    "Motion",
    "MotionWatch",
    "slip_and_rotation",
]


CREEPS_ON = 20.0
"""A verdict alone is known once nothing would change if all went on as lately, so many times as fast."""
LOOK_EVERY = 5
"""An object that is lost, or at rest in a squeeze, is looked for once in so many samples."""
SWINGS, SWINGS_OF_TRIAL = 2, 1
"""Rest begins no earlier than so many times `rest_s` after gravity has set in or a squeeze is over, for at a
turning point of its swing an object stands still as well. A trial for its verdict alone may end earlier.
"""


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
        self._points = np.ascontiguousarray(points)

    def curves(self, path: Array, reference: Array) -> tuple[Array, Array]:
        """Slip (k,) in m and rotation (k,) in rad since a reference, of a path (k, ...) of poses."""
        return slip_and_rotation(path[:, -7:], reference[-7:], self._points)

    def motion(self, pose: Array, reference: Array) -> Motion:
        """The motion from a reference to a pose."""
        return Motion(*_moved(pose[-7:], reference[-7:], self._points))

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


def slip_and_rotation(poses: Array, reference: Array, watched: Array) -> tuple[Array, Array]:
    """Displacement and rotation of a body.

    Args:
        poses: (k, 7) poses of the body.
        reference: (7,) the pose that they are compared with.
        watched: (n, 3) points in the body's frame, in m.

    Returns:
        Largest displacement (k,) of the points in m and angle (k,) in rad, in [0, pi]: q and -q are the same
        rotation. Both are NaN where a pose is not finite.
    """
    out = np.empty((2, len(poses)))
    poses, reference, watched = (np.ascontiguousarray(given) for given in (poses, reference, watched))
    _move(poses, reference, watched, out)
    return out[0], out[1]


@compiled
def _move(poses: Array, reference: Array, watched: Array, out: Array) -> None:
    """Writes slip and rotation (2, k)."""
    for k in range(poses.shape[0]):
        out[0, k], out[1, k] = _moved(poses[k], reference, watched)


@compiled
def _moved(pose: Array, reference: Array, watched: Array) -> tuple[float, float]:
    """Slip and rotation of a pose (7,); NaN where one is not finite."""
    q0, q, place, place0 = np.empty(4), np.empty(4), np.empty(3), np.empty(3)
    if not (_unit_quaternion(reference, q0) and _unit_quaternion(pose, q)):
        return np.nan, np.nan
    # The relative rotation q q0^-1; |w| makes the angle that of the shorter way, whatever the signs.
    w = q[0] * q0[0] + q[1] * q0[1] + q[2] * q0[2] + q[3] * q0[3]
    x = q0[0] * q[1] - q[0] * q0[1] - (q[2] * q0[3] - q[3] * q0[2])
    y = q0[0] * q[2] - q[0] * q0[2] - (q[3] * q0[1] - q[1] * q0[3])
    z = q0[0] * q[3] - q[0] * q0[3] - (q[1] * q0[2] - q[2] * q0[1])
    farthest = 0.0
    for j in range(watched.shape[0]):
        _turn(q, watched[j], place)
        _turn(q0, watched[j], place0)
        way = 0.0
        for i in range(3):
            way += (place[i] - place0[i] + pose[i] - reference[i]) ** 2
        farthest = max(farthest, way)
    return np.sqrt(farthest), 2.0 * np.arctan2(np.sqrt(x * x + y * y + z * z), abs(w))


@compiled
def _unit_quaternion(pose: Array, out: Array) -> bool:
    """Writes the quaternion (4,) of a pose (7,) with length 1; False where the pose is not finite."""
    square = 0.0
    for i in range(7):
        if not np.isfinite(pose[i]):
            return False
        if i > 2:
            square += pose[i] * pose[i]
    length = np.sqrt(square)
    for i in range(4):
        out[i] = pose[3 + i] / length
    return True


@compiled
def _turn(q: Array, point: Array, out: Array) -> None:
    """Writes a point (3,) turned by a unit quaternion (4,)."""
    # p + w u + v x u with u = 2 v x p
    a = 2.0 * (q[2] * point[2] - q[3] * point[1])
    b = 2.0 * (q[3] * point[0] - q[1] * point[2])
    c = 2.0 * (q[1] * point[1] - q[2] * point[0])
    out[0] = point[0] + q[0] * a + q[2] * c - q[3] * b
    out[1] = point[1] + q[0] * b + q[3] * a - q[1] * c
    out[2] = point[2] + q[0] * c + q[1] * b - q[2] * a
