"""Scalpels: the benchmark's oversize one with a round handle, and one of real size with a flat handle."""

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import BezierPatch, Hull
from .convex import convex_part, extrude
from .generated import GeneratedShape

__all__ = ["scalpel", "scalpel_real"]


# The flats of the benchmark's handle that carry the published contact patches, as (x, z) corners in m.
_FLATS = np.array(
    [
        [(-0.00328, -0.008331), (-0.00152, -0.008879)],
        [(0.000264, 0.009057), (-0.001552, 0.008873)],
        [(0.009140, -0.001779), (0.009316, 0.000001)],
        [(0.009316, 0.000001), (0.009132, 0.001817)],
    ]
)
# All those corners lie within 2 um of this circle: the bar's axis stands 0.26 mm beside the object's y axis.
_AXIS_XZ = np.array([0.000261, 0.000001])
_RADIUS = 0.009055
_HANDLE_Y = (-0.027, 0.200)
_ABS, _STEEL = 1050.0, 7800.0
_BLUE, _SILVER = (0.16, 0.35, 0.55, 1.0), (0.80, 0.81, 0.83, 1.0)
# The four sides of a round handle, by the direction (x, z) that each faces.
_SIDES = {"right": (1.0, 0.0), "front": (0.0, 1.0), "left": (-1.0, 0.0), "rear": (0.0, -1.0)}

# Half of the width (x) and of the thickness (z) of the real handle, and how much thinner each face is at its
# sides and at its ends.
_FLAT_HALF = (0.0048, 0.0017)
_FLAT_BULGE = (0.0003, 0.0003)
_FLAT_Y = (-0.018, 0.092)


def scalpel() -> GeneratedShape:
    """The benchmark's oversize scalpel: a 32-sided bar along y as handle, and a blade.

    Handle y -27..200 mm of radius 9.06 mm, blade y -122..-27 mm, 1.4 mm thick; the published contact
    patches lie on flats of the bar. ABS for the handle, stainless steel for the blade.

    Surfaces: `handle_right` (+x), `handle_front` (+z), `handle_left` and `handle_rear`, each a quarter of the
    bar's circle; u runs along +y, v around it from +x to +z, and so on.
    """
    ring = _ring_with_flats(_FLATS.reshape(-1, 2), _AXIS_XZ, _RADIUS, 32)
    handle = extrude(ring, *_HANDLE_Y, axis=1)
    # (x, y): a straight back at x = 9.6 mm, a belly that curves up to the point.
    outline = np.array(
        [
            (-0.0050, -0.0265), (0.0080, -0.0265), (0.0096, -0.0400), (0.0096, -0.1000), (0.0088, -0.1220),
            (0.0050, -0.1140), (-0.0005, -0.1000), (-0.0045, -0.0840), (-0.0064, -0.0650), (-0.0064, -0.0400),
        ]
    )  # fmt: skip
    blade = extrude(outline, -0.0007, 0.0007, axis=2)
    return GeneratedShape(
        (
            convex_part("handle", handle, _ABS, _BLUE),
            convex_part("blade", blade, _STEEL, _SILVER),
        ),
        {f"handle_{name}": _quarter(np.array(facing)) for name, facing in _SIDES.items()},
    )


def scalpel_real() -> GeneratedShape:
    """A scalpel of real size, 140 mm long: a flat steel handle like a No. 3, and a blade like a No. 10.

    Handle y -18..92 mm, 9.6 mm wide (x) and up to 3.4 mm thick (z); blade y -48..-16 mm, 0.4 mm thick.

    Surfaces: `handle_front` (+z) and `handle_rear`, both biquadratic; u runs along +y, v across.
    """
    faces = {"handle_front": _flat_face(1.0), "handle_rear": _flat_face(-1.0)}
    u, v = (grid.ravel() for grid in np.meshgrid(np.linspace(0, 1, 12), np.linspace(0, 1, 9), indexing="ij"))
    handle = Hull.from_points(np.vstack([face.evaluate(u, v) for face in faces.values()]))
    outline = 1e-3 * np.array(
        [(-2.6, -16.0), (2.6, -16.0), (3.4, -22.0), (3.4, -40.0), (2.6, -48.0), (-0.8, -45.0), (-3.2, -37.0)]
    )
    blade = extrude(outline, -0.0002, 0.0002, axis=2)
    return GeneratedShape(
        (
            convex_part("handle", handle, _STEEL, _SILVER),
            convex_part("blade", blade, _STEEL, (0.60, 0.62, 0.66, 1.0)),
        ),
        faces,
    )


def _quarter(facing: Array) -> BezierPatch:
    """The quarter of the bar that faces (x, z): a cubic arc, within 0.03 % of the circle, along the bar."""
    # Around the bar from x to z, so that the normal p_u x p_v points outwards.
    across = np.array([-facing[1], facing[0]])
    reach = 4.0 / 3.0 * np.tan(np.pi / 8.0)
    start, end = (facing - across) / np.sqrt(2.0), (facing + across) / np.sqrt(2.0)
    inner = [start + reach * (facing + across) / np.sqrt(2.0), end + reach * (facing - across) / np.sqrt(2.0)]
    arc = _AXIS_XZ + _RADIUS * np.array([start, *inner, end])
    return BezierPatch(np.array([[(x, y, z) for x, z in arc] for y in _HANDLE_Y]))


def _flat_face(side: float) -> BezierPatch:
    """A face of the flat handle: biquadratic, thickest in the middle."""
    half_width, half = _FLAT_HALF
    low, high = _FLAT_Y
    # Quadratic control values of s^2 over [-1, 1] are (1, -1, 1).
    square = np.array([1.0, -1.0, 1.0])
    z = side * (half - _FLAT_BULGE[0] * square[None, :] - _FLAT_BULGE[1] * square[:, None])
    y, x = np.meshgrid([low, 0.5 * (low + high), high], half_width * np.arange(-1.0, 2.0), indexing="ij")
    net = np.stack([x, y, z], axis=-1)
    return BezierPatch(net[:, ::-1] if side > 0 else net)


def _ring_with_flats(corners: Array, centre: Array, radius: float, sides: int) -> Array:
    """A convex polygon (n, 2) through `corners`, completed by points of a circle well away from them."""
    step = 2.0 * np.pi / sides
    taken = np.arctan2(*(corners - centre).T[::-1])
    angles = np.arange(sides) * step
    gap = np.abs(np.angle(np.exp(1j * (angles[:, None] - taken[None, :])))).min(axis=1)
    free = angles[gap > 0.6 * step]
    circle = centre + radius * np.column_stack([np.cos(free), np.sin(free)])
    return np.unique(np.concatenate([corners, circle]).round(9), axis=0)
