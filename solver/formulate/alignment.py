"""Normals of hand and object that are opposed, exactly or within a stated angle."""

from dataclasses import dataclass

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import Patch, perpendicular, region_normal
from ...objects import Contact
from ..polynomial import Polynomial, SystemBuilder, Vector, constant_vector, dot, total
from .link_frames import PolynomialFrame
from .region_equations import Surface, index_of

__all__ = ["Facing", "oppose", "rotate"]

# Bounds that follow from others, widened by this so that rounding can't make them cut.
_ROUNDING = 1e-12


@dataclass(frozen=True)
class Facing:
    """The object's side of a contact.

    Attributes:
        surface: its region.
        R: columns of the object's rotation.
        N: its unit normal in the palm frame.
    """

    surface: Surface
    R: list[Vector]
    N: Vector


def rotate(builder: SystemBuilder, name: str, columns: list[Vector], v: Vector) -> Vector:
    """The vector turned by the rotation with these columns, its products with forms as factors."""
    return [total(builder.product(f"{name}{i}{j}", columns[j][i], v[j]) for j in range(3)) for i in range(3)]


def oppose(
    builder: SystemBuilder,
    name: str,
    frame: PolynomialFrame,
    surface: Surface,
    other: Facing,
    contact: Contact,
) -> list[int]:
    """A hand patch or point faces against the object's normal, within the contact's room.

    Args:
        builder: of the system.
        name: prefix of new variables.
        frame: of the hand's link.
        surface: the hand's side.
        other: the object's.
        contact: says how much room the normals have.

    Returns:
        Indices of the variables whose squares add up to that of the sine between the normals, at most; none
        where they are exactly opposed.
    """
    columns, _ = frame.as_variables()
    assert surface.normal is not None
    if contact.align_within_rad > 0.0:
        return _oppose_within(builder, name, columns, surface, other, contact)
    along = [
        dot(_turned(builder, f"{name} t{k}", columns, t), other.N) for k, t in enumerate(surface.tangents)
    ]
    m = _turned(builder, f"{name} m", columns, surface.normal)
    if _is_pad_on_rulings(contact, other.surface):
        # Pads on parallel rulings of a can: its tangents give one and the same row, which presolve drops.
        # Those of the pads would give rows that depend on each other, but not so that anyone could see it.
        for k, tangent in enumerate(other.surface.tangents):
            builder.equate(dot(_turned(builder, f"{name} T{k}", other.R, _scaled(tangent)), m))
        for row in along:
            builder.imply(row)
    else:
        for row in along:
            builder.equate(row)
    for i in range(3):
        builder.imply(m[i] + other.N[i])
    builder.at_least_zero(-dot(m, other.N))
    return []


def _oppose_within(
    builder: SystemBuilder,
    name: str,
    columns: list[Vector],
    surface: Surface,
    other: Facing,
    contact: Contact,
) -> list[int]:
    """The angle between the hand's normal m and -N is at most the room d: |m x N| <= sin d, m.N < 0."""
    room, N = contact.align_within_rad, other.N
    sine = float(np.nextafter(np.sin(room), 1.0))
    m = _turned(builder, f"{name} m", columns, surface.normal or [])
    flat = region_normal(contact.hand.region)
    if flat is not None:
        tangents = [
            _turned(builder, f"{name} t{k}", columns, constant_vector(t))
            for k, t in enumerate(perpendicular(flat))
        ]
        values = [dot(t, N) for t in tangents]
    else:
        values = [m[b] * N[c] - m[c] * N[b] for b, c in ((1, 2), (2, 0), (0, 1))]
    sines = [_bounded(builder, f"{name} sine{k}", value, sine) for k, value in enumerate(values)]
    builder.at_least_zero(sine * sine - total(x * x for x in sines))
    builder.at_least_zero(-dot(m, N) - (float(np.cos(room)) - _ROUNDING))
    # What follows helps to prune. m + N is as long as the chord of the angle.
    chord = 2.0 * float(np.sin(0.5 * room)) + _ROUNDING
    for i in range(3):
        _within(builder, m[i] + N[i], chord)
    if isinstance(contact.object.region, Patch) and region_normal(contact.object.region) is None:
        patch = contact.object.region.patch
        for k, (tangent, net) in enumerate(
            zip(other.surface.tangents, (patch.du.control_points, patch.dv.control_points), strict=True)
        ):
            longest = float(np.linalg.norm(net / np.abs(net).max(), axis=-1).max())
            turned = _turned(builder, f"{name} T{k}", other.R, tangent)
            _within(builder, dot(turned, m), sine * longest * (1.0 + 1e-9) + _ROUNDING)
    return [index_of(x) for x in sines]


def _is_pad_on_rulings(contact: Contact, surface: Surface) -> bool:
    """Whether a flat region of the hand meets a curved patch with straight lines that are all parallel."""
    is_pad = region_normal(contact.hand.region) is not None and region_normal(contact.object.region) is None
    return is_pad and any(not any(x.degree for x in tangent) for tangent in surface.tangents)


def _turned(builder: SystemBuilder, name: str, columns: list[Vector], v: Vector) -> Vector:
    """A vector in the palm frame, its entries as variables."""
    return [builder.form(f"{name}{i}", x) for i, x in enumerate(rotate(builder, name, columns, v))]


def _bounded(builder: SystemBuilder, name: str, value: Polynomial, most: float) -> Polynomial:
    """A variable that equals `value`, in [-most, most]."""
    variable = builder.define(name, value, -most, most)
    i = index_of(variable)
    # Another contact may have defined it already.
    builder.lower[i], builder.upper[i] = max(builder.lower[i], -most), min(builder.upper[i], most)
    return variable


def _within(builder: SystemBuilder, value: Polynomial, most: float) -> None:
    builder.at_least_zero(value + most)
    builder.at_least_zero(most - value)


def _scaled(tangent: Vector) -> Vector:
    """A tangent that is the same everywhere at unit length; others as they are."""
    if any(x.degree for x in tangent):
        return tangent
    v: Array = np.array([x.terms.get((), 0.0) for x in tangent])
    return constant_vector(v / np.linalg.norm(v))
