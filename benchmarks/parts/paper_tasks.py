"""The nine benchmark tasks of the paper (Table 2), for timing and for tests.

Seven are read from a JSON file with the numbers that the authors published: spherical caps on the hand,
bilinear patches on the object, each in the frame of its body. The hand is the built-in SA hand with the
paper's own limits and exact coupling. Bodies are plain boxes around the patches, for want of the meshes.

The regions of `playing` and `holding` were never published. Their stand-ins here have the paper's contact
structure (so the counts of Table 2 hold) on a plain guitar neck, with patches of our own choosing: their
times say nothing about the paper's.
"""

import json
from pathlib import Path
from typing import Any

import numpy as np
from holdfast.base.numeric.arrays import Array
from holdfast.geometry import BezierPatch, Box, Cap, Patch, Region, mass_properties, shape_mesh
from holdfast.geometry.shapes import Hull
from holdfast.hands import Hand, HandRegion, load_hand
from holdfast.objects import Contact, ObjectModel, ObjectRegion, Part, Task

__all__ = ["TABLE_2", "load_paper_tasks", "stand_in_tasks"]


# n_v, n_e and d as printed, the rows that Table 2 lost restored.
TABLE_2 = {
    "upholding": (219, 209, 17),
    "handling": (243, 235, 16),
    "incision": (331, 324, 18),
    "lid lifting": (219, 209, 17),
    "service": (288, 278, 19),
    "transportation": (312, 305, 17),
    "tuning": (219, 209, 17),
    "playing": (307, 298, 19),
    "holding": (331, 324, 18),
}
_MM = 1e-3
# Walls of the placeholder boxes stand this far outside the patches.
_MARGIN_M = 1e-3
_DENSITY = 1000.0
_FRICTION = 0.6
_FINGERTIP = ([0.020, 0.0, 0.0], 0.013, [0.14, 0.0, 0.99], 90.0)
_PALM = ([0.00255, -0.00005, 0.11735], 0.018, [1.0, 0.0, 0.0], 90.0)


def load_paper_tasks(path: str | Path) -> dict[str, Task]:
    """The published tasks by name.

    Args:
        path: the JSON file of the published numbers (millimetres and degrees).

    Raises:
        FileNotFoundError: there is no such file; the numbers are not part of the package.
    """
    path = Path(path)
    if not path.is_file():
        raise FileNotFoundError(
            f"{path}: the published numbers of the benchmark are not shipped; pass the file that has them"
        )
    hand = load_hand("sa")
    return {entry["task"]: _published_task(entry, hand) for entry in json.loads(path.read_text())["tasks"]}


def stand_in_tasks() -> dict[str, Task]:
    """`playing` and `holding` with the paper's contact structure and placeholder regions."""
    hand = load_hand("sa")
    # A neck along x, 65 mm wide (y), 25 mm thick (z), strings towards +z.
    front, back = 0.0125, -0.0125
    strings = {
        "index_distal": _face([1.010, -0.018, front], [0.012, 0, 0], [0, 0.010, 0]),
        "middle_distal": _face([0.965, 0.000, front], [0.012, 0, 0], [0, 0.010, 0]),
    }
    playing = [_contact(hand, link, _FINGERTIP, patch) for link, patch in strings.items()]
    playing.append(
        _contact(hand, "thumb_distal", _FINGERTIP, _face([0.90, 0.0325, back], [0.2, 0, 0], [0, -0.065, 0]))
    )
    holding = [
        _contact(hand, link, _FINGERTIP, _face([0.90, -0.030, front], [0.2, 0, 0], [0, 0.025, 0]))
        for link in ("index_distal", "middle_distal")
    ]
    holding.append(
        _contact(hand, "thumb_distal", _FINGERTIP, _face([0.90, 0.005, front], [0.2, 0, 0], [0, 0.025, 0]))
    )
    holding.append(_contact(hand, "palm", _PALM, _face([0.90, 0.0325, back], [0.2, 0, 0], [0, -0.065, 0])))
    return {
        name: _task(name, "guitar", hand, contacts)
        for name, contacts in (("playing", playing), ("holding", holding))
    }


def _published_task(entry: dict[str, Any], hand: Hand) -> Task:
    contacts = []
    for contact in entry["contacts"]:
        cap = contact["cap"]
        numbers = (
            _MM * np.array(cap["centre_mm"]), _MM * cap["radius_mm"], cap["axis"], cap["half_angle_deg"]
        )  # fmt: skip
        net = _MM * np.array(contact["object_patch_mm"]["control_points"])
        contacts.append(_contact(hand, contact["hand_link"].replace(" ", "_"), numbers, net))
    return _task(entry["task"], entry["object"], hand, contacts)


def _contact(hand: Hand, link: str, cap: tuple[Any, float, Any, float], net: Array) -> Contact:
    centre, radius, axis, half_angle_deg = cap
    unit_axis = np.array(axis, dtype=float) / np.linalg.norm(axis)
    region = Cap(np.array(centre, dtype=float), radius, unit_axis, float(np.radians(half_angle_deg)), True)
    on_hand = HandRegion(f"{link}/cap", hand.link_index(link), region)
    return Contact(on_hand, ObjectRegion(f"for {link}", Patch(BezierPatch(net), off_surface=True)))


def _face(corner: list[float], along_u: list[float], along_v: list[float]) -> Array:
    """A flat bilinear net (2, 2, 3) from its corner and two sides."""
    p, a, b = np.array(corner, dtype=float), np.array(along_u, dtype=float), np.array(along_v, dtype=float)
    return np.array([[p, p + b], [p + a, p + a + b]])


def _task(name: str, object_name: str, hand: Hand, contacts: list[Contact]) -> Task:
    regions = {contact.object.name: contact.object.region for contact in contacts}
    return Task(
        name=name.replace(" ", "_"),
        hand=hand,
        object=_placeholder(object_name, regions),
        contacts=contacts,
    )


def _placeholder(name: str, regions: dict[str, Region]) -> ObjectModel:
    """A box around the patches, of the density of water."""
    nets = [r.patch.control_points.reshape(-1, 3) for r in regions.values() if isinstance(r, Patch)]
    points = np.concatenate(nets)
    low, high = points.min(axis=0) - _MARGIN_M, points.max(axis=0) + _MARGIN_M
    T = np.eye(4)
    T[:3, 3] = 0.5 * (low + high)
    box = Box(T, 0.5 * (high - low))
    mesh = shape_mesh(box)
    inertia = mass_properties((box,), _DENSITY * float(np.prod(high - low)))
    part = Part(name, mesh, (Hull.from_points(np.array(mesh.vertices)),), inertia)
    return ObjectModel(name, (part,), _FRICTION, regions, description="a box around the contact patches")
