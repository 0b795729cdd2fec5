"""The equations of one contact, and those that a rigid object puts between two."""

from dataclasses import dataclass

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import Cap, Patch
from ...objects import Contact
from ..contacts import ContactPoint, State
from ..polynomial import SystemBuilder, Vector, combine, difference, dot
from .alignment import Facing, oppose, rotate
from .link_frames import PolynomialFrame
from .region_equations import UNIT_M, FillDependent, Surface, at_least_cap, free_normal, index_of, surface_of

__all__ = ["ContactSides", "add_contact", "keep_together"]


@dataclass(frozen=True)
class ContactSides:
    """The point that both bodies share, and the object's normal there, in the palm frame and in the object's.

    Of a spherical cap of the hand the point is the sphere's centre, which lies on the offset of the object.

    Attributes:
        in_palm: the point, in units of `UNIT_M`, as the hand has it.
        in_object: the point as the object has it.
        n_palm: the normal.
        n_object: the normal.
        params: indices of the parameters of patches, those of the hand first.
        fillers: of inputs that follow from others.
        sines: indices of the variables that tell the angle between the normals, where these have room.
    """

    in_palm: Vector
    in_object: Vector
    n_palm: Vector
    n_object: Vector
    params: list[int]
    fillers: list[FillDependent]
    sines: list[int]


def add_contact(
    builder: SystemBuilder, number: int, contact: Contact, frame: PolynomialFrame, R: list[Vector]
) -> ContactSides:
    """Adds what normals and caps ask for (paper, equations 15-25, with the unit normals worked in).

    Args:
        builder: of the system.
        number: of the contact.
        contact: the contact.
        frame: of the hand's link.
        R: columns of the object's rotation.
    """
    name = f"contact {number}"
    on_hand = surface_of(builder, f"{name} hand", contact.hand.region)
    on_object = surface_of(builder, f"{name} object", contact.object.region)
    fillers = on_hand.fillers + on_object.fillers
    h = _hand_point(builder, name, frame, contact, on_hand)
    o, n_object = on_object.point, on_object.normal
    if isinstance(contact.object.region, Cap):
        n_object = free_normal(builder, f"{name} object n", contact.object.region)
        fillers.append(_cap_filler(number, [index_of(n) for n in n_object]))
        o = _offset(o, n_object, contact.object.region.radius)
    assert n_object is not None
    if isinstance(contact.hand.region, Cap):
        o = _offset(o, n_object, contact.hand.region.radius)
    N = rotate(builder, f"{name} N", R, n_object)
    N = [builder.form(f"{name} N{i}", x) for i, x in enumerate(N)]
    if any(x.degree for x in N):
        builder.imply(dot(N, N) - 1.0)
    if isinstance(contact.hand.region, Cap):
        _limit_cap(builder, f"{name} axis", frame, contact.hand.region, N)
        sines: list[int] = []
    else:
        sines = oppose(builder, name, frame, on_hand, Facing(on_object, R, N), contact)
    return ContactSides(h, o, N, n_object, on_hand.params + on_object.params, fillers, sines)


def _offset(point: Vector, normal: Vector, distance_m: float) -> Vector:
    return [x + n * (distance_m / UNIT_M) for x, n in zip(point, normal, strict=True)]


def _hand_point(
    builder: SystemBuilder, name: str, frame: PolynomialFrame, contact: Contact, surface: Surface
) -> Vector:
    """The hand's point (or sphere centre) in the palm frame."""
    region = contact.hand.region
    if isinstance(region, Patch):
        columns, origin = frame.as_variables()
        turned = rotate(builder, f"{name} Rh", columns, surface.point)
        return [o + t for o, t in zip(origin, turned, strict=True)]
    local = region.centre if isinstance(region, Cap) else region.point
    return frame.point(local / UNIT_M)


def _limit_cap(builder: SystemBuilder, name: str, frame: PolynomialFrame, cap: Cap, N: Vector) -> None:
    """The hand's normal -N lies within the cap's half angle of its axis."""
    if cap.half_angle_rad >= np.pi:
        return
    axis = [builder.form(f"{name}{i}", a) for i, a in enumerate(frame.direction(cap.axis))]
    if any(a.degree for a in axis):
        builder.imply(dot(axis, axis) - 1.0)
    at_least_cap(builder, -dot(axis, N), cap)


def _cap_filler(number: int, normal: list[int]) -> FillDependent:
    """Fills the normal of an object's cap, which the contact number `number` decides."""

    def fill(x: Array, state: State, points: list[ContactPoint]) -> None:
        x[normal] = state.R_palm_object.T @ points[number].n_object

    return fill


def keep_together(
    builder: SystemBuilder, name: str, a: ContactSides, b: ContactSides, R: list[Vector], *, decides: bool
) -> None:
    """A rigid object turns the difference of two contacts in its frame into that in the palm frame.

    Distances and angles follow from that; saying so helps to prune.

    Args:
        builder: of the system.
        name: prefix of new variables.
        a: one contact.
        b: the other.
        R: columns of the object's rotation.
        decides: whether this is required; else it follows from other pairs.
    """
    D = [builder.form(f"{name} D{i}", x) for i, x in enumerate(difference(a.in_palm, b.in_palm))]
    d = [builder.form(f"{name} d{i}", x) for i, x in enumerate(difference(a.in_object, b.in_object))]
    turned = combine(d, R)
    for i in range(3):
        (builder.equate if decides else builder.imply)(turned[i] - D[i])
        builder.imply(dot(R[i], D) - d[i])
    builder.imply(dot(D, D) - dot(d, d))
    builder.imply(dot(a.n_palm, b.n_palm) - dot(a.n_object, b.n_object))
    for side in (a, b):
        builder.imply(dot(side.n_palm, D) - dot(side.n_object, d))
