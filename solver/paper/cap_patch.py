"""The unit normals of a spherical cap as a polynomial patch over [0, 1]^2.

The paper takes every region as a Bezier patch; the authors' files have spherical caps, whose points are
centre + radius * m with m a unit vector near an axis. A cap joins the paper's scheme through equation (24)
with a patch of normals: with x, y = rho (2u - 1), rho (2v - 1) and r^2 = x^2 + y^2, in a frame whose third
axis is the cap's,

    m(u, v) = (2x, 2y, 1 - r^2),                             |m| = 1 + r^2,      rho = tan(half angle / 2)

is stereographic projection, of degree 2 x 2, for half angles up to 90 degrees. Wider caps take twice the
angle from the axis, of degree 4 x 4, which covers the whole sphere:

    m(u, v) = (4x (1 - r^2), 4y (1 - r^2), 1 - 6r^2 + r^4),  |m| = (1 + r^2)^2,  rho = tan(half angle / 4).

In both |m| is a polynomial too and never vanishes, so (20) and (22) hold as printed, and (17) becomes
h = centre + radius * m_unit. The square of parameters covers a little more than the cap, which the
inequality m_unit . axis >= cos(half angle) cuts off; a cap counts as many variables and equations as a patch.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import BezierPatch, Cap, bernstein, perpendicular

__all__ = ["CapPatch"]


@dataclass(frozen=True, eq=False)
class CapPatch:
    """The normals of a cap over the unit square."""

    cap: Cap

    @property
    def doubled(self) -> bool:
        """Whether the angle is doubled (degree 4) rather than plain stereographic (degree 2)."""
        return self.cap.half_angle_rad > 0.5 * np.pi + 1e-12

    @property
    def reach(self) -> float:
        """Half the side rho of the square of parameters x and y."""
        return float(np.tan(self.cap.half_angle_rad / (4.0 if self.doubled else 2.0)))

    @cached_property
    def normal(self) -> BezierPatch:
        """The unnormalised normals m(u, v) in the frame of the link."""
        degree = 4 if self.doubled else 2
        t = np.linspace(0.0, 1.0, degree + 1)
        x, y = np.meshgrid(self.reach * (2.0 * t - 1.0), self.reach * (2.0 * t - 1.0), indexing="ij")
        # A polynomial of this degree is its own interpolant.
        to_bernstein = np.linalg.inv(bernstein(degree, t))
        return BezierPatch(np.einsum("ia,jb,abk->ijk", to_bernstein, to_bernstein, self._normal(x, y)))

    def params(self, normal: Array) -> tuple[float, float]:
        """The parameters (u, v) of the unit normal (3,) in the frame of the link."""
        e1, e2 = perpendicular(self.cap.axis)
        sine = np.array([e1 @ normal, e2 @ normal])
        angle = np.arctan2(np.linalg.norm(sine), self.cap.axis @ normal)
        half = np.tan(angle / (4.0 if self.doubled else 2.0))
        # Opposite to the axis every direction leads to the same normal.
        direction = sine / np.linalg.norm(sine) if np.any(sine) else np.array([1.0, 0.0])
        u, v = 0.5 + 0.5 * half / self.reach * direction
        return float(u), float(v)

    def _normal(self, x: Array, y: Array) -> Array:
        r2 = x * x + y * y
        if self.doubled:
            local = np.stack([4.0 * x * (1.0 - r2), 4.0 * y * (1.0 - r2), 1.0 - 6.0 * r2 + r2 * r2], axis=-1)
        else:
            local = np.stack([2.0 * x, 2.0 * y, 1.0 - r2], axis=-1)
        return local @ np.vstack([perpendicular(self.cap.axis), self.cap.axis])
