"""The details of a task, a hand or an object as plain data: what `--json` writes; SI units."""

from typing import Any

from .....geometry import ConvexSurface, Placement, Region, place_region
from .....hands import Hand, hand_placement
from .....objects import ObjectModel, Task, describe_test, object_placement

__all__ = ["hand_data", "object_data", "task_data"]


def task_data(task: Task) -> dict[str, Any]:
    """A task: what touches what, and the limits of the joints in it."""
    return {
        "name": task.name,
        "description": task.description,
        "hand": task.hand.name,
        "object": task.object.name,
        "test": describe_test(task.test),
        "contacts": [{"hand": contact.hand.name, "object": contact.object.name} for contact in task.contacts],
        "limits": dict(zip(task.hand.independent_names, task.limits.tolist(), strict=True)),
    }


def hand_data(hand: Hand) -> dict[str, Any]:
    """A hand: its joints, its regions, and how these lie on their links."""
    return {
        "name": hand.name,
        "description": hand.description,
        "mass": sum(link.inertia.mass for link in hand.links),
        "joints": [
            {
                "name": axis.name,
                "link": link.name,
                "kind": axis.kind,
                "limits": [axis.lower, axis.upper],
                "driven_by": axis.coupling.master if axis.coupling else None,
            }
            for link in hand.links
            for axis in link.axes
        ],
        "regions": [
            {
                "name": key,
                "link": hand.links[region.link].name,
                **_region(region.region, hand_placement(hand, region)),
            }
            for key, region in hand.regions.items()
        ],
        "notes": list(hand.notes),
        "sources": dict(hand.sources),
    }


def object_data(obj: ObjectModel) -> dict[str, Any]:
    """An object: its body, its parts and its regions."""
    surface = ConvexSurface(obj.pieces)
    return {
        "name": obj.name,
        "description": obj.description,
        "size": obj.mesh.extents.tolist(),
        "mass": obj.inertia.mass,
        "centre": obj.inertia.centre.tolist(),
        "friction": obj.friction,
        "parts": [
            {
                "name": part.name,
                "pieces": len(part.pieces),
                "inflation": part.inflation,
                "outside": None if part.closeness is None else part.closeness.outside_m,
                "missing": None if part.closeness is None else part.closeness.missing_m,
            }
            for part in obj.parts
        ],
        "regions": [
            {
                "name": key,
                "off_pieces": place_region(region, surface).off_m,
                **_region(region, object_placement(obj, region)),
            }
            for key, region in obj.regions.items()
        ],
        "sources": dict(obj.sources),
    }


def _region(region: Region, placement: Placement) -> dict[str, Any]:
    return {
        "kind": type(region).__name__.lower(),
        "off_surface": placement.off_m,
        "off_surface_at_most": placement.farthest_m,
        "normals_off": placement.normal_rad,
    }
