"""How far convex pieces and the surface that they stand for lie apart, each way."""

from collections.abc import Sequence
from typing import NamedTuple

import fcl
import manifold3d
import numpy as np
import trimesh

from ...base.numeric.arrays import Array
from ..shapes import Hull
from .manifold import from_hull, from_manifold, to_manifold

__all__ = ["Closeness", "SurfaceDistance", "measure_closeness", "width_m"]

# Points by which the space between a solid and its pieces is measured, besides all of its corners.
_SAMPLES = 1000
_MOST_CORNERS = 4000
# Radius of the ball that stands for a point, in sizes of the mesh.
_BALL = 1e-9


class Closeness(NamedTuple):
    """How well convex pieces stand for a solid.

    Attributes:
        outside_m: how far pieces stick out of the surface.
        missing_m: how far the solid reaches out of the pieces.
    """

    outside_m: float
    missing_m: float


def measure_closeness(mesh: trimesh.Trimesh, pieces: Sequence[Hull]) -> Closeness | None:
    """Compares pieces with a closed surface; None where that surface is not one of a solid.

    The spaces between are exact, their widths are taken at all of their corners and at points between.
    """
    solid = to_manifold(mesh)
    union = manifold3d.Manifold.batch_boolean([from_hull(piece) for piece in pieces], manifold3d.OpType.Add)
    if solid is None or union.is_empty():
        return None
    return Closeness(
        width_m(union - solid, SurfaceDistance(mesh)),
        width_m(solid - union, SurfaceDistance(from_manifold(union))),
    )


def width_m(
    space: manifold3d.Manifold,
    surface: "SurfaceDistance",
    *,
    most_corners: int = _MOST_CORNERS,
    samples: int = _SAMPLES,
) -> float:
    """Largest distance of a space's points from a surface on its boundary, in m.

    Args:
        space: between a solid and its pieces.
        surface: on one side of it.
        most_corners: of its corners that are looked at, drawn at random where there are more.
        samples: other points of its boundary that are looked at.
    """
    if space.is_empty():
        return 0.0
    boundary = from_manifold(space)
    rng = np.random.default_rng(0)
    points = np.array(boundary.vertices)
    if len(points) > most_corners:
        points = points[rng.choice(len(points), most_corners, replace=False)]
    areas = boundary.area_faces
    if areas.sum() > 0.0:
        which = rng.choice(len(areas), samples, p=areas / areas.sum())
        weights = rng.dirichlet(np.ones(3), samples)
        points = np.vstack([points, np.einsum("ni,nij->nj", weights, boundary.triangles[which])])
    return float(surface.of(points).max())


class SurfaceDistance:
    """Unsigned distances from a triangle mesh."""

    def __init__(self, mesh: trimesh.Trimesh) -> None:
        # In units of its size: FCL takes lengths below 1e-6 or so for nothing.
        self._size = float(mesh.scale)
        self._origin = np.array(mesh.bounds[0])
        model = fcl.BVHModel()
        model.beginModel(len(mesh.vertices), len(mesh.faces))
        model.addSubModel((np.array(mesh.vertices) - self._origin) / self._size, np.array(mesh.faces))
        model.endModel()
        self._body = fcl.CollisionObject(model)
        self._point = fcl.Sphere(_BALL)

    def of(self, points: Array) -> Array:
        """Distances (n,) in m of points (n, 3)."""
        return np.array([self._query(point)[0] for point in points])

    def nearest(self, points: Array) -> Array:
        """The nearest points (n, 3) on the mesh."""
        return np.array([self._query(point)[1] for point in points]).reshape(-1, 3)

    def _query(self, point: Array) -> tuple[float, Array]:
        request, result = fcl.DistanceRequest(True), fcl.DistanceResult()
        ball = fcl.CollisionObject(self._point, fcl.Transform((point - self._origin) / self._size))
        fcl.distance(self._body, ball, request, result)
        if result.min_distance <= _BALL:
            return 0.0, point  # FCL gives no nearest points of what touches
        nearest = np.array(result.nearest_points[0]) * self._size + self._origin
        return float(result.min_distance) * self._size, nearest
