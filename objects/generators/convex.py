"""Convex parts: outlines swept along an axis, and hulls of uniform density."""

import numpy as np
import trimesh
from numpy.typing import NDArray

from ...geometry import Hull
from ...geometry.solids import solid_inertia
from ..object_model import Part

__all__ = ["convex_part", "extrude"]


def extrude(outline: NDArray[np.float64], low: float, high: float, axis: int) -> Hull:
    """Hull of a convex outline (n, 2) swept along `axis` from `low` to `high`, in m."""
    others = [i for i in range(3) if i != axis]
    points = np.zeros((2, len(outline), 3))
    points[..., others] = outline
    points[0, :, axis], points[1, :, axis] = low, high
    return Hull.from_points(points.reshape(-1, 3))


def convex_part(name: str, hull: Hull, density: float, rgba: tuple[float, float, float, float]) -> Part:
    """A part that is one convex piece, of uniform density in kg/m^3."""
    mesh = trimesh.Trimesh(hull.vertices, hull.faces, process=False)
    return Part(name, mesh, (hull,), solid_inertia(mesh, density), rgba)
