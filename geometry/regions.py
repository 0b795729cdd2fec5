"""Contact regions: spherical caps, Bezier patches and points with a normal, on a hand link or an object.

Each kind has a field `off_surface`: whether it is meant to lie off the surface of its body, or to face
inwards there, which a task refuses otherwise (`placement.py`).
"""

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from ..base.files.fields import Vector3
from ..base.numeric.arrays import Array
from .bezier import BezierPatch
from .transforms import perpendicular

__all__ = ["Cap", "Patch", "PointRegion", "Region", "Vector3"]

# Rows and columns of points spread over a region.
_GRID = 7


@dataclass(frozen=True, eq=False)
class Cap:
    """A spherical cap: centre + radius m, for unit m within `half_angle_rad` of `axis`; m is the normal.

    Attributes:
        centre: (3,) in m.
        radius: in m.
        axis: unit vector (3,).
        half_angle_rad: in (0, pi].
        off_surface: whether it is meant to lie off the surface of its body.
    """

    centre: Array
    radius: float
    axis: Array
    half_angle_rad: float
    off_surface: bool = False

    def middle(self) -> tuple[Array, Array]:
        """Point (3,) in m and unit outward normal (3,) in the middle."""
        return self.centre + self.radius * self.axis, self.axis

    def spread(self) -> tuple[Array, Array]:
        """Points and unit normals, each (49, 3): the middle, and rings of equal area out to the rim."""
        cosine, angle = np.meshgrid(
            np.linspace(1.0, np.cos(self.half_angle_rad), _GRID)[1:],
            np.arange(_GRID + 1) * 2.0 * np.pi / (_GRID + 1),
            indexing="ij",
        )
        around = self._around(cosine.ravel(), angle.ravel())
        m = np.vstack([self.axis, around])
        return self.centre + self.radius * m, m

    def sample(self, count: int, rng: np.random.Generator) -> tuple[Array, Array]:
        """Points and unit normals, each (count, 3), uniform over the cap's area."""
        cosine = rng.uniform(np.cos(self.half_angle_rad), 1.0, count)
        m = self._around(cosine, rng.uniform(0.0, 2.0 * np.pi, count))
        return self.centre + self.radius * m, m

    def _around(self, cosine: Array, angle: Array) -> Array:
        """Unit vectors (n, 3) by cosines (n,) of their angles from the axis, and angles (n,) about it."""
        e1, e2 = perpendicular(self.axis)
        sine = np.sqrt(1.0 - cosine**2)
        return cosine[:, None] * self.axis + sine[:, None] * (
            np.cos(angle)[:, None] * e1 + np.sin(angle)[:, None] * e2
        )


@dataclass(frozen=True, eq=False)
class Patch:
    """A Bezier patch as a contact region; `off_surface` where it is meant to lie off that of its body."""

    patch: BezierPatch
    off_surface: bool = False

    def middle(self) -> tuple[Array, Array]:
        """Point (3,) in m and unit outward normal (3,) in the middle."""
        return self.patch.evaluate(0.5, 0.5), self.patch.unit_normal(0.5, 0.5)

    def spread(self) -> tuple[Array, Array]:
        """Points and unit normals, each (49, 3), even in the parameters, edges included."""
        t = np.linspace(0.0, 1.0, _GRID)
        u, v = (grid.ravel() for grid in np.meshgrid(t, t, indexing="ij"))
        return self.patch.evaluate(u, v), self.patch.unit_normal(u, v)

    def sample(self, count: int, rng: np.random.Generator) -> tuple[Array, Array]:
        """Points and unit normals, each (count, 3), uniform in the parameters."""
        u, v = rng.uniform(size=(2, count))
        return self.patch.evaluate(u, v), self.patch.unit_normal(u, v)


@dataclass(frozen=True, eq=False)
class PointRegion:
    """A single point (3,) in m with its unit outward normal (3,); `off_surface` as of other regions."""

    point: Array
    normal: Array
    off_surface: bool = False

    def middle(self) -> tuple[Array, Array]:
        """The point and its normal."""
        return self.point, self.normal

    def spread(self) -> tuple[Array, Array]:
        """The point and its normal, each (1, 3)."""
        return self.point[None, :], self.normal[None, :]

    def sample(self, count: int, rng: np.random.Generator) -> tuple[Array, Array]:
        """The point and its normal, `count` times."""
        del rng
        return np.tile(self.point, (count, 1)), np.tile(self.normal, (count, 1))


Region: TypeAlias = Cap | Patch | PointRegion
