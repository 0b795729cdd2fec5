"""Handles of tools: a plastic grip with a steel shaft."""

from math import pi, radians

import numpy as np

from ...geometry import bernstein
from ...geometry.solids import revolve, solid_inertia
from ..object_model import Part
from .material import POLYPROPYLENE, STAINLESS_STEEL
from .member import Member
from .patches import revolved

__all__ = ["make_handle"]

_SIDES = 72
_ROWS = 25


def make_handle(rng: np.random.Generator) -> Member:
    """A grip about z with a bulge, and a shaft: held by index and middle finger against the thumb.

    The grip's profile is one Bezier curve of degree 4, so that the regions on it are exact in their height.
    """
    length, ends = rng.uniform(0.08, 0.13), rng.uniform(0.009, 0.014)
    bulge = ends * rng.uniform(1.2, 1.9)
    radii = np.array([ends, bulge, rng.uniform(1.0, 1.3) * ends, bulge, ends])
    profile = np.column_stack([radii, length * np.linspace(0.0, 1.0, 5)])
    rows = bernstein(4, np.linspace(0.0, 1.0, _ROWS)) @ profile
    loft = revolve(rows, _SIDES)
    mesh = loft.mesh()
    grip = Part(
        "grip",
        mesh,
        loft.pieces(loft.find_cuts(6e-5)),
        solid_inertia(mesh, POLYPROPYLENE.density),
        POLYPROPYLENE.rgba,
    )
    radius, reach = rng.uniform(0.002, 0.004), rng.uniform(0.04, 0.12)
    bar = revolve(np.array([[radius, length - 0.01], [radius, length + reach]]), 24)
    steel = bar.mesh()
    shaft = Part(
        "shaft",
        steel,
        bar.pieces((0, 1)),
        solid_inertia(steel, STAINLESS_STEEL.density),
        STAINLESS_STEEL.rgba,
    )
    regions = {}
    for name, angle, low, high in (
        ("thumb", pi, 0.25, 0.75),
        ("index", radians(12.0), 0.5, 0.9),
        ("middle", radians(-12.0), 0.1, 0.5),
    ):
        whole = revolved(profile, angle - radians(30.0), angle + radians(30.0))
        regions[name] = type(whole)(whole.patch.restrict((0.0, 1.0), (low, high)))
    return Member(
        (grip, shaft),
        regions,
        (("thumb/tip", "thumb"), ("index/tip", "index"), ("middle/tip", "middle")),
        {"mass": f"grip of solid {POLYPROPYLENE}; shaft of {STAINLESS_STEEL}"},
    )
