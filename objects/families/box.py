"""Boxes of wood or plastic."""

import numpy as np

from ...geometry import Hull
from ..generators import convex_part
from .material import OAK, POLYPROPYLENE
from .member import Member
from .patches import flat

__all__ = ["make_box"]


def make_box(rng: np.random.Generator) -> Member:
    """A solid box, pinched across its thickness (x) between index finger and thumb."""
    material = (OAK, POLYPROPYLENE)[int(rng.integers(2))]
    half = np.array([rng.uniform(0.006, 0.025), rng.uniform(0.015, 0.05), rng.uniform(0.02, 0.07)])
    signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T
    hull = Hull.from_points(signs * half)
    x, y, z = half[0], 0.7 * half[1], 0.7 * half[2]
    regions = {
        "front": flat(np.array([x, -y, -z]), np.array([0, 2 * y, 0]), np.array([0, 0, 2 * z])),
        "back": flat(np.array([-x, y, -z]), np.array([0, -2 * y, 0]), np.array([0, 0, 2 * z])),
    }
    return Member(
        (convex_part("box", hull, material.density, material.rgba),),
        regions,
        (("index/tip", "front"), ("thumb/tip", "back")),
        {"mass": f"solid {material}"},
    )
