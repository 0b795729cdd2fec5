"""The compact formulation of a configuration problem (the default).

Unknowns are (cos, sin) of the joint angles of those fingers that have a contact, the object's rotation
matrix and position, and the parameters of Bezier patches. Chains are written by `chain.py`; a contact
with a spherical cap says that the sphere's centre lies on the offset of the other surface. Lengths are
in units of `UNIT_M`.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..geometry import BezierPatch, Cap, Patch, PointRegion
from ..geometry.transforms import perpendicular
from ..objects import Contact, Task
from .angles import LIMIT_ROOM
from .chain import ChainBuilder, PolynomialFrame
from .contact_manifold import ContactManifold, ContactPoint
from .polynomial import Polynomial, total
from .state import State
from .system import PolynomialSystem, SystemBuilder

__all__ = ["UNIT_M", "Formulation", "formulate"]

Array = NDArray[np.float64]
Vector = list[Polynomial]
Filler = Callable[[Array, State, list[ContactPoint]], None]

# Lengths of a hand are near 1 in this unit, so that one tolerance serves lengths and direction cosines.
UNIT_M = 0.05
# Control points that agree to this share of the net's size are taken as equal: decimals carry no more.
_NET_ROUNDING = 1e-13
# Entries of unit vectors; with room, for a box around an entry of exactly 1 must fit as well.
_UNIT = (-1.0 - LIMIT_ROOM, 1.0 + LIMIT_ROOM)


@dataclass(frozen=True, eq=False)
class Formulation:
    """A task as a polynomial system, with the way there and back.

    Attributes:
        task: the task.
        system: the polynomial system; its inputs are listed in the attributes below.
        angle_inputs: independent joint -> (index of cosine, index of sine) of its angle by its divisor.
        divisors: independent joint -> whole number; above 1 where joints follow it by a fraction.
        slide_inputs: independent joint -> index.
        rotation_inputs: (6,) indices of the first two columns of R_palm_object; none if it is fixed.
        position_inputs: (3,) indices of the object's position; likewise.
        param_inputs: (n_params,) indices of the patch parameters, in the order of `State.params`.
        fillers: fill the inputs that follow from the others at a state, normals of caps and curved patches.
    """

    task: Task
    system: PolynomialSystem
    angle_inputs: dict[int, tuple[int, int]]
    divisors: dict[int, int]
    slide_inputs: dict[int, int]
    rotation_inputs: NDArray[np.int64]
    position_inputs: NDArray[np.int64]
    param_inputs: NDArray[np.int64]
    fillers: tuple[Filler, ...]

    def inputs_from_state(self, state: State) -> Array:
        """A vector (n,) of the system with the inputs of `state` filled in."""
        x = np.zeros(self.system.size)
        for j, (c, s) in self.angle_inputs.items():
            angle = state.q[j] / self.divisors[j]
            x[c], x[s] = np.cos(angle), np.sin(angle)
        for j, slide in self.slide_inputs.items():
            x[slide] = state.q[j] / UNIT_M
        if self.task.T_palm_object is None:
            x[self.rotation_inputs] = state.R_palm_object[:, :2].T.ravel()
            x[self.position_inputs] = state.p_palm_object / UNIT_M
        x[self.param_inputs] = state.params
        points = self._manifold.contact_points(state) if self.fillers else []
        for fill in self.fillers:
            fill(x, state, points)
        return x

    def state_from_inputs(self, x: Array, q_free: Array) -> State:
        """The state at a vector (n,) of the system; `q_free` (n_independent,) fills the other joints."""
        q = np.array(q_free, dtype=float)
        joints, divisors, cosines, sines, middles = self._angle_arrays
        # The turn nearest to the middle of the limits, which need not lie around zero.
        turns = np.arctan2(x[sines], x[cosines]) - middles
        q[joints] = divisors * (middles + turns - 2.0 * np.pi * np.round(turns / (2.0 * np.pi)))
        for j, slide in self.slide_inputs.items():
            q[j] = x[slide] * UNIT_M
        limits = self.task.limits
        q = np.minimum(np.maximum(q, limits[:, 0]), limits[:, 1])
        params = np.clip(x[self.param_inputs], 0.0, 1.0)
        if self.task.T_palm_object is not None:
            return State(q, self.task.T_palm_object[:3, :3], self.task.T_palm_object[:3, 3], params)
        c, d = x[self.rotation_inputs].reshape(2, 3)
        R = np.column_stack([c, d, np.cross(c, d)])
        U, _, Vt = np.linalg.svd(R)
        R = U @ np.diag([1.0, 1.0, np.linalg.det(U @ Vt)]) @ Vt
        return State(q, R, x[self.position_inputs] * UNIT_M, params)

    @cached_property
    def _manifold(self) -> ContactManifold:
        return ContactManifold(self.task)

    @cached_property
    def _angle_arrays(
        self,
    ) -> tuple[NDArray[np.int64], Array, NDArray[np.int64], NDArray[np.int64], Array]:
        """Joints with divisors, cosines, sines, and the middles of the limits of what these are of."""
        joints = np.array(list(self.angle_inputs), dtype=np.int64)
        divisors = np.array([self.divisors[j] for j in self.angle_inputs], dtype=float)
        ends = np.array(list(self.angle_inputs.values()), dtype=np.int64).reshape(-1, 2)
        return joints, divisors, ends[:, 0], ends[:, 1], self.task.limits[joints].mean(axis=1) / divisors


def formulate(task: Task) -> Formulation:
    """Writes a task as a polynomial system."""
    builder = SystemBuilder()
    chain = ChainBuilder(builder, task.hand, task.limits, UNIT_M)
    frames = [chain.frame(contact.hand.link) for contact in task.contacts]
    R, p, rotation_inputs, position_inputs = _object_pose(builder, task)
    sides: list[_ContactParts] = []
    for k, (contact, frame) in enumerate(zip(task.contacts, frames, strict=True)):
        sides.append(_add_contact(builder, k, contact, frame, R, p))
    _imply_distances(builder, sides, R)
    return Formulation(
        task,
        builder.build(),
        {j: (_index(a.cos), _index(a.sin)) for j, a in chain.angles.items()},
        chain.divisors,
        {j: _index(v) for j, v in chain.slides.items()},
        rotation_inputs,
        position_inputs,
        np.array([i for side in sides for i in side.params], dtype=np.int64),
        tuple(fill for side in sides for fill in side.fillers),
    )


def _object_pose(
    builder: SystemBuilder, task: Task
) -> tuple[list[Vector], Vector, NDArray[np.int64], NDArray[np.int64]]:
    """Columns of the object's rotation, its position, and their inputs: none where the object is fixed."""
    if task.T_palm_object is not None:
        none = np.zeros(0, dtype=np.int64)
        R, p = task.T_palm_object[:3, :3], task.T_palm_object[:3, 3]
        return [_constant(R[:, j]) for j in range(3)], _constant(p / UNIT_M), none, none
    rotation_inputs = np.arange(len(builder.names), len(builder.names) + 6)
    rotation = _rotation(builder)
    reach = _reach(task)
    position_inputs = np.arange(len(builder.names), len(builder.names) + 3)
    position = [builder.variable(f"object p{i}", -reach, reach) for i in range(3)]
    return rotation, position, rotation_inputs, position_inputs


def _index(p: Polynomial) -> int:
    (i,) = p.variables
    return i


def _reach(task: Task) -> float:
    """A bound on any coordinate of the object's origin: longest chain plus size and offset of the object."""
    lengths = [0.0] * len(task.hand.links)
    slide = sum(max(abs(a.lower), abs(a.upper)) for a in task.hand.axes if a.kind == "prismatic")
    for i, link in enumerate(task.hand.links):
        before = lengths[link.parent] if link.parent >= 0 else 0.0
        lengths[i] = before + float(np.linalg.norm(link.T_parent_link0[:3, 3]))
    radius = 0.0
    for contact in task.contacts:
        for region in (contact.hand.region, contact.object.region):
            radius = max(radius, _extent(region))
    return (max(lengths) + slide + 2.0 * radius) / UNIT_M + 1.0


def _extent(region: Cap | Patch | PointRegion) -> float:
    """Largest distance of the region from its frame's origin; a cap's radius counts twice (the offset)."""
    match region:
        case Cap():
            return float(np.linalg.norm(region.centre)) + 2.0 * region.radius
        case PointRegion():
            return float(np.linalg.norm(region.point))
        case Patch():
            return float(np.linalg.norm(region.patch.control_points, axis=-1).max())


def _rotation(builder: SystemBuilder) -> list[Vector]:
    """Columns c, d, e of the object's rotation (paper, equations 4-7) with their redundant relatives."""
    columns = [[builder.variable(f"object R{i}{j}", *_UNIT) for i in range(3)] for j in range(2)]
    c, d = columns
    e = [
        builder.define(f"object R{i}2", c[j] * d[k] - c[k] * d[j], *_UNIT)
        for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
    ]
    builder.equate(_dot(c, c) - 1.0)
    builder.equate(_dot(d, d) - 1.0)
    builder.equate(_dot(c, d))
    builder.imply(_dot(e, e) - 1.0)
    builder.imply(_dot(c, e))
    builder.imply(_dot(d, e))
    rows = [[column[i] for column in (c, d, e)] for i in range(3)]
    for a in range(3):
        for b in range(a, 3):
            builder.imply(_dot(rows[a], rows[b]) - (1.0 if a == b else 0.0))
    return [c, d, e]


def _dot(a: Vector, b: Vector) -> Polynomial:
    return total(x * y for x, y in zip(a, b, strict=True))


def _constant(v: Array) -> Vector:
    return [Polynomial.constant(float(x)) for x in v]


@dataclass(frozen=True)
class _ContactParts:
    """What two contacts are compared by: the same point and normal in the palm frame and in the object's."""

    in_palm: Vector
    in_object: Vector
    n_palm: Vector
    n_object: Vector
    params: list[int]
    fillers: list[Filler]


@dataclass(frozen=True)
class _Surface:
    """Point and, where it has one, unit normal of a region in its own body's frame."""

    point: Vector
    normal: Vector | None
    tangents: list[Vector]
    params: list[int]
    fillers: list[Filler]


def _add_contact(
    builder: SystemBuilder, number: int, contact: Contact, frame: PolynomialFrame, R: list[Vector], p: Vector
) -> _ContactParts:
    """Adds the equations of one contact (paper, equations 15-25, with the unit normals worked in)."""
    name = f"contact {number}"
    on_hand = _surface(builder, f"{name} hand", contact.hand.region)
    on_object = _surface(builder, f"{name} object", contact.object.region)
    params = on_hand.params + on_object.params
    fillers = on_hand.fillers + on_object.fillers
    hand_cap = contact.hand.region if isinstance(contact.hand.region, Cap) else None
    object_cap = contact.object.region if isinstance(contact.object.region, Cap) else None
    h = _hand_point(builder, name, frame, contact, on_hand)
    if object_cap is not None:
        n_object = _free_normal(builder, f"{name} object n", object_cap)
        fillers.append(_cap_filler(number, [_index(n) for n in n_object]))
        o = [c + n * (object_cap.radius / UNIT_M) for c, n in zip(on_object.point, n_object, strict=True)]
    else:
        assert on_object.normal is not None
        o, n_object = on_object.point, on_object.normal
    if hand_cap is not None:
        o = [x + n * (hand_cap.radius / UNIT_M) for x, n in zip(o, n_object, strict=True)]
    o = [builder.form(f"{name} o{i}", x) for i, x in enumerate(o)]
    turned = _rotate(builder, f"{name} Ro", R, o)
    for i in range(3):
        builder.equate(h[i] - turned[i] - p[i])
    N = _rotate(builder, f"{name} N", R, n_object)
    N = [builder.form(f"{name} N{i}", x) for i, x in enumerate(N)]
    if any(x.degree for x in N):
        builder.imply(_dot(N, N) - 1.0)
    if hand_cap is not None:
        _limit_cap(builder, f"{name} axis", frame, hand_cap, N)
    else:
        _oppose(builder, name, frame, contact, on_hand, N)
    return _ContactParts(h, o, N, n_object, params, fillers)


def _hand_point(
    builder: SystemBuilder, name: str, frame: PolynomialFrame, contact: Contact, surface: _Surface
) -> Vector:
    """The hand's point (or sphere centre) in the palm frame, as linear forms."""
    region = contact.hand.region
    if isinstance(region, Patch):
        columns, origin = frame.settled()
        turned = _rotate(builder, f"{name} Rh", columns, surface.point)
        h = [o + t for o, t in zip(origin, turned, strict=True)]
    else:
        local = region.centre if isinstance(region, Cap) else region.point
        h = frame.point(local / UNIT_M)
    return [builder.form(f"{name} h{i}", x) for i, x in enumerate(h)]


def _rotate(builder: SystemBuilder, name: str, columns: list[Vector], v: Vector) -> Vector:
    return [total(builder.product(f"{name}{i}{j}", columns[j][i], v[j]) for j in range(3)) for i in range(3)]


def _free_normal(builder: SystemBuilder, name: str, cap: Cap) -> Vector:
    """A unit vector within the cap, in the frame of its body."""
    n = [builder.variable(f"{name}{i}", *_UNIT) for i in range(3)]
    builder.equate(_dot(n, n) - 1.0)
    builder.at_least_zero(_dot(n, _constant(cap.axis)) - _cap_bound(cap))
    return n


def _cap_bound(cap: Cap) -> float:
    return float(np.cos(cap.half_angle_rad)) - LIMIT_ROOM


def _limit_cap(builder: SystemBuilder, name: str, frame: PolynomialFrame, cap: Cap, N: Vector) -> None:
    """The hand's normal -N lies within the cap's half angle of its axis."""
    if cap.half_angle_rad >= np.pi:
        return
    axis = [builder.form(f"{name}{i}", a) for i, a in enumerate(frame.direction(cap.axis))]
    if any(a.degree for a in axis):
        builder.imply(_dot(axis, axis) - 1.0)
    builder.at_least_zero(-_dot(axis, N) - _cap_bound(cap))


def _oppose(
    builder: SystemBuilder, name: str, frame: PolynomialFrame, contact: Contact, surface: _Surface, N: Vector
) -> None:
    """A hand patch or point: its tangents are perpendicular to N and its normal faces against it."""
    columns, _ = frame.settled()
    for k, tangent in enumerate(surface.tangents):
        t = _rotate(builder, f"{name} t{k}", columns, tangent)
        t = [builder.form(f"{name} t{k}{i}", x) for i, x in enumerate(t)]
        builder.equate(_dot(t, N))
    assert surface.normal is not None
    m = _rotate(builder, f"{name} m", columns, surface.normal)
    m = [builder.form(f"{name} m{i}", x) for i, x in enumerate(m)]
    for i in range(3):
        builder.imply(m[i] + N[i])
    builder.at_least_zero(-_dot(m, N))


def _surface(builder: SystemBuilder, name: str, region: Cap | Patch | PointRegion) -> _Surface:
    match region:
        case Cap():
            return _Surface(_constant(region.centre / UNIT_M), None, [], [], [])
        case PointRegion():
            tangents = [_constant(t) for t in perpendicular(region.normal)]
            return _Surface(_constant(region.point / UNIT_M), _constant(region.normal), tangents, [], [])
        case Patch():
            return _patch_surface(builder, name, region.patch)


def _patch_surface(builder: SystemBuilder, name: str, patch: BezierPatch) -> _Surface:
    """Point, unit normal and tangents of a patch (paper, equations 17-25)."""
    u = builder.variable(f"{name} u", -LIMIT_ROOM, 1.0 + LIMIT_ROOM)
    v = builder.variable(f"{name} v", -LIMIT_ROOM, 1.0 + LIMIT_ROOM)
    point = _bezier(builder, f"{name} p", patch.control_points / UNIT_M, u, v)
    tangents = [
        _bezier(builder, f"{name} t{k}", net / np.abs(net).max(), u, v)
        for k, net in enumerate((patch.du.control_points, patch.dv.control_points))
    ]
    normals = patch.normal.control_points
    mean = normals.reshape(-1, 3).mean(axis=0)
    mean /= np.linalg.norm(mean)
    lengths = np.linalg.norm(normals, axis=-1)
    if np.abs(normals / lengths[..., None] - mean).max() < _NET_ROUNDING:
        return _Surface(point, _constant(mean), tangents, [_index(u), _index(v)], [])
    scaled = normals / lengths.mean()
    n = _bezier(builder, f"{name} n", scaled, u, v)
    longest = float(lengths.max() / lengths.mean()) * (1.0 + 1e-9)
    nu = builder.variable(f"{name} nu", 0.0, longest)
    unit = [builder.variable(f"{name} unit{i}", *_UNIT) for i in range(3)]
    # n = nu n_unit with |n_unit| = 1 says the same as equations (21) and (23), and leaves (21) redundant.
    for i in range(3):
        builder.equate(n[i] - nu * unit[i])
    builder.equate(_dot(unit, unit) - 1.0)
    builder.imply(_dot(n, n) - nu * nu)
    builder.imply(_dot(n, unit) - nu)
    filler = _patch_filler(
        patch, (_index(u), _index(v)), _index(nu), [_index(x) for x in unit], lengths.mean()
    )
    return _Surface(point, unit, tangents, [_index(u), _index(v)], [filler])


def _patch_filler(
    patch: BezierPatch, params: tuple[int, int], nu: int, unit: list[int], scale: float
) -> Filler:
    """Fills the unit normal of a curved patch and the length of its normal vector."""

    def fill(x: Array, state: State, points: list[ContactPoint]) -> None:
        del state, points
        n = patch.normal.evaluate(x[params[0]], x[params[1]]) / scale
        x[nu] = np.linalg.norm(n)
        x[unit] = n / x[nu]

    return fill


def _cap_filler(number: int, normal: list[int]) -> Filler:
    """Fills the normal of an object's cap, which the contact number `number` decides."""

    def fill(x: Array, state: State, points: list[ContactPoint]) -> None:
        x[normal] = state.R_palm_object.T @ points[number].n_object

    return fill


def _bezier(builder: SystemBuilder, name: str, net: Array, u: Polynomial, v: Polynomial) -> Vector:
    """The three coordinates of a Bezier net as polynomials (bilinear and flatter) or Bernstein functions."""
    return [_bezier_coordinate(builder, f"{name}{i}", net[..., i], u, v) for i in range(3)]


def _bezier_coordinate(
    builder: SystemBuilder, name: str, b: Array, u: Polynomial, v: Polynomial
) -> Polynomial:
    size = max(float(np.abs(b).max()), 1e-9)
    if np.ptp(b) <= _NET_ROUNDING * size:
        return Polynomial.constant(float(b.flat[0]))
    if max(b.shape) <= 2:
        full = np.zeros((2, 2))
        full[: b.shape[0], : b.shape[1]] = b
        if b.shape[0] == 1:
            full[1] = full[0]
        if b.shape[1] == 1:
            full[:, 1] = full[:, 0]
        cu, cv = full[1, 0] - full[0, 0], full[0, 1] - full[0, 0]
        cuv = full[1, 1] - full[1, 0] - full[0, 1] + full[0, 0]
        terms = [(cu, u), (cv, v), (cuv, u * v)]
        return total(p * c for c, p in terms if abs(c) > _NET_ROUNDING * size) + float(full[0, 0])
    return builder.bernstein(name, u, v, b)


def _imply_distances(builder: SystemBuilder, parts: list[_ContactParts], R: list[Vector]) -> None:
    """A rigid object keeps distances and angles between contacts, and turns one difference into the other."""
    for a in range(len(parts)):
        for b in range(a + 1, len(parts)):
            name = f"contacts {a} {b}"
            D = [
                builder.form(f"{name} D{i}", x - y)
                for i, (x, y) in enumerate(zip(parts[a].in_palm, parts[b].in_palm, strict=True))
            ]
            d = [
                builder.form(f"{name} d{i}", x - y)
                for i, (x, y) in enumerate(zip(parts[a].in_object, parts[b].in_object, strict=True))
            ]
            builder.imply(_dot(D, D) - _dot(d, d))
            builder.imply(_dot(parts[a].n_palm, parts[b].n_palm) - _dot(parts[a].n_object, parts[b].n_object))
            for part in (parts[a], parts[b]):
                builder.imply(_dot(part.n_palm, D) - _dot(part.n_object, d))
            for i in range(3):
                builder.imply(_dot(R[i], D) - d[i])
                builder.imply(total(R[j][i] * d[j] for j in range(3)) - D[i])
