"""What the editor's page shows: object, hand and regions, in the object's frame, and from where."""

from collections.abc import Callable
from typing import Any

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import Region, invert, pose, quaternion_from_rotation, shape_mesh, transform_points
from ...hands import forward_kinematics
from ...mjcf.render import colour_of, region_sheet
from ...solver import Configuration
from .draft import Draft

__all__ = ["EditorScene"]

_BODY, _LINK = (200, 203, 208), (150, 158, 170)
# Lift of a region's sheet and length of its arrow, in sizes of the object.
_LIFT, _ARROW = 0.003, 0.12
# From the camera to the middle of hand and object: how far, in sizes of both, and which way.
_DISTANCE, _SIDE = 1.0, np.array([0.9, 0.2, 0.4])
# The hand beside the object is so far from it, in sizes of the object.
_APART = 0.3


class EditorScene:
    """Bodies and regions of a draft, on a viser server.

    Args:
        server: viser's.
        draft: what is shown.
        q_independent: posture (n_independent,) of the hand beside the object.
        on_click: is called with viser's event when the object is clicked.
    """

    def __init__(
        self, server: Any, draft: Draft, q_independent: Array, on_click: Callable[[Any], None]
    ) -> None:
        self._server, self._draft = server, draft
        self._regions: list[Any] = []
        self._q_apart = draft.hand.expand(q_independent)
        self._T_apart = self._beside()
        scene, obj = server.scene, draft.object
        axes = {"axes_length": 0.3 * obj.size_m, "axes_radius": 0.004 * obj.size_m}
        scene.set_up_direction("+z")
        scene.add_frame("/axes", **axes)
        mesh = scene.add_mesh_simple("/object", *_mesh(obj.mesh), color=_BODY, flat_shading=True)
        mesh.on_click(on_click)
        self._palm = scene.add_frame("/palm", **axes)
        self._links = []
        for link in draft.hand.links:
            self._links.append(scene.add_frame(f"/palm/{link.name}", show_axes=False))
            for i, shape in enumerate(link.shapes):
                scene.add_mesh_simple(f"/palm/{link.name}/{i}", *_mesh(shape_mesh(shape)), color=_LINK)
        self.place_hand(None)
        self.aim()

    def place_hand(self, configuration: Configuration | None) -> None:
        """The hand at the object as a configuration has it; beside the object for None."""
        if configuration is None:
            self._q, self._T_object_palm = self._q_apart, self._T_apart
        else:
            state = configuration.state
            self._q = configuration.joint_vector
            self._T_object_palm = invert(pose(state.R_palm_object, state.p_palm_object))
        _move(self._palm, self._T_object_palm)
        for frame, T_palm_link in zip(
            self._links, forward_kinematics(self._draft.hand, self._q), strict=True
        ):
            _move(frame, T_palm_link)

    def aim(self) -> None:
        """Turns every camera to the middle of object and hand, far enough to see both."""
        bounds = np.vstack([self._draft.object.mesh.bounds, self._hand_bounds(self._q, self._T_object_palm)])
        low, high = bounds.min(axis=0), bounds.max(axis=0)
        middle = 0.5 * (low + high)
        eye = middle + _DISTANCE * float(np.linalg.norm(high - low)) * _SIDE
        # That of pages that are open, and of those still to come.
        opened = [client.camera for client in self._server.get_clients().values()]
        for camera in (self._server.initial_camera, *opened):
            camera.position = tuple(eye)
            camera.look_at = tuple(middle)

    def draw_regions(self) -> None:
        """The regions of all pairs as they are now; those of a pair have one colour."""
        for handle in self._regions:
            handle.remove()
        self._regions = []
        for i, pair in enumerate(self._draft.pairs):
            link = self._draft.hand.links[pair.hand.link].name
            self._draw(f"/palm/{link}/region_{i}", pair.hand.region, i)
            if pair.object is not None:
                self._draw(f"/region_{i}", pair.object.region, i)

    def _beside(self) -> Array:
        """Where the palm is (4, 4) in the object's frame when the hand is beside the object."""
        low, high = np.asarray(self._draft.object.mesh.bounds)
        hand = self._hand_bounds(self._q_apart, np.eye(4))
        shift = 0.5 * (low + high - hand[0] - hand[1])
        shift[1] = high[1] - hand[0, 1] + _APART * self._draft.object.size_m
        return pose(np.eye(3), shift)

    def _hand_bounds(self, q: Array, T_object_palm: Array) -> Array:
        """Corners (2, 3) of a box around the hand at a joint vector, in the object's frame."""
        corners = [T_object_palm[None, :3, 3]]
        for link, T_palm_link in zip(
            self._draft.hand.links, forward_kinematics(self._draft.hand, q), strict=True
        ):
            T = T_object_palm @ T_palm_link
            meshes = (shape_mesh(shape) for shape in link.shapes)
            corners += [transform_points(T, np.asarray(mesh.vertices)) for mesh in meshes]
        points = np.concatenate(corners)
        return np.array([points.min(axis=0), points.max(axis=0)])

    def _draw(self, name: str, region: Region, number: int) -> None:
        size, colour = self._draft.object.size_m, colour_of(number)
        point, normal = region.middle()
        tip = point + _ARROW * size * normal
        scene = self._server.scene
        sheet = _mesh(region_sheet(region, _LIFT * size))
        self._regions.append(scene.add_mesh_simple(name, *sheet, color=colour, side="double"))
        # Below the sheet, so that they go with it.
        scene.add_arrows(
            f"{name}/normal",
            np.array([[point, tip]]),
            colour,
            shaft_radius=0.004 * size,
            head_radius=0.012 * size,
            head_length=0.03 * size,
        )
        scene.add_label(f"{name}/name", f"{number + 1}", position=tuple(point + 1.1 * (tip - point)))


def _mesh(mesh: Any) -> tuple[Array, Any]:
    return np.asarray(mesh.vertices), np.asarray(mesh.faces)


def _move(frame: Any, T: Array) -> None:
    frame.position, frame.wxyz = T[:3, 3], quaternion_from_rotation(T[:3, :3])
