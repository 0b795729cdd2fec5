"""What is hidden from whoever chooses: mass, friction, centre of mass and placement, drawn at random."""

from dataclasses import dataclass, fields
from math import radians
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from ...arguments import check_number
from ...base.numeric.arrays import Array
from ...errors import InputError
from ...geometry import axis_rotation
from ...mjcf import Burden, Disturbance, Placement
from ...objects import ObjectModel

__all__ = ["CONDITIONS", "DrawRanges", "draw", "to_disturbance"]

CONDITIONS: tuple[tuple[str, str, str], ...] = (
    ("mass_factor", "1", "mass over what it is said to be"),
    ("friction_factor", "1", "friction over what it is said to be"),
    *((f"com_{axis}", "m", f"{axis} of the centre of mass, off where it is said to be") for axis in "xyz"),
    *((f"shift_{axis}", "m", f"{axis} of the object in the palm frame, off its place") for axis in "xyz"),
    *(
        (f"turn_{axis}", "rad", f"{axis} of the turn, as axis times angle in the palm frame")
        for axis in "xyz"
    ),
)
"""Name, unit and meaning of what is drawn, in order."""


@dataclass(frozen=True)
class DrawRanges:
    """How far what is hidden may be off; each part is drawn evenly and by itself.

    Attributes:
        mass: least and largest factor of the mass.
        friction: least and largest factor of the friction.
        com_share: the centre of mass is off along each axis of the object's frame by up to this share of the
            bounding box's side.
        shift_m: the object is off along each axis of the palm frame by up to this.
        angle_rad: and turned by up to this about any axis through the middle of the contact points.
    """

    mass: tuple[float, float] = (0.8, 1.5)
    friction: tuple[float, float] = (0.6, 1.05)
    com_share: float = 0.08
    shift_m: float = 0.004
    angle_rad: float = radians(4.0)

    def __post_init__(self) -> None:
        for name in ("mass", "friction"):
            least, most = getattr(self, name)
            check_number(f"DrawRanges.{name}[0]", least, above=0.0)
            check_number(f"DrawRanges.{name}[1]", most, least=least)
        for name in ("com_share", "shift_m", "angle_rad"):
            check_number(f"DrawRanges.{name}", getattr(self, name), least=0.0)

    def as_record(self) -> dict[str, Any]:
        """As plain data."""
        return {
            field.name: list(value) if isinstance(value := getattr(self, field.name), tuple) else value
            for field in fields(self)
        }

    @classmethod
    def from_record(cls, record: Any, source: str) -> Self:
        """From plain data of a file.

        Raises:
            InputError: something else.
        """
        try:
            return cls(
                mass=tuple(record["mass"]),
                friction=tuple(record["friction"]),
                com_share=record["com_share"],
                shift_m=record["shift_m"],
                angle_rad=record["angle_rad"],
            )
        except (KeyError, TypeError, ValueError):
            raise InputError(source, "draws", "must have the fields of DrawRanges") from None


def draw(rng: np.random.Generator, obj: ObjectModel, ranges: DrawRanges) -> NDArray[np.float32]:
    """One draw (11,), as `CONDITIONS` has it, in the precision in which it is kept."""
    sides = np.ptp(obj.mesh.bounds, axis=0)
    axis = rng.normal(size=3)
    angle = ranges.angle_rad * rng.uniform(-1.0, 1.0)
    values = [
        rng.uniform(*ranges.mass),
        rng.uniform(*ranges.friction),
        *(ranges.com_share * sides * rng.uniform(-1.0, 1.0, size=3)),
        *(ranges.shift_m * rng.uniform(-1.0, 1.0, size=3)),
        *(angle * axis / np.linalg.norm(axis)),
    ]
    return np.array(values, dtype=np.float32)


def to_disturbance(conditions: NDArray[np.float32]) -> Disturbance:
    """What a draw (11,) does to an object."""
    mass, friction, *rest = conditions.astype(float).tolist()
    com, shift, turn = np.array(rest).reshape(3, 3)
    angle = float(np.linalg.norm(turn))
    rotation: Array = axis_rotation(turn / angle, angle) if angle > 0.0 else np.eye(3)
    return Disturbance(Burden(mass, com), friction, Placement(shift, rotation))
