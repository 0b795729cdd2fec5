"""Tasks for the tests of statics: built-in ones whose regions need friction, and regions by hand."""

from dataclasses import replace

import numpy as np
from holdfast.geometry import Cap, PointRegion, Region
from holdfast.objects import ObjectRegion, Task, load_task

# The least friction that local search from very many starts has found (`./run bench stable`).
LIMITS = {"upholding": 0.37977, "handling": 0.16058}


def with_regions(task: Task, regions: list[Region]) -> Task:
    """The task with other regions of its object, which need not lie on it."""
    contacts = tuple(
        replace(contact, object=ObjectRegion(f"r{k}", region))
        for k, (contact, region) in enumerate(zip(task.contacts, regions, strict=True))
    )
    return replace(task, contacts=contacts)


def leaning(lean_rad: float) -> list[np.ndarray]:
    """Normals at both sides of a body, which lean to the same side by an angle from the line between."""
    return [np.array([side * np.cos(lean_rad), np.sin(lean_rad), 0.0]) for side in (1.0, -1.0)]


def pinch(lean_rad: float, half_width_m: float = 0.02, *, turned: bool = False) -> Task:
    """Two points beside the centre of mass with normals that lean; they need friction tan(lean).

    Both lean to the same side or, where they are turned, to opposite ones, so that the faces are parallel.
    """
    task = load_task("upholding")
    centre = np.asarray(task.object.inertia.centre)
    normals = leaning(lean_rad)
    if turned:
        normals[1] = -normals[0]
    return with_regions(
        task,
        [
            PointRegion(centre + side * half_width_m * np.array([1.0, 0.0, 0.0]), normal, off_surface=True)
            for side, normal in zip((1.0, -1.0), normals, strict=True)
        ],
    )


def caps(lean_rad: float, half_angle_rad: float, radius_m: float = 0.01) -> Task:
    """Two spherical caps whose axes lean."""
    task = load_task("upholding")
    centre = np.asarray(task.object.inertia.centre)
    return with_regions(
        task,
        [
            Cap(centre + side * np.array([0.02, 0.0, 0.0]), radius_m, axis, half_angle_rad, off_surface=True)
            for side, axis in zip((1.0, -1.0), leaning(lean_rad), strict=True)
        ],
    )
