"""Bezier patches fitted to the surface of a mesh, as contact regions for objects that come as meshes.

The surface around a point is taken as a graph over its tangent plane: heights on a grid of a square there,
and a tensor-product Bezier function of least squares through them. Such a patch has no place where its
normal vanishes.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import trimesh
from numpy.typing import NDArray

from ..base.numeric.arrays import Array
from ..errors import InputError
from ..geometry import BezierPatch, bernstein, closest_on_triangles, perpendicular

__all__ = ["Fit", "fit_largest", "fit_patch"]


_GRID = 25
# Where the surface stands steeper against the tangent plane than this, a graph over it says little.
_STEEPEST_DEG = 75.0
_HALVINGS = 6


@dataclass(frozen=True, eq=False)
class Fit:
    """A patch with its distance from the mesh that it stands for.

    Attributes:
        patch: outward normal p_u x p_v, in the frame of the mesh in m.
        centre: the point of the mesh nearest to the point asked for, (3,) in m.
        rms_m: root mean square distance from the mesh, over a grid that the fit did not see.
        max_m: the largest of these distances.
        normal_rad: the largest angle between the normals of patch and mesh, whose faces are flat.
    """

    patch: BezierPatch
    centre: Array
    rms_m: float
    max_m: float
    normal_rad: float


class _NoGraph(Exception):
    """The surface is no graph over the square; says what it does there."""


def fit_patch(
    mesh: trimesh.Trimesh,
    at: Array,
    radius: float,
    degree: tuple[int, int] = (3, 3),
    *,
    source: str = "mesh",
) -> Fit:
    """Fits a Bezier patch to the surface of a closed mesh around a point.

    Args:
        mesh: closed surface, outward normals, in m.
        at: a point (3,) on it or near it.
        radius: the patch covers a square of the tangent plane whose corners are so far from its middle, in m.
        degree: of the patch in its two directions.
        source: the mesh's name, for error messages.

    Raises:
        InputError: the point is farther from the surface than the radius; or the surface around it is no
            graph over its tangent plane, or ends.
    """
    centre, face = _nearest(mesh, at)
    distance = float(np.linalg.norm(centre - at))
    if distance > radius:
        raise InputError(
            source, "at", f"is {distance:.3g} m from the surface, farther than the radius of {radius:.3g} m"
        )
    try:
        return _fit_around(mesh, centre, face, radius, degree)
    except _NoGraph as reason:
        hint = _largest_radius(mesh, centre, face, radius, degree)
        raise InputError(source, "radius", f"{radius:.3g} m is too large here: {reason}{hint}") from None


def fit_largest(
    mesh: trimesh.Trimesh, at: Array, radii: Sequence[float], accept: Callable[[Fit], bool]
) -> Fit | None:
    """The first patch of several radii, the largest first, that fits the surface around a point of it.

    Args:
        mesh: closed surface, outward normals, in m.
        at: a point (3,) on it.
        radii: as in `fit_patch`, in m.
        accept: whether a patch lies close enough.
    """
    centre, face = _nearest(mesh, at)
    for radius in radii:
        try:
            fit = _fit_around(mesh, centre, face, radius, (3, 3))
        except _NoGraph:
            continue
        if accept(fit):
            return fit
    return None


def _largest_radius(
    mesh: trimesh.Trimesh, centre: Array, face: int, radius: float, degree: tuple[int, int]
) -> str:
    """A smaller radius that would do, not larger than the body, in words."""
    largest = min(radius, float(np.max(mesh.extents)))
    for k in range(1, _HALVINGS + 1):
        smaller = largest / 2**k
        try:
            _fit_around(mesh, centre, face, smaller, degree)
        except _NoGraph:
            continue
        return f"; {smaller:.2g} m would do"
    return f"; nor would {smaller:.2g} m do, so the point lies on an edge or a corner"


def _fit_around(
    mesh: trimesh.Trimesh, centre: Array, face: int, radius: float, degree: tuple[int, int]
) -> Fit:
    faces = _patch_of_faces(mesh, face, centre, radius)
    normal = _mean_normal(mesh, faces, face)
    frame = np.vstack([perpendicular(normal), normal])
    local = (mesh.triangles[faces] - centre) @ frame.T
    half = radius / np.sqrt(2.0)

    grid = np.linspace(-half, half, _GRID)
    heights, _ = _heights(local, *np.meshgrid(grid, grid, indexing="ij"))
    bases = [bernstein(n, np.linspace(0.0, 1.0, _GRID)) for n in degree]
    inverses = [np.linalg.pinv(basis) for basis in bases]
    coefficients = inverses[0] @ heights @ inverses[1].T

    net = np.empty((degree[0] + 1, degree[1] + 1, 3))
    net[..., 0] = np.linspace(-half, half, degree[0] + 1)[:, None]
    net[..., 1] = np.linspace(-half, half, degree[1] + 1)[None, :]
    net[..., 2] = coefficients
    return _measure(BezierPatch(net), local, half, frame, centre)


def _measure(graph: BezierPatch, local: Array, half: float, frame: Array, centre: Array) -> Fit:
    """Distances and angles to the mesh between the places where the fit looked at it."""
    t = (np.arange(_GRID - 1) + 0.5) / (_GRID - 1)
    t = np.concatenate([[0.0], t, [1.0]])
    u, v = np.meshgrid(t, t, indexing="ij")
    points, normals = graph.evaluate(u, v), graph.unit_normal(u, v)
    heights, facets = _heights(local, points[..., 0], points[..., 1])
    # To the plane of the facet above or below, not along the height.
    distance = np.abs(points[..., 2] - heights) * facets[..., 2]
    angle = np.arccos(np.clip(np.sum(normals * facets, axis=-1), -1.0, 1.0))
    patch = BezierPatch(graph.control_points @ frame + centre)
    rms = float(np.sqrt(np.mean(distance**2)))
    return Fit(patch, centre, rms, float(distance.max()), float(angle.max()))


def _nearest(mesh: trimesh.Trimesh, point: Array) -> tuple[Array, int]:
    """The point of the surface nearest to `point`, and its face."""
    nearest = _nearest_of_each(mesh, point)
    distance = np.linalg.norm(nearest - point, axis=1)
    distance[mesh.area_faces <= 0.0] = np.inf
    face = int(np.argmin(distance))
    return nearest[face], face


def _nearest_of_each(mesh: trimesh.Trimesh, point: Array) -> Array:
    """The point (n, 3) of each face that is nearest to `point`."""
    repeated = np.broadcast_to(point, (len(mesh.faces), 3))
    return closest_on_triangles(np.asarray(mesh.triangles), repeated)


def _patch_of_faces(mesh: trimesh.Trimesh, face: int, centre: Array, radius: float) -> NDArray[np.int64]:
    """The faces that hang together with `face` near it; the corners of a bent patch are beyond the radius.

    Those that look the other way are none of them: the far side of a wall, with its rim nearby, is no fold.
    """
    near = np.linalg.norm(_nearest_of_each(mesh, centre) - centre, axis=1) <= 1.5 * radius
    near &= mesh.face_normals @ mesh.face_normals[face] >= 0.0
    pairs = mesh.face_adjacency
    pairs = pairs[near[pairs].all(axis=1)]
    groups = trimesh.graph.connected_components(pairs, nodes=np.flatnonzero(near))
    return np.asarray(next(group for group in groups if face in group), dtype=np.int64)


def _mean_normal(mesh: trimesh.Trimesh, faces: NDArray[np.int64], face: int) -> Array:
    """The mean normal of the faces that do not look away from the one at the point."""
    first = mesh.face_normals[face]
    normals, areas = mesh.face_normals[faces], mesh.area_faces[faces]
    towards = normals @ first > np.cos(np.radians(_STEEPEST_DEG))
    mean = areas[towards] @ normals[towards]
    return np.asarray(mean / np.linalg.norm(mean))


def _heights(triangles: Array, x: Array, y: Array) -> tuple[Array, Array]:
    """Heights (a, b) of the surface over the points, and the unit normals (a, b, 3) of its facets there.

    Raises:
        _NoGraph: none or several heights over a point, or a facet that is too steep.
    """
    points = np.column_stack([x.ravel(), y.ravel()])
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    sizes = np.linalg.norm(normals, axis=1)
    sound = sizes > 0.0
    triangles, normals = triangles[sound], normals[sound] / sizes[sound, None]
    low, high = triangles[..., :2].min(axis=1), triangles[..., :2].max(axis=1)
    found = np.full(len(points), -1)
    heights = np.full(len(points), np.nan)
    reach = points.min(axis=0), points.max(axis=0)
    tolerance = 1e-9 * float(np.ptp(points))
    for i in np.flatnonzero(np.all((high >= reach[0]) & (low <= reach[1]), axis=1)):
        inside = np.flatnonzero(_is_over(points, triangles[i, :, :2]))
        if not len(inside):
            continue
        if normals[i, 2] < np.cos(np.radians(_STEEPEST_DEG)):
            raise _NoGraph("the surface there bends away, it is no graph over its tangent plane")
        offset = triangles[i, 0, 2] + (triangles[i, 0, :2] - points[inside]) @ normals[i, :2] / normals[i, 2]
        again = found[inside] >= 0
        # Two facets agree where they share an edge.
        if np.any(np.abs(offset - heights[inside])[again] > 1e3 * tolerance):
            raise _NoGraph("the surface there folds over itself, it is no graph over its tangent plane")
        heights[inside], found[inside] = offset, i
    if np.any(found < 0):
        raise _NoGraph("the surface ends or bends away, it is no graph over its tangent plane")
    return heights.reshape(x.shape), normals[found].reshape(*x.shape, 3)


def _is_over(points: Array, corners: Array) -> NDArray[np.bool_]:
    """Which of the points (n, 2) lie in a triangle (3, 2), its edges included."""
    a, b, c = corners
    area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    if area == 0.0:
        return np.zeros(len(points), dtype=bool)
    result = np.ones(len(points), dtype=bool)
    for p, q in ((a, b), (b, c), (c, a)):
        side = (q[0] - p[0]) * (points[:, 1] - p[1]) - (q[1] - p[1]) * (points[:, 0] - p[0])
        result &= side * np.sign(area) >= -1e-9 * abs(area)
    return result
