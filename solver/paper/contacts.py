"""One side of a contact as the paper writes it: point, normal, unit normal, length and parameters."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import BezierPatch, Cap, Patch, PointRegion, Region
from ..formulate import LIMIT_ROOM
from ..polynomial import Polynomial
from .cap_patch import CapPatch
from .variables import PaperVariables, Vector, constant, dot

__all__ = ["HAND", "OBJECT", "PaperSide", "SideNames", "add_side"]

# x (n_v,) to fill, unit normal (3,) of the body at the contact, in its own frame, and the patch's parameters.
FillSide = Callable[[Array, Array, Array], None]

_UNIT = (-1.0 - LIMIT_ROOM, 1.0 + LIMIT_ROOM)


@dataclass(frozen=True)
class SideNames:
    """The paper's letters for one side of a contact (section 3.4)."""

    point: str
    normal: str
    unit: str
    length: str
    params: tuple[str, str]

    def of(self, contact: int) -> "SideNames":
        """The names for one contact: "h" becomes "contact 0 h"."""
        point, normal, unit, length, first, second = (
            f"contact {contact} {letter}"
            for letter in (self.point, self.normal, self.unit, self.length, *self.params)
        )
        return SideNames(point, normal, unit, length, (first, second))


HAND = SideNames("h", "m", "m^", "mu", ("u", "v"))
OBJECT = SideNames("o", "n", "n^", "nu", ("s", "t"))


@dataclass(frozen=True)
class PaperSide:
    """One side of a contact in the frame of its body.

    Attributes:
        point: h or o, in units of length.
        unit: the unit normal, m^ or n^.
        reach: a bound on the length of `point`.
        n_params: how many of the state's patch parameters belong to this side.
        fill: fills this side's variables at a state.
    """

    point: Vector
    unit: Vector
    reach: float
    n_params: int
    fill: FillSide


def add_side(variables: PaperVariables, name: SideNames, region: Region, unit_m: float) -> PaperSide:
    """Adds 12 variables and 10 equations of one side: (17), (20), (22), (24), or (18), (21), (23), (25).

    A point with its normal is known, so it adds nothing.
    """
    match region:
        case Patch():
            return _add_patch(variables, name, region.patch, unit_m)
        case Cap():
            return _add_cap(variables, name, region, unit_m)
        case PointRegion():
            point = region.point / unit_m
            reach = float(np.linalg.norm(point))
            return PaperSide(constant(point), constant(region.normal), reach, 0, _nothing_to_fill)


def _add_patch(variables: PaperVariables, name: SideNames, patch: BezierPatch, unit_m: float) -> PaperSide:
    u, v = _parameters(variables, name)
    net = patch.control_points / unit_m
    point = variables.bezier(name.point, u, v, net)
    # Normals in units of their mean length, so that mu and nu are near 1.
    scale = float(np.linalg.norm(patch.normal.control_points, axis=-1).mean())
    normals = BezierPatch(patch.normal.control_points / scale)
    unit = _add_unit_normal(variables, name, u, v, normals)

    def fill(x: Array, normal: Array, params: Array) -> None:
        del normal
        x[variables.indices[name.params[0]]], x[variables.indices[name.params[1]]] = params
        x[variables.indices[name.point]] = BezierPatch(net).evaluate(*params)
        _fill_normal(x, variables, name, normals.evaluate(*params))

    return PaperSide(point, unit, variables.bound(name.point), 2, fill)


def _add_cap(variables: PaperVariables, name: SideNames, cap: Cap, unit_m: float) -> PaperSide:
    u, v = _parameters(variables, name)
    patch = CapPatch(cap)
    unit = _add_unit_normal(variables, name, u, v, patch.normal)
    if cap.half_angle_rad < np.pi:
        bound = float(np.cos(cap.half_angle_rad)) - LIMIT_ROOM
        variables.builder.at_least_zero(dot(unit, constant(cap.axis)) - bound)
    centre, radius = cap.centre / unit_m, cap.radius / unit_m
    point = [n * radius + float(c) for n, c in zip(unit, centre, strict=True)]
    point = variables.defined(name.point, point, -np.inf, np.inf)

    def fill(x: Array, normal: Array, params: Array) -> None:
        del params
        u, v = patch.params(normal)
        x[variables.indices[name.params[0]]], x[variables.indices[name.params[1]]] = u, v
        _fill_normal(x, variables, name, patch.normal.evaluate(u, v))
        x[variables.indices[name.point]] = centre + radius * x[variables.indices[name.unit]]

    return PaperSide(point, unit, variables.bound(name.point), 0, fill)


def _add_unit_normal(
    variables: PaperVariables, name: SideNames, u: Polynomial, v: Polynomial, normals: BezierPatch
) -> Vector:
    """The vectors m and m^ with the length mu (equations 20, 22 and 24)."""
    m = variables.bezier(name.normal, u, v, normals.control_points)
    unit = variables.inputs(name.unit, 3, *_UNIT)
    (length,) = variables.inputs(name.length, 1, *_lengths(normals))
    variables.builder.equate(length * length - dot(m, m))
    for a, b in zip(m, unit, strict=True):
        variables.builder.equate(a - length * b)
    return unit


def _lengths(normals: BezierPatch) -> tuple[float, float]:
    """Bounds on the length of a patch of normals, from its control points."""
    net = normals.control_points.reshape(-1, 3)
    longest = float(np.linalg.norm(net, axis=1).max())
    mean = net.mean(axis=0)
    size = float(np.linalg.norm(mean))
    shortest = float((net @ mean).min()) / size if size > 1e-9 * longest else 0.0
    return max(0.0, shortest * (1.0 - 1e-6)), longest * (1.0 + 1e-6)


def _fill_normal(x: Array, variables: PaperVariables, name: SideNames, normal: Array) -> None:
    length = np.linalg.norm(normal)
    x[variables.indices[name.normal]] = normal
    x[variables.indices[name.length]] = length
    x[variables.indices[name.unit]] = normal / length


def _parameters(variables: PaperVariables, name: SideNames) -> tuple[Polynomial, Polynomial]:
    (u,), (v,) = (variables.inputs(p, 1, -LIMIT_ROOM, 1.0 + LIMIT_ROOM) for p in name.params)
    return u, v


def _nothing_to_fill(x: Array, normal: Array, params: Array) -> None:
    del x, normal, params
