"""Where an object may be touched: its named regions, and places all over its surface.

A place is a Bezier patch, the largest of a few that lies on the surface; where facets are too coarse or too
small for any, a point with the normal of its facet; and on sharp edges, such as the rim of a plate, a point
with the mean normal of the two facets that meet there.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import trimesh
from numpy.typing import NDArray

from ...base.numeric.arrays import Array
from ...geometry import BezierPatch, Patch, PointRegion, Region
from ...objects import Fit, ObjectModel, fit_largest
from .cover import are_covered

__all__ = [
    "Site",
    "draw_surface",
    "edge_sites",
    "named_sites",
    "opposite_sites",
    "site_at",
    "surface_sites",
]

# Radii of the fitted patches: a fingertip's, or less on a small object, and parts of it.
_RADIUS_M = 0.008
_SHARE_OF_SIZE = 0.1
_RADII = (1.0, 0.5, 0.25)
# Points drawn for each place wanted.
_DRAWN = 16
# A patch that is further off the surface, or leans more, would put the finger beside it.
_LARGEST_ERROR_M = 3e-4
_LARGEST_LEAN_RAD = np.radians(15.0)
# Control points are rounded to this many digits of a metre, so that a file says just what was tried.
_DIGITS = 7
_OWN_M = 1e-6
# What faces a place from across, by how much it may lean.
_ACROSS_RAD = np.radians(30.0)
# Facets that meet at a smaller angle make no edge, and those that fold back further no place for a finger.
_SHARP_RAD, _FOLDED_RAD = np.radians(35.0), np.radians(150.0)


@dataclass(frozen=True, eq=False)
class Site:
    """A place where the object may be touched, in its own frame.

    Attributes:
        name: of a region that the object has; empty for a place that was found.
        region: the region.
        point: (3,) its middle, in m.
        normal: (3,) unit outward normal there.
    """

    name: str
    region: Region
    point: Array
    normal: Array

    @cached_property
    def normals(self) -> Array:
        """Unit normals: (49, 3) of a patch, even in its parameters; (1, 3) elsewhere, that in the middle."""
        return self.region.spread()[1] if isinstance(self.region, Patch) else self.normal[None]

    @cached_property
    def bend_rad(self) -> float:
        """By how much its normals differ from that in its middle, at most."""
        normals = self.region.spread()[1]
        return float(np.arccos(np.clip(np.min(normals @ self.normal), -1.0, 1.0)))


def named_sites(obj: ObjectModel) -> list[Site]:
    """The object's own regions."""
    return [Site(name, region, *region.middle()) for name, region in obj.regions.items()]


def surface_sites(obj: ObjectModel, count: int, seed: int) -> tuple[list[Site], float]:
    """About so many places spread evenly over what can be touched of the surface, and the share of the rest.

    What lies under a convex piece, as a hollow that it bridges, can't be touched.
    """
    points, faces = draw_surface(obj.mesh, _DRAWN * count, np.random.default_rng(seed))
    open_to_touch = ~are_covered(obj, points)
    covered = 1.0 - float(open_to_touch.mean())
    points, faces = points[open_to_touch], faces[open_to_touch]
    return [site_at(obj, points[i], int(faces[i])) for i in _far_apart(points, count)], covered


def opposite_sites(obj: ObjectModel, sites: Sequence[Site]) -> list[Site]:
    """Places straight across the body from others, where it ends with a surface that faces away from them.

    On a thin sheet places that are drawn by themselves hardly ever lie face to face.
    """
    triangles, normals = np.asarray(obj.mesh.triangles), np.asarray(obj.mesh.face_normals)
    found: list[tuple[Array, int]] = []
    for site in sites:
        depth = _depths_m(triangles, site.point, -site.normal)
        face = int(np.argmin(depth))
        if np.isfinite(depth[face]) and normals[face] @ site.normal < -np.cos(_ACROSS_RAD):
            found.append((site.point - depth[face] * site.normal, face))
    if not found:
        return []
    is_open = ~are_covered(obj, np.array([point for point, _ in found]))
    return [site_at(obj, point, face) for (point, face), kept in zip(found, is_open, strict=True) if kept]


def _depths_m(triangles: Array, origin: Array, along: Array) -> Array:
    """How far along a unit vector (3,) from a point (3,) triangles (n, 3, 3) are met; inf where they are not.

    By barycentric coordinates of where the line meets the plane; what is no micrometre away does not count.
    """
    a, edge_1, edge_2 = triangles[:, 0], triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    across = np.cross(along, edge_2)
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = 1.0 / np.sum(edge_1 * across, axis=1)
        away = origin - a
        u = inverse * np.sum(away * across, axis=1)
        turned = np.cross(away, edge_1)
        v = inverse * (turned @ along)
        depth = inverse * np.sum(edge_2 * turned, axis=1)
        is_met = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (depth > _OWN_M)
    return np.where(is_met, depth, np.inf)


def edge_sites(obj: ObjectModel, count: int, seed: int) -> list[Site]:
    """At most so many places on sharp convex edges, drawn by their length."""
    mesh, rng = obj.mesh, np.random.default_rng(seed)
    angles = mesh.face_adjacency_angles
    sharp = mesh.face_adjacency_convex & (angles > _SHARP_RAD) & (angles < _FOLDED_RAD)
    ends = mesh.vertices[mesh.face_adjacency_edges[sharp]]
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    if not lengths.sum() > 0.0:
        return []
    chosen = rng.choice(len(lengths), size=count, p=lengths / lengths.sum())
    along = rng.uniform(0.1, 0.9, size=(count, 1))
    points = (1.0 - along) * ends[chosen, 0] + along * ends[chosen, 1]
    normals = mesh.face_normals[mesh.face_adjacency[sharp][chosen]].sum(axis=1)
    kept = np.flatnonzero(~are_covered(obj, points))
    return [_point_site(points[i], normals[i]) for i in kept]


def draw_surface(
    mesh: trimesh.Trimesh, count: int, rng: np.random.Generator
) -> tuple[Array, NDArray[np.int64]]:
    """Points (n, 3) of the surface with their faces (n,), uniform over its area."""
    faces = rng.choice(len(mesh.faces), size=count, p=mesh.area_faces / mesh.area_faces.sum())
    u, v = np.sqrt(rng.uniform(size=count)), rng.uniform(size=count)
    weights = np.column_stack([1.0 - u, u * (1.0 - v), u * v])
    return np.einsum("nk,nkd->nd", weights, mesh.triangles[faces]), faces


def _far_apart(points: Array, count: int) -> list[int]:
    """Indices of at most so many points, each as far as can be from those before."""
    distance = np.full(len(points), np.inf)
    chosen: list[int] = []
    while len(chosen) < min(count, len(points)):
        chosen.append(int(np.argmax(distance)))
        distance = np.minimum(distance, np.linalg.norm(points - points[chosen[-1]], axis=1))
        distance[chosen] = -1.0
    return chosen


def site_at(obj: ObjectModel, point: Array, face: int) -> Site:
    """A patch around a point of a face, or the point alone near edges and where the surface is too rough."""
    radius = min(_RADIUS_M, _SHARE_OF_SIZE * obj.size_m)
    fit = fit_largest(obj.mesh, point, [share * radius for share in _RADII], _lies_close)
    if fit is None:
        return _point_site(point, obj.mesh.face_normals[face])
    region = Patch(BezierPatch(np.round(fit.patch.control_points, _DIGITS)))
    return Site("", region, *region.middle())


def _lies_close(fit: Fit) -> bool:
    return fit.max_m <= _LARGEST_ERROR_M and fit.normal_rad <= _LARGEST_LEAN_RAD


def _point_site(point: Array, normal: Array) -> Site:
    region = PointRegion(np.round(point, _DIGITS), normal / np.linalg.norm(normal))
    return Site("", region, region.point, region.normal)
