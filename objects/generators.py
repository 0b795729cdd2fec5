"""Built-in objects whose shape is made by code: each generator returns parts with their densities."""

from collections.abc import Callable

import numpy as np
import trimesh
from numpy.typing import NDArray

from ..geometry import Hull
from .object_model import Part

__all__ = ["GENERATORS", "scalpel"]

Array = NDArray[np.float64]

# The flats of the benchmark's handle that carry the published contact patches, as (x, z) corners in m.
_SCALPEL_FLATS = np.array(
    [
        [(-0.00328, -0.008331), (-0.00152, -0.008879)],
        [(0.000264, 0.009057), (-0.001552, 0.008873)],
        [(0.009140, -0.001779), (0.009316, 0.000001)],
        [(0.009316, 0.000001), (0.009132, 0.001817)],
    ]
)
# All those corners lie within 2 um of this circle: the bar's axis stands 0.26 mm beside the object's y axis.
_SCALPEL_AXIS_XZ = np.array([0.000261, 0.000001])
_SCALPEL_RADIUS = 0.009055


def scalpel() -> list[tuple[Part, float]]:
    """The benchmark's oversize scalpel: a 32-sided bar along y as handle, and a blade.

    Handle y -27..200 mm of radius 9.06 mm, blade y -122..-27 mm, 1.4 mm thick; the published contact
    patches lie on flats of the bar.

    Returns:
        Parts with densities in kg/m^3: ABS for the handle, stainless steel for the blade.
    """
    ring = _ring_with_flats(_SCALPEL_FLATS.reshape(-1, 2), _SCALPEL_AXIS_XZ, _SCALPEL_RADIUS, 32)
    handle = _extrude(ring, -0.027, 0.200, axis=1)
    # (x, y): a straight back at x = 9.6 mm, a belly that curves up to the point.
    outline = np.array(
        [
            (-0.0050, -0.0265), (0.0080, -0.0265), (0.0096, -0.0400), (0.0096, -0.1000), (0.0088, -0.1220),
            (0.0050, -0.1140), (-0.0005, -0.1000), (-0.0045, -0.0840), (-0.0064, -0.0650), (-0.0064, -0.0400),
        ]
    )  # fmt: skip
    blade = _extrude(outline, -0.0007, 0.0007, axis=2)
    return [
        (_convex_part("handle", handle, (0.16, 0.35, 0.55, 1.0)), 1050.0),
        (_convex_part("blade", blade, (0.80, 0.81, 0.83, 1.0)), 7800.0),
    ]


GENERATORS: dict[str, Callable[[], list[tuple[Part, float]]]] = {"scalpel": scalpel}


def _ring_with_flats(corners: Array, centre: Array, radius: float, sides: int) -> Array:
    """A convex polygon (n, 2) through `corners`, completed by points of a circle well away from them."""
    step = 2.0 * np.pi / sides
    taken = np.arctan2(*(corners - centre).T[::-1])
    angles = np.arange(sides) * step
    gap = np.abs(np.angle(np.exp(1j * (angles[:, None] - taken[None, :])))).min(axis=1)
    free = angles[gap > 0.6 * step]
    circle = centre + radius * np.column_stack([np.cos(free), np.sin(free)])
    return np.unique(np.concatenate([corners, circle]).round(9), axis=0)


def _extrude(outline: Array, low: float, high: float, axis: int) -> Hull:
    """Hull of a convex outline (n, 2) swept along `axis` from `low` to `high`."""
    others = [i for i in range(3) if i != axis]
    points = np.zeros((2, len(outline), 3))
    points[..., others] = outline
    points[0, :, axis], points[1, :, axis] = low, high
    return Hull.from_points(points.reshape(-1, 3))


def _convex_part(name: str, hull: Hull, rgba: tuple[float, float, float, float]) -> Part:
    return Part(name, trimesh.Trimesh(hull.vertices, hull.faces, process=False), (hull,), rgba)
