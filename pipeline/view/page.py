"""The page on which grasps are viewed; viser serves it."""

from collections.abc import Callable
from threading import RLock
from typing import Any

import numpy as np

from ...base.machine.browser_page import close_page, open_page
from ...base.numeric.arrays import Array
from ...geometry import quaternion_from_rotation
from ...hands import forward_kinematics
from ...mjcf.scene import task_nodes
from .viewable import Viewable

__all__ = ["ViewPage"]

_AXES_M, _AXES_RADIUS_M = 0.05, 0.001
# From the middle of the hand to the camera: how far, in m, and which way; the palm faces it.
_AWAY_M, _SIDE = 0.7, np.array([0.85, 0.4, 0.3])
_SHOWN = {"bodies": ("link", "part"), "contact regions": ("skin", "place"), "collision pieces": ("piece",)}


class ViewPage:
    """A page that shows grasps of one task, from when it is made until `stop`.

    Args:
        grasps: at least one.
        host: address to listen at.
        port: to listen at; the next free one if it is taken.

    Attributes:
        url: of the page.

    Raises:
        MissingBackend: the package viser is not installed.
    """

    def __init__(self, grasps: list[Viewable], *, host: str = "127.0.0.1", port: int = 8080):
        self._server, self.url = open_page("the viewer", host, port)
        self._grasps = {grasp.record.id: grasp for grasp in grasps}
        self._task = grasps[0].task
        self._lock = RLock()
        self._build_scene()
        self._build_controls()
        self._choose()

    def stop(self) -> None:
        """Ends the server."""
        close_page(self._server)

    def _build_scene(self) -> None:
        scene, links = self._server.scene, self._task.hand.links
        scene.set_up_direction("+z")
        self._axes = scene.add_frame("/palm_axes", axes_length=_AXES_M, axes_radius=_AXES_RADIUS_M)
        self._links = [scene.add_frame(f"/link_{i}", show_axes=False) for i in range(len(links))]
        self._object = scene.add_frame("/object", show_axes=False)
        self._stand = scene.add_frame("/stand", show_axes=False)
        self._nodes: dict[str, list[Any]] = {}
        for node in task_nodes(self._task):
            body = "stand" if not node.moves else "object" if node.link is None else f"link_{node.link}"
            name = f"/{body}/{node.name}"
            if node.rgb is None:
                colour = tuple(round(255.0 * share) for share in node.rgba[:3])
                vertices, faces = np.asarray(node.mesh.vertices), np.asarray(node.mesh.faces)
                mesh: Any = scene.add_mesh_simple(name, vertices, faces, color=colour, side="double")
            else:
                painted: Any = node.mesh.copy()
                painted.visual.vertex_colors = node.rgb
                mesh = scene.add_mesh_trimesh(name, painted)
            self._nodes.setdefault(node.kind, []).append(mesh)

    def _build_controls(self) -> None:
        gui = self._server.gui
        self._grasp = gui.add_dropdown("grasp", list(self._grasps))
        self._said = gui.add_markdown("")
        self._motion = gui.add_dropdown("motion", ["approach"])
        self._place = gui.add_slider("place on it", 0.0, 1.0, 0.005, 0.0)
        self._boxes = {name: gui.add_checkbox(name, name != "collision pieces") for name in _SHOWN}
        self._shows_axes = gui.add_checkbox("axes of the palm, 50 mm", True)
        self._grasp.on_update(self._doing(self._choose))
        self._motion.on_update(self._doing(self._begin))
        self._place.on_update(self._doing(self._pose))
        for box in (*self._boxes.values(), self._shows_axes):
            box.on_update(self._doing(self._show))

    def _doing(self, change: Callable[[], None]) -> Callable[[Any], None]:
        def call(_: Any) -> None:
            with self._lock:
                change()

        return call

    def _choose(self) -> None:
        chosen = self._grasps[self._grasp.value]
        names = [motion.name for motion in chosen.motions]
        self._motion.options = names
        self._motion.value = names[0]
        hold = chosen.record.hold
        tested = "not tested"
        if hold is not None and hold.directions:
            tested = f"held {hold.held_count} of {len(hold.directions)}"
            tested += ", narrowly" if chosen.record.is_narrow else ""
            tested += ", unreachable" if chosen.record.is_unreachable else ""
        self._said.content = f"{chosen.task.name}: {tested}"
        pose = np.array([*chosen.record.object.position, *chosen.record.object.quaternion])
        _move(self._stand, pose[:3], pose[3:])
        self._begin()
        self._show()
        self._aim()

    def _begin(self) -> None:
        self._place.value = 0.0
        self._pose()

    def _pose(self) -> None:
        chosen = self._grasps[self._grasp.value]
        named = {motion.name: motion for motion in chosen.motions}
        state = named.get(self._motion.value, chosen.motions[0]).at(float(self._place.value))
        with self._server.atomic():
            for frame, T in zip(self._links, forward_kinematics(self._task.hand, state[:-7]), strict=True):
                _move(frame, T[:3, 3], quaternion_from_rotation(T[:3, :3]))
            _move(self._object, state[-7:-4], state[-4:])

    def _show(self) -> None:
        for name, kinds in _SHOWN.items():
            for kind in kinds:
                # Pieces stand in the place of the object's surface.
                covered = kind == "part" and self._boxes["collision pieces"].value
                for mesh in self._nodes.get(kind, []):
                    mesh.visible = self._boxes[name].value and not covered
        self._axes.visible = self._shows_axes.value

    def _aim(self) -> None:
        """Turns the cameras of all pages, open ones and those to come, to the middle of the hand."""
        middle = np.mean([np.asarray(frame.position) for frame in self._links], axis=0)
        eye = middle + _AWAY_M * _SIDE / np.linalg.norm(_SIDE)
        opened = [client.camera for client in self._server.get_clients().values()]
        for camera in (self._server.initial_camera, *opened):
            camera.position, camera.look_at = tuple(eye), tuple(middle)


def _move(frame: Any, position: Array, quaternion: Array) -> None:
    frame.position, frame.wxyz = position, quaternion
