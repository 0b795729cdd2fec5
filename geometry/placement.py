"""Whether a contact region lies on the surface of the body that carries it, and faces outwards there.

Where it does not, touching in the region is not touching the body. A pad whose corners stand off a curved
link is usual and does no harm, so what counts is the middle one of the distances all over the region: half of
it lies no farther off. The largest one is told beside it.
"""

from typing import NamedTuple, Protocol

import numpy as np

from ..base.numeric.arrays import Array
from .regions import Cap, Patch, Region

__all__ = ["MOST_OFF_M", "Placement", "Surface", "place_region"]

MOST_OFF_M = 5e-4
"""How far off the surface half of a region may lie, in m."""

_MOST_LEAN_RAD = 0.5 * np.pi


class Surface(Protocol):
    """The surface of a body in its own frame."""

    def compare(self, points: Array, normals: Array) -> tuple[Array, Array]:
        """Distances (n,) in m of points (n, 3), and angles (n,) in rad of their normals to outward ones."""


class Placement(NamedTuple):
    """How a region lies on its body.

    Attributes:
        off_m: the middle one of the distances from the surface.
        farthest_m: the largest of them.
        normal_rad: the middle one of the angles between the region's normals and the surface's outward ones.
    """

    off_m: float
    farthest_m: float
    normal_rad: float

    @property
    def is_off(self) -> bool:
        """Whether it lies so far off that touching there is not touching the body."""
        return not self.off_m <= MOST_OFF_M

    @property
    def is_turned(self) -> bool:
        """Whether it faces inwards."""
        return self.normal_rad > _MOST_LEAN_RAD

    def fault(self, region: Region, body: str) -> str:
        """What is wrong with the region on the body of this name, and what to do; empty for nothing.

        A region that is meant to lie off the surface has no fault.
        """
        if region.off_surface or not (self.is_off or self.is_turned):
            return ""
        meant = "or give it `off_surface: true` if that is meant"
        if not np.isfinite(self.off_m):
            return f"lies on {body}, which has no shapes that could touch: give it some, {meant}"
        if self.is_off:
            return (
                f"lies {1e3 * self.off_m:.3g} mm off the surface of {body}, and at most "
                f"{1e3 * MOST_OFF_M:g} mm is allowed: move it onto the surface, {meant}"
            )
        return (
            f"is turned inwards: its normals are {np.degrees(self.normal_rad):.0f} deg from the outward ones "
            f"of {body}; {_how_to_turn(region)}, {meant}"
        )


def place_region(region: Region, surface: Surface) -> Placement:
    """Measures a region against the surface of its body, both in the body's frame."""
    distance_m, angle_rad = surface.compare(*region.spread())
    return Placement(float(np.median(distance_m)), float(distance_m.max()), float(np.median(angle_rad)))


def _how_to_turn(region: Region) -> str:
    match region:
        case Patch():
            return "write its rows in the reverse order"
        case Cap():
            return "turn its axis round"
    return "turn its normal round"
