"""Where contacts may press on an object, and how hard: all that is asked of a hand before any kinematics."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from math import inf

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import BezierPatch, Cap, Patch, Region, perpendicular, region_curvature
from ...hands import Hand, HandRegion
from ..contact import Contact
from .finger_force import usual_force_N

__all__ = ["Places", "contact_places"]

# Rows and columns of points of a patch, every second of which is a coarse one; a cap has its middle and so
# many on its rim.
_GRID, _RIM = 5, 8
_COARSE = tuple(_GRID * i + j for i in range(0, _GRID, 2) for j in range(0, _GRID, 2))
_STEPS = np.linspace(0.0, 1.0, _GRID)
_PARAMETERS = np.array([(u, v) for u in _STEPS for v in _STEPS])
_MIDDLE = np.array([0.5, 0.5])
# Force behind the spin arm of a contact that nothing limits: arms grow with its fourth root only.
_PALM_N = 30.0


@dataclass(frozen=True, eq=False)
class Places:
    """Where one contact may press, in the object's frame.

    Attributes:
        points: (k, 3) in m; the contact's force may be spread over them.
        inward: (k, 3) unit normals into the object.
        largest_N: largest normal force in N, of all points together; may be infinite.
        spin_arm_m: arm at which friction resists spin about the normal.
        coarse: indices of some of the points, spread over all of them; empty for all.
        patch: that the points lie on; None for other regions.
        parameters: (k, 2) of the points on the patch.
    """

    points: Array
    inward: Array
    largest_N: float
    spin_arm_m: float
    coarse: tuple[int, ...] = ()
    patch: BezierPatch | None = None
    parameters: Array | None = None

    def at(self, index: int) -> "Places":
        """The same at one of the points."""
        kept = slice(index, index + 1)
        parameters = None if self.parameters is None else self.parameters[kept]
        return replace(
            self, points=self.points[kept], inward=self.inward[kept], coarse=(), parameters=parameters
        )

    def moved(self, step: Array) -> "Places":
        """The same with a single point elsewhere on its patch, by (2,) of its parameters and not beyond."""
        if self.patch is None or self.parameters is None:
            return self
        parameters = np.clip(self.parameters + step, 0.0, 1.0)
        u, v = parameters.T
        return replace(
            self,
            points=self.patch.evaluate(u, v),
            inward=-self.patch.unit_normal(u, v),
            parameters=parameters,
        )


def contact_places(
    contacts: Iterable[Contact], hand: Hand, most_N: float | None = None, *, share: float | None = None
) -> list[Places]:
    """Where the contacts of a task may press.

    Args:
        contacts: pairs of regions.
        hand: the hand; its fingers limit the forces, and its pads resist spin as in a squeeze plan.
        most_N: largest normal force that the task allows; None for no such limit.
        share: of the postures in which a finger presses less hard; None for the usual one.
    """
    return [_places(contact.object.region, contact.hand, hand, most_N, share) for contact in contacts]


def _places(region: Region, by: HandRegion, hand: Hand, most_N: float | None, share: float | None) -> Places:
    points, normals = _spread(region)
    own_N = usual_force_N(hand, by) if share is None else usual_force_N(hand, by, share)
    largest_N = min(own_N, inf if most_N is None else most_N)
    places = Places(points, -normals, largest_N, _spin_arm_m(region, by, hand, largest_N))
    if not isinstance(region, Patch):
        return places
    return replace(places, coarse=_COARSE, patch=region.patch, parameters=_PARAMETERS)


def _spread(region: Region) -> tuple[Array, Array]:
    """Points and outward normals, each (k, 3), that a region lies between; of flat ones, exactly."""
    match region:
        case Patch():
            u, v = _PARAMETERS.T
            return region.patch.evaluate(u, v), region.patch.unit_normal(u, v)
        case Cap():
            e1, e2 = perpendicular(region.axis)
            angles = 2.0 * np.pi * np.arange(_RIM) / _RIM
            around = np.outer(np.cos(angles), e1) + np.outer(np.sin(angles), e2)
            half = region.half_angle_rad
            normals = np.vstack([region.axis, np.cos(half) * region.axis + np.sin(half) * around])
            return region.centre + region.radius * normals, normals
        case _:
            return region.spread()


def _spin_arm_m(region: Region, by: HandRegion, hand: Hand, force_N: float) -> float:
    """The arm of a pad in the middles of both regions, turned to each other so that it is larger."""
    ours, theirs = _principal(region), _principal(by.region)
    curvatures = np.array([ours + theirs, ours + theirs[::-1]])
    force = _PALM_N if np.isinf(force_N) else force_N
    return float(hand.pad.spin_arm_m(np.full(2, force), curvatures).max())


def _principal(region: Region) -> Array:
    """Principal curvatures (2,) in 1/m of a region in its middle, the smaller first."""
    _, normal = region.middle()
    tangents = np.asarray(perpendicular(normal))
    return np.asarray(np.linalg.eigvalsh(tangents @ region_curvature(region, _MIDDLE) @ tangents.T))
