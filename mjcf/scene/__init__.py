"""Hand and object of a task as one GLB file, whose nodes numbers can pose: for viewers in a browser."""

from .glb import task_glb
from .task_scene import SceneNode, task_nodes

__all__ = ["SceneNode", "task_glb", "task_nodes"]
