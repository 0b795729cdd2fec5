"""Plates."""

from math import radians

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import Hull
from ...geometry.solids import Loft, solid_inertia
from ..object_model import Part
from .material import STONEWARE
from .member import Member
from .patches import flat, revolved

__all__ = ["make_plate"]


_HALF_REGION_DEG = 9.0
# The thumb above, between a finger under the rim and two under the base: gravity tips it neither way.
_SUPPORTED = (
    (
        ("thumb/tip", "base_above"),
        ("index/tip", "rim_below"),
        ("middle/tip", "base_below"),
        ("ring/tip", "base_below"),
    ),
)


def make_plate(rng: np.random.Generator) -> Member:
    """A plate about z with a sloping rim, held by the rim at +x: thumb above, index finger below."""
    radius, thickness = rng.uniform(0.06, 0.11), rng.uniform(0.004, 0.006)
    base, rise = radius - rng.uniform(0.022, 0.035), rng.uniform(0.004, 0.016)
    section = np.array([[base, 0.0], [radius, rise], [radius, rise + thickness], [base, thickness]])
    angles = _angles()
    rim = _ring(section, angles)
    disc = _ring(np.array([[base, 0.0], [base, thickness]]), angles)
    outline = np.vstack([section[:3], section[3:]])
    mesh = Loft(_ring(outline, angles).transpose(1, 0, 2)).mesh()
    pieces = (Hull.from_points(disc.reshape(-1, 3)), *Loft(rim, is_loop=True).pieces(_cuts(angles)))
    part = Part("plate", mesh, pieces, solid_inertia(mesh, STONEWARE.density), STONEWARE.rgba)
    below, above = section[:2], section[[2, 3]]
    wide = radians(_HALF_REGION_DEG)
    x, length, y = 0.2 * base, 0.65 * base, 0.4 * base
    regions = {
        "rim_below": revolved(_shrunk(below), -wide, wide),
        "rim_above": revolved(_shrunk(above), -wide, wide),
        "base_below": flat(np.array([x, y, 0.0]), np.array([length, 0, 0]), np.array([0, -2 * y, 0])),
        "base_above": flat(np.array([x, -y, thickness]), np.array([length, 0, 0]), np.array([0, 2 * y, 0])),
    }
    return Member(
        (part,),
        regions,
        (("index/tip", "rim_below"), ("thumb/tip", "rim_above")),
        {"mass": f"solid {STONEWARE}"},
        _SUPPORTED,
    )


def _angles() -> Array:
    """Degrees about z: close together at the regions, where a chord across the hollow side would show."""
    fine = np.arange(-12.0, 12.0, 2.0)
    return np.concatenate([fine, np.arange(12.0, 348.0, 4.0)])


def _cuts(angles: Array) -> tuple[int, ...]:
    """Sections of the rim between which it is filled: 4 degrees at the regions, elsewhere 28."""
    near = [i for i, a in enumerate(angles) if -12.0 <= a < 12.0][::2]
    far = [i for i, a in enumerate(angles) if a >= 12.0][::7]
    return (*near, *far, len(angles))


def _ring(section: Array, angles_deg: Array) -> Array:
    """Sections (k, n, 3) of a body of revolution at the angles (k,)."""
    a = np.radians(angles_deg)[:, None]
    radius, height = section[None, :, 0], section[None, :, 1]
    return np.stack(
        [radius * np.cos(a), radius * np.sin(a), np.broadcast_to(height, (len(a), len(section)))], -1
    )


def _shrunk(segment: Array) -> Array:
    """The middle 70 % of a segment (2, 2)."""
    return np.array([0.85 * segment[0] + 0.15 * segment[1], 0.15 * segment[0] + 0.85 * segment[1]])
