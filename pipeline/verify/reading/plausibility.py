"""How much a state looks like a grasp: a logarithm of likelihood, for comparing readings of the same file.

What is asked is not whether a grasp is good, which the judgement does, but whether numbers were read as they
were meant. Read wrongly they put the hand anywhere. Read rightly they bring several fingers to the surface,
exactly, within the few millimetres that makers of grasps tolerate, or at least near; joints stay within
their limits; and what touches lies on different sides of the object.
"""

from math import pi, sqrt

import numpy as np

from ....base.numeric.arrays import Array
from ....hands import Hand
from .fingers import finger_links
from .near_object import LinkDistances
from .opposition import unopposed
from .states import States

__all__ = ["NEAR_M", "fingers_near", "log_likelihood"]

NEAR_M = 0.012
"""A finger so near to the object counts as meant to touch it; files may hold hands before they close."""

# The distance of a finger from the object in a grasp: shares of those that touch to rounding, well, roughly,
# nearly, and that have no part in it, with the widths of all but the last and the reach of that, in mm.
_SHARES, _WIDTHS_MM = (0.25, 0.2, 0.3, 0.1), (0.05, 0.5, 3.0, 8.0)
_IDLE, _IDLE_REACH_MM = 0.15, 60.0
_LEAST = 1e-5
# A palm that sinks in by so much is as unlikely as a finger that is nowhere.
_PALM_DEPTH_M, _PALM_MOST = 2e-3, 10.0
# Excess over limits that costs one, and the most that one joint and all of them cost.
_EXCESS, _JOINT_MOST, _LIMITS_MOST = 0.02, 6.0, 40.0
# So many metres of a slide count as much as a radian: a finger's length.
_SLIDE_M = 0.05
# The same of coupled joints and what their masters say.
_ASTRAY = 0.1
# Contacts for the balance, and what no balance at all costs.
_TOUCH_M, _UNBALANCED, _FRICTION = 4e-3, 4.0, 0.5


def log_likelihood(hand: Hand, states: States, near: LinkDistances) -> Array:
    """Log-likelihoods (n,) of states, up to a constant of the hand's own."""
    out = _limits(hand, states.joints)
    for links in finger_links(hand).values():
        out = out + _of_distance(near.distance_m[:, links].min(axis=1))
    sunk = np.maximum(0.0, -near.distance_m[:, 0] - 1e-3)
    out = out - np.minimum(sunk / _PALM_DEPTH_M, _PALM_MOST)
    return np.asarray(out - _UNBALANCED * np.array([_imbalance(near, i) for i in range(len(states))]))


def fingers_near(hand: Hand, near: LinkDistances) -> Array:
    """How many fingers (n,), the palm counted with them, are near the object's surface, not deep inside."""
    count = (np.abs(near.distance_m[:, 0]) < NEAR_M).astype(int)
    for links in finger_links(hand).values():
        count += np.abs(near.distance_m[:, links].min(axis=1)) < NEAR_M
    return np.asarray(count)


def _of_distance(distance_m: Array) -> Array:
    """Log-density of a finger's signed distance, in 1/mm."""
    d = 1e3 * distance_m
    density = np.where(d >= 0.0, _IDLE / _IDLE_REACH_MM, 0.0) + _LEAST
    for share, width in zip(_SHARES, _WIDTHS_MM, strict=True):
        density = density + share / (width * sqrt(2.0 * pi)) * np.exp(-0.5 * (d / width) ** 2)
    return np.asarray(np.log(density))


def _limits(hand: Hand, joints: Array) -> Array:
    """What joints beyond their limits cost, and coupled ones that don't follow: at most zero (n,)."""
    lower, upper = (np.array([getattr(axis, end) for axis in hand.axes]) for end in ("lower", "upper"))
    slides = np.array([axis.kind == "prismatic" for axis in hand.axes], dtype=bool)
    unit = np.where(slides, _SLIDE_M, 1.0)
    excess = np.maximum(lower - joints, joints - upper) / unit
    cost = np.clip(excess / _EXCESS, 0.0, _JOINT_MOST).sum(axis=1)
    led = joints[:, hand.independent] @ hand.coupling_matrix.T + hand.coupling_offset
    cost = cost + np.clip(np.abs(joints - led) / unit / _ASTRAY, 0.0, _JOINT_MOST).sum(axis=1)
    return np.asarray(-np.minimum(cost, _LIMITS_MOST))


def _imbalance(near: LinkDistances, i: int) -> float:
    """What is left of pressing forces of sum 1 that balance best, less what friction could take: 0 to 1."""
    touching = np.abs(near.distance_m[i]) < _TOUCH_M
    return max(0.0, unopposed(near.normals[i, touching]) - _FRICTION) / (1.0 - _FRICTION)
