"""A surface for triangles that bound a solid only nearly: what they wind around becomes its inside.

The generalized winding number (Jacobson, Kavan and Sorkine-Hornung, "Robust inside-outside segmentation using
generalized winding numbers", 2013) tells inside from outside wherever most of a surface is there, whatever
its edges do. The level set of the signed distance is then closed and without faults. Triangles that are far
from a point count together, as the first term of their series (Barill, Dickson, Schmidt, Levin and Jacobson,
"Fast winding numbers for soups and clouds", 2018): all that is asked is whether the number is above a half.
"""

from typing import NamedTuple

import manifold3d
import numpy as np
import trimesh
from numpy.typing import NDArray

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array
from .closeness import SurfaceDistance
from .light_mesh import light_mesh
from .manifold import from_manifold

__all__ = ["Rebuilt", "rebuild"]

# Edges of the new surface to the size of the old one: finer for fewer triangles, each of which costs at every
# point that is looked at.
_FINE, _COARSE = 1.0 / 64.0, 1.0 / 36.0
_FEW_TRIANGLES, _MOST_TRIANGLES = 4_000, 40_000
# Corners of the old surface that are looked at.
_CORNERS = 4_000
# What holds less of its bounding box is no solid that these triangles stand for, but skins here and there.
_LEAST_SHARE = 0.01
# Triangles that count together, and from how many of their radii on.
_TOGETHER, _FAR = 48, 3.0
# Flat stretches are made of fewer triangles as long as they move by no more of an edge than this.
_SIMPLER = 0.02


class Rebuilt(NamedTuple):
    """A closed surface in place of one with faults.

    Attributes:
        mesh: the surface, outward normals.
        moved_m: how far the old one lies from it at most.
        missing_m: how far it lies from the old one at most, where there was none.
    """

    mesh: trimesh.Trimesh
    moved_m: float
    missing_m: float


def rebuild(mesh: trimesh.Trimesh) -> Rebuilt | None:
    """A closed surface around what triangles wind around; None where that is nothing.

    Args:
        mesh: triangles whose windings agree in the main, in m; of very many some are looked at.
    """
    if not float(mesh.scale) > 0.0:
        return None
    corners = np.array(mesh.vertices)
    mesh = light_mesh(mesh, _MOST_TRIANGLES)
    edge = float(mesh.scale) * (_FINE if len(mesh.faces) <= _FEW_TRIANGLES else _COARSE)
    origin = mesh.bounds.mean(axis=0)
    triangles = np.ascontiguousarray(mesh.triangles - origin)
    groups = grouped(triangles)
    signed = np.einsum("fi,fi->", triangles[:, 0], np.cross(triangles[:, 1], triangles[:, 2]))
    outward = 1.0 if signed >= 0.0 else -1.0
    surface = SurfaceDistance(mesh)

    def height(x: float, y: float, z: float) -> float:
        point = np.array([x, y, z])
        distance = float(surface.of(point[None] + origin)[0])
        return distance if outward * winding_number(groups, point) > 0.5 else -distance

    reach = 0.5 * np.ptp(mesh.bounds, axis=0) + 2.0 * edge
    solid = manifold3d.Manifold.level_set(height, [*(-reach).tolist(), *reach.tolist()], edge)
    solid = solid.simplify(_SIMPLER * edge)
    if solid.is_empty() or solid.volume() < _LEAST_SHARE * float(np.prod(np.ptp(mesh.bounds, axis=0))):
        return None
    rebuilt = from_manifold(solid.translate(origin.tolist()))
    if len(corners) > _CORNERS:
        corners = corners[np.random.default_rng(0).choice(len(corners), _CORNERS, replace=False)]
    moved_m = SurfaceDistance(rebuilt).of(corners).max()
    return Rebuilt(rebuilt, float(moved_m), float(surface.of(np.array(rebuilt.vertices)).max()))


class Groups(NamedTuple):
    """Triangles that lie near each other, one group after the other.

    Attributes:
        triangles: (n, 3, 3), in the order of the groups.
        starts: (g + 1,) where each group begins, and the end of the last.
        centres: (g, 3).
        radii: (g,) of balls around the centres that hold the groups.
        areas: (g, 3) sums of their area vectors.
    """

    triangles: Array
    starts: NDArray[np.int64]
    centres: Array
    radii: Array
    areas: Array


def grouped(triangles: Array) -> Groups:
    """Triangles (n, 3, 3) in groups, by halving along the longest axis."""
    middles = triangles.mean(axis=1)
    halving = [np.arange(len(triangles))]
    groups: list[NDArray[np.int64]] = []
    while halving:
        part = halving.pop()
        if len(part) <= _TOGETHER:
            groups.append(part)
            continue
        axis = int(np.argmax(np.ptp(middles[part], axis=0)))
        part = part[np.argsort(middles[part, axis], kind="stable")]
        halving += [part[: len(part) // 2], part[len(part) // 2 :]]
    areas = 0.5 * np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    centres = np.array([middles[group].mean(axis=0) for group in groups])
    return Groups(
        np.ascontiguousarray(triangles[np.concatenate(groups)]),
        np.cumsum([0, *(len(group) for group in groups)]),
        centres,
        np.array(
            [
                np.linalg.norm(triangles[group] - centre, axis=2).max()
                for group, centre in zip(groups, centres, strict=True)
            ]
        ),
        np.array([areas[group].sum(axis=0) for group in groups]),
    )


def winding_number(groups: Groups, point: Array) -> float:
    """How often triangles wind around a point (3,): 1 inside of a closed surface, 0 outside."""
    return float(_winding_number(*groups, point))


@compiled
def _winding_number(
    triangles: Array, starts: NDArray[np.int64], centres: Array, radii: Array, areas: Array, point: Array
) -> float:
    """The sum over groups: exact for those that are near, their dipole for those that are far."""
    total = 0.0
    for g in range(len(radii)):
        dx, dy, dz = centres[g, 0] - point[0], centres[g, 1] - point[1], centres[g, 2] - point[2]
        squared = dx * dx + dy * dy + dz * dz
        if squared > (_FAR * radii[g]) ** 2:
            through = areas[g, 0] * dx + areas[g, 1] * dy + areas[g, 2] * dz
            total += through / (squared * np.sqrt(squared))
        else:
            total += _solid_angle(triangles, starts[g], starts[g + 1], point)
    return total / (4.0 * np.pi)


@compiled
def _solid_angle(triangles: Array, start: int, end: int, point: Array) -> float:
    """Solid angle of some triangles seen from a point, after van Oosterom and Strackee.

    See "The solid angle of a plane triangle" (1983).
    """
    total = 0.0
    a, b, c = np.zeros(3), np.zeros(3), np.zeros(3)
    for t in range(start, end):
        la, lb, lc = 0.0, 0.0, 0.0
        for i in range(3):
            a[i], b[i], c[i] = (
                triangles[t, 0, i] - point[i],
                triangles[t, 1, i] - point[i],
                triangles[t, 2, i] - point[i],
            )
            la, lb, lc = la + a[i] * a[i], lb + b[i] * b[i], lc + c[i] * c[i]
        la, lb, lc = np.sqrt(la), np.sqrt(lb), np.sqrt(lc)
        ab, bc, ca, volume = 0.0, 0.0, 0.0, 0.0
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            ab, bc, ca = ab + a[i] * b[i], bc + b[i] * c[i], ca + c[i] * a[i]
            volume += a[i] * (b[j] * c[k] - b[k] * c[j])
        total += 2.0 * np.arctan2(volume, la * lb * lc + ab * lc + bc * la + ca * lb)
    return total
