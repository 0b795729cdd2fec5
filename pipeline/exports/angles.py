"""Rotations as turns about fixed axes."""

from math import atan2, cos, hypot, sin

from ...base.numeric.arrays import Array

__all__ = ["roll_pitch_yaw"]


def roll_pitch_yaw(R: Array) -> list[float]:
    """Turns in rad about the fixed axes x, y, z; good to rounding also where two of them are one."""
    yaw = atan2(R[1, 0], R[0, 0])
    c, s = cos(yaw), sin(yaw)
    # What is left when the yaw is taken away, so that it need not be well known.
    roll = atan2(s * R[0, 2] - c * R[1, 2], c * R[1, 1] - s * R[0, 1])
    return [roll, atan2(-R[2, 0], hypot(R[0, 0], R[1, 0])), yaw]
