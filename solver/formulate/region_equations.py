"""Point, normal and tangents of a contact region in its body's frame, as polynomials of its parameters."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import BezierPatch, Cap, PointRegion, Region, flat_normal, perpendicular
from ..contacts import ContactPoint, State
from ..polynomial import Polynomial, SystemBuilder, Vector, constant_vector, dot, total
from .angles import LIMIT_ROOM

__all__ = [
    "UNIT_M",
    "UNIT_RANGE",
    "FillDependent",
    "Surface",
    "at_least_cap",
    "free_normal",
    "index_of",
    "surface_of",
]

# Fills inputs that follow from the others at a state, given its contact points.
FillDependent = Callable[[Array, State, list[ContactPoint]], None]

# Lengths of a hand are near 1 in this unit, so that one tolerance serves lengths and direction cosines.
UNIT_M = 0.05
# Entries of unit vectors; with room, for a box around an entry of exactly 1 must fit as well.
UNIT_RANGE = (-1.0 - LIMIT_ROOM, 1.0 + LIMIT_ROOM)
# Control points that agree to this share of the net's size are taken as equal: decimals carry no more.
_NET_ROUNDING = 1e-13


@dataclass(frozen=True)
class Surface:
    """A region in its own body's frame.

    Attributes:
        point: of a patch or point region, the centre of a cap; in units of `UNIT_M`.
        normal: outward unit normal; None of a cap, whose normal the other side decides.
        tangents: two of a patch, of any length, or of a point; none of a cap.
        params: indices of the parameters of a patch.
        fillers: of further inputs.
    """

    point: Vector
    normal: Vector | None = None
    tangents: list[Vector] = field(default_factory=list)
    params: list[int] = field(default_factory=list)
    fillers: list[FillDependent] = field(default_factory=list)


def surface_of(builder: SystemBuilder, name: str, region: Region) -> Surface:
    """Writes a region; patches add their parameters, and curved ones their unit normal, to the system."""
    match region:
        case Cap():
            return Surface(constant_vector(region.centre / UNIT_M))
        case PointRegion():
            tangents = [constant_vector(t) for t in perpendicular(region.normal)]
            return Surface(constant_vector(region.point / UNIT_M), constant_vector(region.normal), tangents)
    return _patch_surface(builder, name, region.patch)


def index_of(variable: Polynomial) -> int:
    """The index of the one variable that a polynomial holds."""
    (i,) = variable.variables
    return i


def free_normal(builder: SystemBuilder, name: str, cap: Cap) -> Vector:
    """A unit vector within the cap, in the frame of its body."""
    n = [builder.variable(f"{name}{i}", *UNIT_RANGE) for i in range(3)]
    builder.equate(dot(n, n) - 1.0)
    at_least_cap(builder, dot(n, constant_vector(cap.axis)), cap)
    return n


def at_least_cap(builder: SystemBuilder, cosine: Polynomial, cap: Cap) -> None:
    """The cosine of the angle to the cap's axis is that of its half angle at least."""
    builder.at_least_zero(cosine - (float(np.cos(cap.half_angle_rad)) - LIMIT_ROOM))


def _patch_surface(builder: SystemBuilder, name: str, patch: BezierPatch) -> Surface:
    """Point, unit normal and tangents of a patch (paper, equations 17-25)."""
    u = builder.variable(f"{name} u", -LIMIT_ROOM, 1.0 + LIMIT_ROOM)
    v = builder.variable(f"{name} v", -LIMIT_ROOM, 1.0 + LIMIT_ROOM)
    params = [index_of(u), index_of(v)]
    point = _bezier(builder, f"{name} p", patch.control_points / UNIT_M, u, v)
    tangents = [
        _bezier(builder, f"{name} t{k}", net / np.abs(net).max(), u, v)
        for k, net in enumerate((patch.du.control_points, patch.dv.control_points))
    ]
    flat = flat_normal(patch)
    if flat is not None:
        return Surface(point, constant_vector(flat), tangents, params)
    unit, filler = _unit_normal(builder, name, patch, u, v)
    return Surface(point, unit, tangents, params, [filler])


def _unit_normal(
    builder: SystemBuilder, name: str, patch: BezierPatch, u: Polynomial, v: Polynomial
) -> tuple[Vector, FillDependent]:
    """The unit normal of a curved patch, and what fills it and the length of the normal vector."""
    normals = patch.normal.control_points
    lengths = np.linalg.norm(normals, axis=-1)
    scale = float(lengths.mean())
    n = _bezier(builder, f"{name} n", normals / scale, u, v)
    nu = builder.variable(f"{name} nu", 0.0, float(lengths.max() / scale) * (1.0 + 1e-9))
    unit = [builder.variable(f"{name} unit{i}", *UNIT_RANGE) for i in range(3)]
    # n = nu n_unit with |n_unit| = 1 says the same as equations (21) and (23), and leaves (21) redundant.
    for i in range(3):
        builder.equate(n[i] - nu * unit[i])
    builder.equate(dot(unit, unit) - 1.0)
    builder.imply(dot(n, n) - nu * nu)
    builder.imply(dot(n, unit) - nu)
    params, length, entries = (index_of(u), index_of(v)), index_of(nu), [index_of(x) for x in unit]

    def fill(x: Array, state: State, points: list[ContactPoint]) -> None:
        del state, points
        normal = patch.normal.evaluate(x[params[0]], x[params[1]]) / scale
        x[length] = np.linalg.norm(normal)
        x[entries] = normal / x[length]

    return unit, fill


def _bezier(builder: SystemBuilder, name: str, net: Array, u: Polynomial, v: Polynomial) -> Vector:
    """The three coordinates of a Bezier net as polynomials (bilinear and flatter) or Bernstein functions."""
    return [_bezier_coordinate(builder, f"{name}{i}", net[..., i], u, v) for i in range(3)]


def _bezier_coordinate(
    builder: SystemBuilder, name: str, b: Array, u: Polynomial, v: Polynomial
) -> Polynomial:
    size = max(float(np.abs(b).max()), 1e-9)
    if np.ptp(b) <= _NET_ROUNDING * size:
        return Polynomial.constant(float(b.flat[0]))
    if max(b.shape) > 2:
        return builder.bernstein(name, u, v, b)
    full = np.broadcast_to(b, (2, 2))
    cu, cv = full[1, 0] - full[0, 0], full[0, 1] - full[0, 0]
    cuv = full[1, 1] - full[1, 0] - full[0, 1] + full[0, 0]
    terms = [(cu, u), (cv, v), (cuv, u * v)]
    return total(p * float(c) for c, p in terms if abs(c) > _NET_ROUNDING * size) + float(full[0, 0])
