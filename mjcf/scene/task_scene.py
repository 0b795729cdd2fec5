"""What a viewer shows of a task: meshes with a colour, each on a body that numbers pose."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import trimesh

from ...base.numeric.arrays import Picture
from ...geometry import shape_mesh
from ...objects import Task, light_mesh
from ..model import shape_rgba
from ..render import colour_of, region_sheet

__all__ = ["SceneNode", "task_nodes"]

# So many triangles each surface of a part has at most, and how far a region's sheet is off its surface.
_MOST_TRIANGLES = 30_000
_LIFT_M = 0.0006

NodeKind = Literal["link", "part", "piece", "skin", "place"]


@dataclass(frozen=True, eq=False)
class SceneNode:
    """A mesh on a body.

    Attributes:
        name: unique: `link_<i>_<shape>`, `part_<i>`, `piece_<part>_<i>`, and of contact i `skin_<i>`, its
            region of the hand, and `place_<i>`, that of the object.
        kind: the first word of the name.
        link: index of the link that it is fixed on; None where that is the object.
        mesh: in the frame of the link or the object, in m.
        rgba: colour.
        rgb: colours (n, 3) of the vertices in its place; None where all of it has one.
        moves: whether the test moves it, as it does not the parts that stay behind.
    """

    name: str
    kind: NodeKind
    link: int | None
    mesh: trimesh.Trimesh
    rgba: tuple[float, float, float, float]
    moves: bool = True
    rgb: Picture | None = None


def task_nodes(task: Task) -> Iterator[SceneNode]:
    """All that is seen of hand, object and the regions that touch."""
    hand, obj = task.hand, task.object
    for i, link in enumerate(hand.links):
        for k, shape in enumerate(link.shapes):
            yield SceneNode(f"link_{i}_{k}", "link", i, shape_mesh(shape), shape_rgba(hand, link, shape))
    behind = {part.name for part in task.obstacles} if task.carried else set[str]()
    for i, part in enumerate(obj.parts):
        moves = part.name not in behind
        if part.paint is None:
            mesh, rgb = light_mesh(part.mesh, _MOST_TRIANGLES), None
        else:
            mesh = trimesh.Trimesh(part.paint.vertices, part.paint.faces, process=False)
            rgb = part.paint.rgb
        yield SceneNode(f"part_{i}", "part", None, mesh, part.rgba, moves, rgb)
        for k, piece in enumerate(part.pieces):
            yield SceneNode(f"piece_{i}_{k}", "piece", None, shape_mesh(piece), _rgba(k), moves)
    for i, contact in enumerate(task.contacts):
        skin = region_sheet(contact.hand.region, _LIFT_M)
        yield SceneNode(f"skin_{i}", "skin", contact.hand.link, skin, _rgba(i))
        place = region_sheet(contact.object.region, _LIFT_M)
        yield SceneNode(f"place_{i}", "place", None, place, _rgba(i))


def _rgba(number: int) -> tuple[float, float, float, float]:
    """The colour of what belongs together."""
    red, green, blue = (c / 255.0 for c in colour_of(number))
    return red, green, blue, 1.0
