"""Contacts that begin where a link has sunk into the object's convex pieces by what these stand out there.

Otherwise pieces that stand out of the true surface would push a finger away that only touches this surface.
"""

import xml.etree.ElementTree as ET
from collections.abc import Sequence

from ...objects import Part, Task
from ...retraction import collision_model
from ..settings import HoldSettings
from .document import section
from .xml import element, numbers

__all__ = ["add_sunk_contacts", "pair_friction"]


def pair_friction(sliding: float, torsional: float) -> list[float]:
    """Friction of a contact as MuJoCo's pairs have it: sliding twice, torsional in m, rolling twice."""
    return [sliding, sliding, torsional, 0.0001, 0.0001]


def add_sunk_contacts(root: ET.Element, task: Task, parts: Sequence[Part], settings: HoldSettings) -> None:
    """Adds a pair for each shape of a link and each piece of a part that may sink in deeper than others.

    Args:
        root: a model that has the geoms of both already.
        task: the task.
        parts: parts of its object that touch.
        settings: friction and stiffness of contacts.
    """
    model, obj = collision_model(task), task.object
    friction = pair_friction(settings.sliding_friction(obj), settings.torsional_friction(obj))
    pieces = {f"object/{part.name}": len(part.pieces) for part in parts}
    for pair in model.pairs:
        link, part = model.name(pair)
        if pair.stands_out_m == 0.0 or part not in pieces:
            continue
        for i in range(len(task.hand.links[pair.a].shapes)):
            for k in range(pieces[part]):
                element(
                    section(root, "contact"),
                    "pair",
                    geom1=f"{link}/{i}",
                    geom2=f"{part}_{k}",
                    condim="4",
                    # Forces begin below the margin. The gap has contacts looked for up to depth zero: with
                    # a negative range MuJoCo's distances of two meshes would be too deep.
                    margin=numbers([-pair.stands_out_m]),
                    gap=numbers([pair.stands_out_m]),
                    friction=numbers(friction),
                    solref=numbers(settings.contact_solref),
                    solimp=numbers(settings.contact_solimp),
                )
