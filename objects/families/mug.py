"""Mugs."""

from math import pi, radians

import numpy as np

from ...geometry import BezierPatch, Hull, Patch
from ...geometry.solids import Loft, revolve, solid_inertia
from ..object_model import Part
from .material import STONEWARE
from .member import Member
from .patches import arc, revolved

__all__ = ["make_mug"]


# By one finger or two against the thumb, around the body with the handle to one side. The handle is
# too short for two fingers beside each other: of eight such grasps of a mug one held.
_AROUND_THE_BODY = (
    (("thumb/tip", "body_right"), ("index/tip", "body_left")),
    (("thumb/tip", "body_right"), ("index/tip", "body_left"), ("middle/tip", "body_left")),
)
_SIDES = 72
_ROUND = 32
# Sides of the wall in one convex piece: one in the fine part, where its chord across the hollow stands out of
# the wall by 0.04 mm, three elsewhere, where that is 0.4 mm. Pads that pinch the rim span 60 degrees.
_FINE_SIDES, _COARSE_SIDES = 12, 3
_RIM_HALF = radians(12.0)


def make_mug(rng: np.random.Generator) -> Member:
    """A mug about z with its handle towards +x, held by the handle between index finger and thumb.

    It is hollow. The handle is a bow whose middle is straight; regions lie on both sides (y) of that part, on
    both sides of the body, and inside and outside of the wall below the rim, across from the handle.
    """
    radius, height, wall = rng.uniform(0.033, 0.045), rng.uniform(0.075, 0.11), rng.uniform(0.003, 0.0045)
    cup = _cup(radius, height, wall)
    # Half the handle's straight part, its distance from the axis, and the half-axes of its section.
    half, reach = 0.5 * rng.uniform(0.3, 0.42) * height, radius + rng.uniform(0.03, 0.04)
    across, along = rng.uniform(0.005, 0.009), rng.uniform(0.004, 0.007)
    middle = 0.5 * height
    bow = _bow(radius - 0.5 * wall, reach, middle, half, 0.38 * height, across, along)
    bow_mesh = bow.mesh()
    handle = Part(
        "handle",
        bow_mesh,
        bow.pieces(_cuts(bow)),
        solid_inertia(bow_mesh, STONEWARE.density),
        STONEWARE.rgba,
    )
    cup_mesh = cup.mesh()
    vessel = Part(
        "cup",
        cup_mesh,
        _pieces_of_cup(radius, height, wall),
        solid_inertia(cup_mesh, STONEWARE.density),
        STONEWARE.rgba,
    )
    low, high = middle - 0.8 * half, middle + 0.8 * half
    band, wide = np.array([[radius, 0.15 * height], [radius, 0.9 * height]]), radians(30.0)
    below, above = height - 0.015, height - 0.003
    # Downwards inside: the wall is on the left there.
    inner, outer = [[radius - wall, above], [radius - wall, below]], [[radius, below], [radius, above]]
    regions = {
        "handle_left": _side(reach, across, along, low, high, 0.5 * pi),
        "handle_right": _side(reach, across, along, low, high, -0.5 * pi),
        "body_left": revolved(band, 0.5 * pi - wide, 0.5 * pi + wide),
        "body_right": revolved(band, -0.5 * pi - wide, -0.5 * pi + wide),
        "rim_inside": revolved(np.array(inner), pi - _RIM_HALF, pi + _RIM_HALF),
        "rim_outside": revolved(np.array(outer), pi - _RIM_HALF, pi + _RIM_HALF),
    }
    return Member(
        (vessel, handle),
        regions,
        (("index/tip", "handle_left"), ("thumb/tip", "handle_right")),
        {
            "shape": "an open cup, hollow where bodies collide too",
            "mass": f"walls of {1e3 * wall:.1f} mm and a solid handle of {STONEWARE}",
        },
        _AROUND_THE_BODY,
    )


def _cup(radius: float, height: float, wall: float) -> Loft:
    inside = radius - wall
    profile = [[radius, 0.0], [radius, height], [inside, height], [inside, 2.0 * wall]]
    return revolve(np.array(profile), _SIDES)


def _pieces_of_cup(radius: float, height: float, wall: float) -> tuple[Hull, ...]:
    """The bottom, and the wall in pieces that follow one another around it."""
    bottom = Hull.from_points(
        revolve(np.array([[radius, 0.0], [radius, 2.0 * wall]]), _SIDES).rings.reshape(-1, 3)
    )
    inside = radius - wall
    outline = np.array([[radius, 0.0], [radius, height], [inside, height], [inside, 0.0]])
    around = Loft(revolve(outline, _SIDES).rings.transpose(1, 0, 2), is_loop=True)
    first, last = (_SIDES - _FINE_SIDES) // 2, (_SIDES + _FINE_SIDES) // 2
    cuts = [*range(0, first, _COARSE_SIDES), *range(first, last), *range(last, _SIDES + 1, _COARSE_SIDES)]
    return (bottom, *around.pieces(cuts))


def _bow(
    root: float, reach: float, middle: float, half: float, spread: float, across: float, along: float
) -> Loft:
    """Elliptic sections along a line from the wall, round a bend, straight down, and back to the wall."""
    t = np.linspace(0.0, 1.0, 9)
    # A quadratic Bezier curve whose corner is where the straight parts would meet.
    corners = np.array([[root, middle + spread], [reach, middle + spread], [reach, middle + half]])
    weights = np.column_stack([(1 - t) ** 2, 2 * t * (1 - t), t**2])
    tangents = np.column_stack([1 - t, t]) @ np.diff(corners, axis=0)
    upper = weights @ corners
    points = np.vstack([upper, upper[::-1] * [1, -1] + [0.0, 2.0 * middle]])
    directions = np.vstack([tangents, tangents[::-1] * [-1, 1]])
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    angle = np.arange(_ROUND) * 2.0 * pi / _ROUND
    rings = np.zeros((len(points), _ROUND, 3))
    normals = np.column_stack([-directions[:, 1], directions[:, 0]])
    rings[..., 0] = points[:, :1] + along * np.cos(angle) * normals[:, :1]
    rings[..., 1] = across * np.sin(angle)
    rings[..., 2] = points[:, 1:] + along * np.cos(angle) * normals[:, 1:]
    return Loft(rings)


def _cuts(bow: Loft) -> tuple[int, ...]:
    """The straight part, where the regions lie, is a piece of its own; of the bends 0.4 mm may be filled."""
    last = len(bow.rings) - 1
    upper = Loft(bow.rings[: last // 2 + 1]).find_cuts(4e-4)
    return (*upper, *(last - i for i in reversed(upper)))


def _side(reach: float, across: float, along: float, low: float, high: float, angle: float) -> Patch:
    """The part of the straight handle's side within 40 degrees of `angle` about its middle line, upwards."""
    circle = arc(angle - radians(40.0), angle + radians(40.0)) * [along, across] + [reach, 0.0]
    net = np.array([[[x, y, z] for z in (low, high)] for x, y in circle])
    return Patch(BezierPatch(net))
