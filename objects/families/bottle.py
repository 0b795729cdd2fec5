"""Bottles, from empty to full."""

from math import pi, radians

import numpy as np

from ...geometry import combined_mass
from ...geometry.solids import Loft, revolve, shell_inertia, solid_inertia
from ..object_model import Part
from .material import GLASS, PET, WATER
from .member import Member
from .patches import revolved

__all__ = ["make_bottle"]

_SIDES = 96
_SHOULDER_STEPS = 8
_TOLERANCE_M = 5e-5


def make_bottle(rng: np.random.Generator) -> Member:
    """A bottle about z with a round shoulder and a neck, held around its body by index finger and thumb.

    Of PET with walls of 0.4 mm, or of glass with 2.5 mm; up to half full of water.
    """
    material, wall = ((PET, 0.0004), (GLASS, 0.0025))[int(rng.integers(2))]
    radius, body = rng.uniform(0.018, 0.030), rng.uniform(0.06, 0.11)
    neck, shoulder, top = rng.uniform(0.009, 0.013), rng.uniform(0.02, 0.035), rng.uniform(0.015, 0.03)
    level = rng.uniform(0.0, 0.5) * body
    t = np.linspace(0.0, 1.0, _SHOULDER_STEPS + 1)
    # A smooth step from the body's radius to the neck's.
    bend = neck + (radius - neck) * (1.0 - t) ** 2 * (1.0 + 2.0 * t)
    profile = np.vstack(
        [[radius, 0.0], np.column_stack([bend, body + shoulder * t]), [neck, body + shoulder + top]]
    )
    loft = revolve(profile, _SIDES)
    mesh = loft.mesh()
    inertias = [shell_inertia(np.array(mesh.triangles), wall * material.density)]
    if level > 0.0:
        filled = revolve(np.array([[radius - wall, wall], [radius - wall, wall + level]]), _SIDES).mesh()
        inertias.append(solid_inertia(filled, WATER.density))
    part = Part("bottle", mesh, loft.pieces(_cuts(loft)), combined_mass(inertias), material.rgba)
    band = np.array([[radius, 0.35 * body], [radius, 0.95 * body]])
    wide = radians(30.0)
    return Member(
        (part,),
        {"front": revolved(band, -wide, wide), "back": revolved(band, pi - wide, pi + wide)},
        (("index/tip", "front"), ("thumb/tip", "back")),
        {"mass": f"walls of {1e3 * wall:g} mm of {material}; filled {1e3 * level:.0f} mm high with {WATER}"},
    )


def _cuts(loft: Loft) -> tuple[int, ...]:
    """Of the shoulder, where hands do not touch, half a millimetre may be filled."""
    tolerance = np.full(len(loft.rings), 5e-4)
    tolerance[:2] = _TOLERANCE_M
    return loft.find_cuts(tolerance)
