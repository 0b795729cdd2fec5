"""Contact regions as thin sheets that can be drawn."""

import numpy as np
import trimesh

from ...base.numeric.arrays import Array, Indices
from ...geometry import Cap, Patch, PointRegion, Region, perpendicular

__all__ = ["region_sheet"]

# Cells of a sheet along each side of a patch; rings and sectors of a cap.
_CELLS = 16
_SECTORS = 32
# Radius of the ball that stands for a point, in lifts.
_POINT_LIFTS = 4.0


def region_sheet(region: Region, lift_m: float) -> trimesh.Trimesh:
    """Two sheets, `lift_m` above and below the region, facing away from it: seen from both sides.

    A region that lies inside a body, or whose normal is turned inwards, is seen all the same where the body
    does not hide it. A point becomes a ball.
    """
    match region:
        case Patch():
            points, normals, faces = _grid(region)
        case Cap():
            points, normals, faces = _cap(region)
        case PointRegion():
            ball = trimesh.creation.icosphere(subdivisions=2, radius=_POINT_LIFTS * lift_m)
            ball.apply_translation(region.point)
            return ball
    n = len(points)
    sheet = np.concatenate([points + lift_m * normals, points - lift_m * normals])
    return trimesh.Trimesh(sheet, np.concatenate([faces, n + faces[:, ::-1]]), process=False)


def _grid(region: Patch) -> tuple[Array, Array, Indices]:
    t = np.linspace(0.0, 1.0, _CELLS + 1)
    u, v = (x.ravel() for x in np.meshgrid(t, t, indexing="ij"))
    faces = _cells(_CELLS + 1, _CELLS + 1)
    return region.patch.evaluate(u, v), region.patch.unit_normal(u, v), faces


def _cap(region: Cap) -> tuple[Array, Array, Indices]:
    tilt = np.linspace(0.0, region.half_angle_rad, _CELLS + 1)
    around = np.linspace(0.0, 2.0 * np.pi, _SECTORS + 1)
    t, a = (x.ravel() for x in np.meshgrid(tilt, around, indexing="ij"))
    e1, e2 = perpendicular(region.axis)
    normals = np.outer(np.cos(t), region.axis) + np.outer(np.sin(t) * np.cos(a), e1)
    normals += np.outer(np.sin(t) * np.sin(a), e2)
    return region.centre + region.radius * normals, normals, _cells(_CELLS + 1, _SECTORS + 1)


def _cells(rows: int, columns: int) -> Indices:
    """Triangles (n, 3) of a grid of points, wound about (along the rows) x (along the columns)."""
    index = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]
    return np.concatenate([np.stack(t, axis=-1).reshape(-1, 3) for t in ((a, b, c), (a, c, d))])
