"""Contact regions: spherical caps, Bezier patches and points with a normal, on a hand link or an object."""

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from ..arrays import Array
from ..fields import Vector3
from .bezier import BezierPatch
from .transforms import perpendicular

__all__ = ["Cap", "Patch", "PointRegion", "Region", "Vector3"]


@dataclass(frozen=True, eq=False)
class Cap:
    """A spherical cap: centre + radius m, for unit m within `half_angle_rad` of `axis`; m is the normal.

    Attributes:
        centre: (3,) in m.
        radius: in m.
        axis: unit vector (3,).
        half_angle_rad: in (0, pi].
    """

    centre: Array
    radius: float
    axis: Array
    half_angle_rad: float

    def sample(self, count: int, rng: np.random.Generator) -> tuple[Array, Array]:
        """Points and unit normals, each (count, 3), uniform over the cap's area."""
        cosine = rng.uniform(np.cos(self.half_angle_rad), 1.0, count)
        angle = rng.uniform(0.0, 2.0 * np.pi, count)
        e1, e2 = perpendicular(self.axis)
        sine = np.sqrt(1.0 - cosine**2)
        m = cosine[:, None] * self.axis + sine[:, None] * (
            np.cos(angle)[:, None] * e1 + np.sin(angle)[:, None] * e2
        )
        return self.centre + self.radius * m, m


@dataclass(frozen=True, eq=False)
class Patch:
    """A Bezier patch as a contact region."""

    patch: BezierPatch

    def sample(self, count: int, rng: np.random.Generator) -> tuple[Array, Array]:
        """Points and unit normals, each (count, 3), uniform in the parameters."""
        u, v = rng.uniform(size=(2, count))
        return self.patch.evaluate(u, v), self.patch.unit_normal(u, v)


@dataclass(frozen=True, eq=False)
class PointRegion:
    """A single point (3,) in m with its unit outward normal (3,)."""

    point: Array
    normal: Array

    def sample(self, count: int, rng: np.random.Generator) -> tuple[Array, Array]:
        """The point and its normal, `count` times."""
        del rng
        return np.tile(self.point, (count, 1)), np.tile(self.normal, (count, 1))


Region: TypeAlias = Cap | Patch | PointRegion
