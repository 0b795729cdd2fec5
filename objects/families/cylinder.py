"""Cylinders of wood, plastic or aluminium."""

from math import pi, radians

import numpy as np
import trimesh

from ...geometry.solids import revolve, solid_inertia
from ..object_model import Part
from .material import ALUMINIUM, OAK, POLYPROPYLENE
from .member import Member
from .patches import revolved

__all__ = ["make_cylinder"]

_SIDES = 96


def make_cylinder(rng: np.random.Generator) -> Member:
    """A solid rod about z, pinched across it between index finger and thumb."""
    radius, half = rng.uniform(0.005, 0.028), rng.uniform(0.03, 0.09)
    # Metal only where a hand still carries it with ease.
    materials = (OAK, POLYPROPYLENE, ALUMINIUM) if radius < 0.012 else (OAK, POLYPROPYLENE)
    material = materials[int(rng.integers(len(materials)))]
    loft = revolve(np.array([[radius, -half], [radius, half]]), _SIDES)
    mesh: trimesh.Trimesh = loft.mesh()
    part = Part("rod", mesh, loft.pieces((0, 1)), solid_inertia(mesh, material.density), material.rgba)
    band = np.array([[radius, -0.5 * half], [radius, 0.5 * half]])
    wide = radians(30.0)
    regions = {"front": revolved(band, -wide, wide), "back": revolved(band, pi - wide, pi + wide)}
    return Member(
        (part,), regions, (("index/tip", "front"), ("thumb/tip", "back")), {"mass": f"solid {material}"}
    )
