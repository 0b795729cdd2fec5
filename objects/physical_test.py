"""What a task asks of physics: to lift, turn or press, and which parts of the object the hand moves."""

from dataclasses import dataclass
from itertools import product
from math import cos, degrees, sin
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from ..base.files.fields import Vector3
from ..geometry import perpendicular

__all__ = ["SIX", "LiftTest", "PhysicalTest", "PressTest", "TurnTest", "cone", "describe_test", "sphere"]

_RIM = 6

SIX: tuple[Vector3, ...] = (
    (1.0, 0.0, 0.0),
    (-1.0, 0.0, 0.0),
    (0.0, 1.0, 0.0),
    (0.0, -1.0, 0.0),
    (0.0, 0.0, 1.0),
    (0.0, 0.0, -1.0),
)
"""Gravity along each axis of the palm frame, both ways."""


@dataclass(frozen=True)
class LiftTest:
    """The hand carries the object, or some of its parts, against gravity.

    Attributes:
        parts: names of the parts that the hand carries; empty for the whole object. The other parts stay
            where they are.
        directions: unit vectors in the palm frame along which gravity acts, one test each.
    """

    parts: tuple[str, ...] = ()
    directions: tuple[Vector3, ...] = SIX


@dataclass(frozen=True)
class TurnTest:
    """The hand turns parts of the object about a hinge with dry friction; a stand holds the other parts.

    Attributes:
        parts: names of the parts that turn as one.
        hinge_point: a point of the hinge's axis, in the object's frame in m.
        hinge_axis: unit vector of the axis, in the object's frame; the turn is positive about it.
        friction_torque_Nm: torque in N m that the hinge opposes to the turn.
        angle_rad: how far the parts must turn, in rad.
    """

    parts: tuple[str, ...]
    hinge_point: Vector3
    hinge_axis: Vector3
    friction_torque_Nm: float
    angle_rad: float


@dataclass(frozen=True)
class PressTest:
    """The hand presses on the object, which a stand holds; no contact may slip or leave.

    Attributes:
        contacts: numbers of the contacts that press, counted from 0 in the order of the task.
        force_N: least normal force in N at each of them.
    """

    contacts: tuple[int, ...]
    force_N: float


PhysicalTest: TypeAlias = LiftTest | TurnTest | PressTest


def cone(axis: NDArray[np.float64], half_angle_rad: float) -> tuple[Vector3, ...]:
    """Directions in a cone: its axis, a unit vector (3,), and six evenly spread on its rim."""
    e1, e2 = perpendicular(axis)
    angles = [2.0 * np.pi * k / _RIM for k in range(_RIM)]
    rim = [cos(half_angle_rad) * axis + sin(half_angle_rad) * (cos(a) * e1 + sin(a) * e2) for a in angles]
    return tuple(_plain(direction) for direction in [axis, *rim])


def sphere() -> tuple[Vector3, ...]:
    """Directions all over the sphere: the 26 from a cube's centre to its faces, edges and corners."""
    grid = np.array([d for d in product((-1.0, 0.0, 1.0), repeat=3) if any(d)])
    return tuple(_plain(direction) for direction in grid / np.linalg.norm(grid, axis=1, keepdims=True))


def describe_test(test: PhysicalTest) -> str:
    """A line for people that says what the hand must do."""
    match test:
        case LiftTest():
            what = ", ".join(test.parts) or "the whole object"
            return f"lift {what}, gravity in {len(test.directions)} directions"
        case TurnTest():
            what, angle = ", ".join(test.parts), degrees(test.angle_rad)
            return f"turn {what} by {angle:.3g} deg against {test.friction_torque_Nm:.3g} N m"
        case PressTest():
            numbers = ", ".join(map(str, test.contacts))
            return f"press with {test.force_N:.3g} N at contacts {numbers}"


def _plain(direction: NDArray[np.float64]) -> Vector3:
    x, y, z = (float(value) for value in direction)
    return x, y, z
