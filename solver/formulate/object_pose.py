"""The object's pose in the palm frame, as polynomials."""

from ..polynomial import SystemBuilder, Vector, combine, difference, dot
from .contact_equations import ContactSides
from .region_equations import UNIT_RANGE

__all__ = ["free_rotation", "hold_at", "place"]


def free_rotation(builder: SystemBuilder) -> list[Vector]:
    """Columns c, d, e of the object's rotation (paper, equations 4-7) with their redundant relatives."""
    columns = [[builder.variable(f"object R{i}{j}", *UNIT_RANGE) for i in range(3)] for j in range(2)]
    c, d = columns
    e = [
        builder.define(f"object R{i}2", c[j] * d[k] - c[k] * d[j], *UNIT_RANGE)
        for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
    ]
    builder.equate(dot(c, c) - 1.0)
    builder.equate(dot(d, d) - 1.0)
    builder.equate(dot(c, d))
    builder.imply(dot(e, e) - 1.0)
    builder.imply(dot(c, e))
    builder.imply(dot(d, e))
    rows = [[column[i] for column in (c, d, e)] for i in range(3)]
    for a in range(3):
        for b in range(a, 3):
            builder.imply(dot(rows[a], rows[b]) - (1.0 if a == b else 0.0))
    return [c, d, e]


def place(builder: SystemBuilder, R: list[Vector], contact: ContactSides) -> list[int]:
    """Defines the position of an object with rotation R: the bodies meet at the contact. Its 3 indices."""
    o = [builder.form(f"object o{i}", x) for i, x in enumerate(contact.in_object)]
    h = [builder.form(f"object h{i}", x) for i, x in enumerate(contact.in_palm)]
    for i, x in enumerate(difference(h, combine(o, R))):
        builder.define(f"object p{i}", x)
    return list(range(len(builder.names) - 3, len(builder.names)))


def hold_at(builder: SystemBuilder, R: list[Vector], p: Vector, contact: ContactSides) -> None:
    """Both bodies meet at a contact of an object at a fixed pose."""
    meets = difference(contact.in_palm, combine(contact.in_object, R))
    for gap in difference(meets, p):
        builder.equate(gap)
