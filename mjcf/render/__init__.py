"""Pictures of grasps and films of their tests, and of hands, objects and tasks with their regions."""

from .diagram import Diagram, Mark, grasp_diagram, hand_diagram, object_diagram, task_diagrams
from .labels import colour_of
from .picture import SIDES, draw_diagrams, parse_view
from .png import write_png, write_video
from .region_mesh import region_sheet
from .studio import Studio

__all__ = [
    "SIDES",
    "Diagram",
    "Mark",
    "Studio",
    "colour_of",
    "draw_diagrams",
    "grasp_diagram",
    "hand_diagram",
    "object_diagram",
    "parse_view",
    "region_sheet",
    "task_diagrams",
    "write_png",
    "write_video",
]
