"""Where to look from: hand and contacts fill the picture, and as little as possible hides them.

An object much larger than the hand, such as a guitar, is cropped. From each side the camera may move a little
around and up or down; its place is chosen by casting rays, so that it sees most of contacts and fingers.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...base.numeric.arrays import Array
from ...geometry import perpendicular, rotation_from_quaternion
from ...solver import Configuration
from ..model import OBJECT_BODY, STAND_BODY
from .camera import Camera, look_at
from .rays import geoms_hit, seen_from

__all__ = [
    "VIEWS",
    "ContactMarks",
    "best_camera",
    "drawn_corners",
    "framed_points",
    "visible_contacts",
    "zoomed_in",
]


VIEWS = {"front": (205.0, -18.0), "left": (295.0, -18.0), "back": (25.0, -18.0), "right": (115.0, -18.0)}
"""Azimuth and elevation in degrees of the four views; the palm faces the front."""

# How far a camera may be from its side, the side itself first.
_AROUND_DEG = (0.0, -15.0, 15.0, -30.0, 30.0)
_ELEVATIONS_DEG = (-18.0, -45.0, 15.0)
# An object that lies within this of the contacts is shown whole: a teapot, but not a guitar.
_WHOLE_M = 0.35
# What is shown around a contact, whatever its part.
_AROUND_CONTACT_M = 0.03
# Where two bodies touch, they hide the very point; a contact is in sight where a point this far beside it is.
_RIM_M = 0.004
_RIM_POINTS = 16
# Rays along the sides of the small picture in which the fingers' pixels are counted.
_SAMPLES = (32, 24)
# The first body after the world; its back hides what the fingers do.
_PALM = 1
# How much better, in shares of what can be seen, a place must be than the side itself, at the farthest.
_LEAVING = 0.1
# Corners of a box, from its middle.
_SIGNS = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T


@dataclass(frozen=True, eq=False)
class ContactMarks:
    """Where the contacts are on the object.

    Attributes:
        points: (n, 3) in the palm frame.
        normals: (n, 3) the object's unit outward normals there.
    """

    points: Array
    normals: Array

    @cached_property
    def rims(self) -> Array:
        """Points (n * 16, 3) on a small circle around each contact, in its tangent plane."""
        angles = np.linspace(0.0, 2.0 * np.pi, _RIM_POINTS, endpoint=False)
        circle = _RIM_M * np.column_stack([np.cos(angles), np.sin(angles)])
        return np.concatenate(
            [p + circle @ perpendicular(n) for p, n in zip(self.points, self.normals, strict=True)]
        )

    @classmethod
    def of(cls, configuration: Configuration, pose: Array | None = None) -> "ContactMarks":
        """Those of a configuration; with the object at `pose` (7,) in the palm frame where one is given."""
        points = np.array([point.p_object for point in configuration.contact_points])
        normals = np.array([point.n_object for point in configuration.contact_points])
        if pose is None:
            return cls(points, normals)
        turn = rotation_from_quaternion(pose[3:]) @ configuration.state.R_palm_object.T
        return cls((points - configuration.state.p_palm_object) @ turn.T + pose[:3], normals @ turn.T)


def framed_points(model: Any, data: Any, marks: ContactMarks) -> Array:
    """Points (n, 3) that a picture should show: the hand, the contacts, the object if it is no giant."""
    of_hand = _of_hand(model)
    hand: list[Array] = []
    others: list[Array] = []
    for i, corners in drawn_corners(model, data).items():
        (hand if of_hand[i] else others).append(corners)
    contacts = [point + _AROUND_CONTACT_M * _SIGNS for point in marks.points]
    away = np.linalg.norm(np.concatenate(others) - marks.points.mean(axis=0), axis=1)
    return np.concatenate([*hand, *contacts, *(others if away.max() < _WHOLE_M else [])])


def drawn_corners(model: Any, data: Any) -> dict[int, Array]:
    """Corners (8, 3) of a box around each geom that is drawn, by its number."""
    corners = {}
    for i in np.flatnonzero(model.geom_group <= 2):
        centre, half = model.geom_aabb[i, :3], model.geom_aabb[i, 3:]
        corners[int(i)] = (centre + _SIGNS * half) @ data.geom_xmat[i].reshape(3, 3).T + data.geom_xpos[i]
    return corners


def best_camera(
    model: Any, data: Any, marks: ContactMarks, sides: list[tuple[float, float]], aspect: float
) -> Camera:
    """The camera that sees most, from one of some sides or not far off.

    Args:
        model: MuJoCo's model.
        data: MuJoCo's data, after `mj_forward`.
        marks: what to look at, as the data has it.
        sides: azimuth and elevation in degrees of at least one.
        aspect: width of the picture over its height.
    """
    points = framed_points(model, data, marks)
    fingers, most = _of_hand(model) & (model.geom_bodyid != _PALM), max(_AROUND_DEG)
    best, most_seen = None, -np.inf
    for azimuth, elevation in sides:
        for turn, up in product(_AROUND_DEG, dict.fromkeys((elevation, *_ELEVATIONS_DEG))):
            camera = look_at(points, azimuth + turn, up, aspect)
            seen = _seen(model, data, marks, camera, fingers) - _LEAVING * abs(turn) / most
            if seen > most_seen:
                best, most_seen = camera, seen
    assert best is not None
    return best


def zoomed_in(camera: Camera, marks: ContactMarks, closeness: float) -> Camera:
    """The camera so many times closer to the contacts, which move towards the middle of the picture."""
    middle = marks.points.mean(axis=0)
    target = middle + (camera.target - middle) / closeness**2
    return replace(camera, target=target, distance=camera.distance / closeness)


def visible_contacts(model: Any, data: Any, marks: ContactMarks, camera: Camera) -> list[bool]:
    """Whether any point around each contact, in the tangent plane, is seen by the camera."""
    return [bool(share > 0.0) for share in _rims_in_sight(model, data, marks, camera)]


def _seen(model: Any, data: Any, marks: ContactMarks, camera: Camera, fingers: NDArray[np.bool_]) -> float:
    """How much is seen: the fingers' share of pixels, and of contacts, half of whose rim counts as all."""
    geoms = geoms_hit(model, data, camera.eye, camera.rays(*_SAMPLES).reshape(-1, 3))
    share = float((fingers[geoms] & (geoms >= 0)).mean())
    rims = _rims_in_sight(model, data, marks, camera)
    return share + float(np.minimum(1.0, 2.0 * rims).mean())


def _rims_in_sight(model: Any, data: Any, marks: ContactMarks, camera: Camera) -> Array:
    """Share (n,) of points on a small circle around each contact that the camera sees."""
    return seen_from(model, data, camera.eye, marks.rims).reshape(-1, _RIM_POINTS).mean(axis=1)


def _of_hand(model: Any) -> NDArray[np.bool_]:
    """Which geoms (n_geoms,) belong to the hand."""
    others = [i for i in range(model.nbody) if model.body(i).name in (OBJECT_BODY, STAND_BODY)]
    return ~np.isin(model.geom_bodyid, others)
