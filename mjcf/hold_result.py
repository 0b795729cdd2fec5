"""What a hold test found out."""

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from .settings import Direction, HoldSettings

__all__ = ["DirectionResult", "HoldResult", "Outcome"]

Array = NDArray[np.float64]


class Outcome(Enum):
    """How a test in one direction ended; the first reason that applies."""

    HELD = "held"
    SLIPPED = "slipped too far"
    ROTATED = "turned too far"
    LET_GO = "a contact of the task was lost"
    UNSTABLE = "the simulation broke down"


@dataclass(frozen=True, eq=False)
class DirectionResult:
    """One direction of gravity; the reference is where the squeeze left the object.

    Attributes:
        gravity: direction of gravity in the palm frame, a unit vector.
        outcome: how it ended.
        slip_m: largest displacement of the object's points of contact, in the palm frame.
        rotation_rad: largest rotation of the object, in the palm frame.
        touching: whether each contact of the task still carried force at the end.
        times_s: (k,) times of the samples since gravity set in.
        slip_curve_m: (k,) displacement at those times.
        rotation_curve_rad: (k,) rotation at those times.
        qpos: (k, nq) MuJoCo positions at those times, for pictures.
    """

    gravity: Direction
    outcome: Outcome
    slip_m: float
    rotation_rad: float
    touching: tuple[bool, ...]
    times_s: Array
    slip_curve_m: Array
    rotation_curve_rad: Array
    qpos: Array

    @property
    def held(self) -> bool:
        """Whether the object was held in this direction."""
        return self.outcome is Outcome.HELD


@dataclass(frozen=True, eq=False)
class HoldResult:
    """A hold test.

    Attributes:
        settings: what was assumed.
        squeeze_slip_m: how far the squeeze alone moved the object's points of contact.
        squeeze_rotation_rad: how far the squeeze alone turned it.
        squeezed_qpos: (nq,) MuJoCo positions at the end of the squeeze.
        directions: one result per direction of gravity, in the order of the settings.
    """

    settings: HoldSettings
    squeeze_slip_m: float
    squeeze_rotation_rad: float
    squeezed_qpos: Array
    directions: tuple[DirectionResult, ...]

    @property
    def kept_place(self) -> bool:
        """Whether the squeeze left the object where the grasp has it, within the limits of slip and rotation.

        Where contacts lie outside their friction cones, a squeeze may slide the object into another grasp,
        which then holds: that says nothing about the one tested.
        """
        settings = self.settings
        is_near = self.squeeze_slip_m < settings.slip_limit_m
        return is_near and self.squeeze_rotation_rad < settings.rotation_limit_rad

    @property
    def held(self) -> bool:
        """Whether the object kept its place in the squeeze and was held in every direction."""
        return self.kept_place and all(direction.held for direction in self.directions)

    @property
    def slip_m(self) -> float:
        """Largest slip over all directions."""
        return max(direction.slip_m for direction in self.directions)

    @property
    def rotation_rad(self) -> float:
        """Largest rotation over all directions."""
        return max(direction.rotation_rad for direction in self.directions)
