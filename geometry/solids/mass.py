"""Mass properties of solid and of hollow bodies from their surface."""

import numpy as np
import trimesh
from numpy.typing import NDArray

from ..shapes import MassProperties

__all__ = ["shell_inertia", "solid_inertia"]


def solid_inertia(mesh: trimesh.Trimesh, density: float) -> MassProperties:
    """Mass properties of the inside of a closed, outward mesh, of uniform density in kg/m^3."""
    volume = float(mesh.volume)
    # trimesh's own density stands in its moments.
    inertia = np.array(mesh.moment_inertia) / mesh.density * density
    return MassProperties(density * volume, np.array(mesh.center_mass), 0.5 * (inertia + inertia.T))


def shell_inertia(triangles: NDArray[np.float64], kg_per_m2: float) -> MassProperties:
    """Mass properties of a thin shell made of triangles (n, 3, 3), exact for flat ones."""
    areas = 0.5 * np.linalg.norm(
        np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1
    )
    masses = kg_per_m2 * areas
    mass = float(masses.sum())
    centre = masses @ triangles.mean(axis=1) / mass
    # The mean of x x^T over a triangle: its corners with weight 1/12 each, its centroid with 3/4.
    corners, middle = triangles - centre, triangles.mean(axis=1) - centre
    second = np.einsum("t,tci,tcj->ij", masses / 12.0, corners, corners)
    second += np.einsum("t,ti,tj->ij", 0.75 * masses, middle, middle)
    return MassProperties(mass, centre, np.trace(second) * np.eye(3) - second)
