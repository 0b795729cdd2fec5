"""Straight lines that stand for how a joint follows another, where the model says something else."""

from typing import NamedTuple

import mujoco
import numpy as np
from mujoco import mjtJoint

from .tendons import pulled_joints

__all__ = ["Line", "line_of_curve", "line_of_spring", "misses_limits"]

# What a line may be off by: a hinge, and a slide.
_MOST_OFF_RAD, _MOST_OFF_M = 0.2, 2e-3
_STEPS = 129


class Line(NamedTuple):
    """position = ratio * position of the master + offset.

    Attributes:
        ratio: of the two positions.
        offset: in rad or m.
        off: how far the model's own way is off it at most, in rad or m.
        range: lower and upper position on it while the master goes through its range.
    """

    ratio: float
    offset: float
    off: float
    range: tuple[float, float]


def line_of_curve(model: mujoco.MjModel, e: int) -> Line | None:
    """The line nearest to the curve of an equality of two joints.

    Args:
        model: the model.
        e: number of the equality.

    Returns:
        The line that is off by least where it is off most; None where the master has no limits, and where it
        would be off by more than 0.2 rad (2 mm of a slide) or stand still.
    """
    follower, master = int(model.eq_obj1id[e]), int(model.eq_obj2id[e])
    if master < 0 or not model.jnt_limited[master]:
        return None
    zeros = [float(model.qpos0[model.jnt_qposadr[j]]) for j in (follower, master)]
    lower, upper = (float(end) for end in model.jnt_range[master])
    at = np.linspace(lower, upper, _STEPS)
    curve = zeros[0] + np.polynomial.polynomial.polyval(at - zeros[1], model.eq_data[e, :5])
    ratio, offset = (float(value) for value in np.polyfit(at, curve, 1))
    rest = curve - (ratio * at + offset)
    offset += 0.5 * float(rest.max() + rest.min())
    off = 0.5 * float(rest.max() - rest.min())
    is_hinge = model.jnt_type[follower] == mjtJoint.mjJNT_HINGE
    ends = sorted(ratio * end + offset for end in (at[0], at[-1]))
    if off > (_MOST_OFF_RAD if is_hinge else _MOST_OFF_M) or abs(ends[1] - ends[0]) < 2.0 * off:
        return None
    return Line(ratio, offset, off, (ends[0], ends[1]))


def line_of_spring(model: mujoco.MjModel, tendon: int, follower: int, master: int) -> Line | None:
    """The line on which the spring of a tendon between two joints is at rest; None where it has none.

    MuJoCo's equalities are accelerations: between links that weigh little a spring, which is a force, wins.
    """
    pulls = pulled_joints(model, tendon)
    if not np.any(model.tendon_stiffness[tendon] > 0.0) or pulls is None or set(pulls) != {follower, master}:
        return None
    rest = float(np.mean(model.tendon_lengthspring[tendon]))
    ratio, offset = -pulls[master] / pulls[follower], rest / pulls[follower]
    ends = sorted(ratio * float(end) + offset for end in model.jnt_range[master])
    return Line(ratio, offset, 0.0, (ends[0], ends[1]))


def misses_limits(model: mujoco.MjModel, follower: int, master: int, ratio: float, offset: float) -> bool:
    """Whether a joint that follows on a line never comes between its limits."""
    if not (model.jnt_limited[follower] and model.jnt_limited[master]):
        return False
    ends = sorted(ratio * float(end) + offset for end in model.jnt_range[master])
    lower, upper = model.jnt_range[follower]
    return bool(ends[1] < lower or ends[0] > upper)
