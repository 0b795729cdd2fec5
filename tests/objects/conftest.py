"""Meshes with known volume, made from scratch, and the mass of some parts of an object."""

import numpy as np
import pytest
import trimesh
from holdfast.geometry import MassProperties, combined_mass
from holdfast.objects import ObjectModel


def mass_of(obj: ObjectModel, names: list[str]) -> MassProperties:
    """Mass properties of the parts of these names, joined."""
    return combined_mass(part.inertia for part in obj.select_parts(names))


@pytest.fixture
def l_mesh() -> trimesh.Trimesh:
    """An L, 20 mm thick along z: a bar of 60 x 20 mm along x and one of 20 x 40 mm on it."""
    outline = 0.02 * np.array([(0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3)])
    low, high = (np.column_stack([outline, np.full(6, z)]) for z in (0.0, 0.02))
    lids = [(0, 1, 2), (0, 2, 3), (0, 3, 5), (3, 4, 5)]
    faces = [(a, c, b) for a, b, c in lids] + [(a + 6, b + 6, c + 6) for a, b, c in lids]
    for i in range(6):
        j = (i + 1) % 6
        faces += [(i, j, j + 6), (i, j + 6, i + 6)]
    return trimesh.Trimesh(np.vstack([low, high]), faces, process=False)


@pytest.fixture
def ring() -> trimesh.Trimesh:
    """A ring about z, as of a mug's handle: a square section of 10 mm at radii 20 to 30 mm."""
    return trimesh.creation.annulus(r_min=0.02, r_max=0.03, height=0.01, sections=24)
