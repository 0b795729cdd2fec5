"""Whether a lift also holds where friction resists spin less than its pads are thought to.

How well a pad resists being spun about its normal rests on the patch in which it touches: on its modulus, its
depth and the curvatures at a point, none of which is known well. A pinch of two fingers has nothing else
against turning about the line between them. So a lift that holds is loaded once more, its squeeze as it was,
with a share of the spin friction; where it gives way in any direction of gravity, it is held narrowly. (Those
that strain it most in the test are not always those in which it spins.) Another simulator's patches refute
nearly all pinches that this finds, and few others.
"""

from dataclasses import dataclass
from math import degrees

from ...settings import Direction, HoldSettings
from ..lift import Lift
from ..result import HoldResult
from ..strain import most_strained_first, strain

__all__ = ["LessSpin", "with_less_spin"]


@dataclass(frozen=True)
class LessSpin:
    """What becomes of the object where friction resists spin less.

    Attributes:
        share: of the usual spin friction.
        gravity: the direction in which the object then comes closest to its limits; where it gives way, the
            first in which it does.
        slip_m: its slip there once that is known.
        rotation_rad: how far it has turned there by then.
        held: whether it is held in every direction.
    """

    share: float
    gravity: Direction
    slip_m: float
    rotation_rad: float
    held: bool

    def __str__(self) -> str:
        words = f"with {100.0 * self.share:.0f} % of the spin friction: slip {1e3 * self.slip_m:.2f} mm"
        return f"{words}, turn {degrees(self.rotation_rad):.1f} deg" + ("" if self.held else ": not held")


def with_less_spin(lift: Lift, result: HoldResult, settings: HoldSettings) -> LessSpin | None:
    """Loads a squeezed grasp with `settings.firm_spin` of its spin friction.

    Args:
        lift: of the grasp with these settings.
        result: of its test, which it has passed.
        settings: of the test.

    Returns:
        What comes closest to the limits; None where `firm_spin` is all of the friction.
    """
    if settings.firm_spin == 1.0:
        return None
    strains = [strain(entry.slip_m, entry.rotation_rad, settings) for entry in result.directions]
    lift.squeeze()
    found: list[LessSpin] = []
    with lift.less_spin(settings.firm_spin):
        for direction in most_strained_first(settings, strains):
            held, slip_m, rotation_rad = lift.holds_at(direction)
            found.append(LessSpin(settings.firm_spin, direction, slip_m, rotation_rad, held))
            if not held:
                return found[-1]
    return max(found, key=lambda entry: strain(entry.slip_m, entry.rotation_rad, settings))
