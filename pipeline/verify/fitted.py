"""Contacts of a task where a given grasp touches: regions fitted to hand and object around these places."""

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import BezierPatch, Patch, PointRegion, Region, closest_on_triangles, perpendicular
from ...hands import Hand, HandRegion, forward_kinematics
from ...hands.finding import Frame, fit_cap, fit_patch, fit_point
from ...objects import Contact, Fit, ObjectModel, ObjectRegion, fit_largest
from .measured import Measured, Touch

__all__ = ["fitted_contact"]

# Half sides of patches on links, and half angles of caps, the largest first.
_HALVES_M = (0.008, 0.005, 0.003, 0.0015)
_CAPS_RAD = tuple(np.radians([45.0, 30.0]).tolist())
_TOLERANCE_M = 1e-4
# Regions whose middle is farther from where the link touches are of another place.
_BESIDE_M = 2e-3
# Radii of patches on the object, by the largest one, how far they may lie off it and lean.
_RADIUS_M, _SHARE_OF_SIZE = 0.012, 0.12
_RADII = (1.0, 0.6, 0.35, 0.2)
_OFF_M, _LEAN_RAD = 3e-4, float(np.radians(20.0))
_DIGITS = 7


def fitted_contact(
    hand: Hand, obj: ObjectModel, given: Measured, touch: Touch, *, grown: float = 1.0
) -> Contact:
    """The contact of a link with the object around the place where it touches in a given grasp.

    Args:
        hand: the hand.
        obj: the object, in its size.
        given: the grasp.
        touch: one of its touches.
        grown: factor on the size of the region on the object.
    """
    T = forward_kinematics(hand, given.joints)[touch.link]
    point, normal = T[:3, :3].T @ (touch.point - T[:3, 3]), T[:3, :3].T @ touch.normal
    on_hand = HandRegion(
        hand.links[touch.link].name, touch.link, _hand_region(hand, touch.link, point, normal)
    )
    R, p = given.T_palm_object[:3, :3], given.T_palm_object[:3, 3]
    at = (touch.on_object - p) @ R
    return Contact(on_hand, ObjectRegion("inline", _object_region(obj, at, grown)))


def _hand_region(hand: Hand, link: int, point: Array, normal: Array) -> Region:
    shapes = hand.links[link].shapes
    for angle in _CAPS_RAD:
        cap = fit_cap(shapes, normal, angle, _TOLERANCE_M)
        if cap is not None and np.linalg.norm(cap.middle()[0] - point) < _BESIDE_M:
            return cap
    frame = Frame(point, normal, perpendicular(normal)[0])
    for half in _HALVES_M:
        patch = fit_patch(shapes, frame, (half, half), _TOLERANCE_M)
        if patch is not None and np.linalg.norm(patch.middle()[0] - point) < _BESIDE_M:
            return patch
    return fit_point(shapes, frame)


def _object_region(obj: ObjectModel, at: Array, grown: float) -> Region:
    """The largest patch that lies on the surface around a point, or the point of the surface alone."""
    radius = grown * min(_RADIUS_M, _SHARE_OF_SIZE * obj.size_m)
    fit = fit_largest(obj.mesh, at, [share * radius for share in _RADII], _lies_close)
    if fit is not None:
        return Patch(BezierPatch(np.round(fit.patch.control_points, _DIGITS)))
    point, normal = _on_surface(obj, at)
    return PointRegion(point, normal)


def _lies_close(fit: Fit) -> bool:
    return fit.max_m <= _OFF_M and fit.normal_rad <= _LEAN_RAD


def _on_surface(obj: ObjectModel, at: Array) -> tuple[Array, Array]:
    """The point of the surface next to `at`, and its outward normal; at an edge the mean of its faces'."""
    mesh = obj.mesh
    nearest = closest_on_triangles(np.asarray(mesh.triangles), np.broadcast_to(at, (len(mesh.faces), 3)))
    lengths = np.linalg.norm(nearest - at, axis=1)
    lengths[mesh.area_faces <= 0.0] = np.inf
    k = int(lengths.argmin())
    alike = lengths <= lengths[k] + 1e-6
    normal = (mesh.face_normals[alike] * mesh.area_faces[alike, None]).sum(axis=0)
    size = float(np.linalg.norm(normal))
    return np.asarray(nearest[k]), normal / size if size > 0.0 else mesh.face_normals[k]
