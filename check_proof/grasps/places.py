"""Where hand, object and contacts are, of numbers of either kind (`spans`)."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from .form import Form, Region
from .spans import Spans, cross, dot, matmul, matvec, stack, unit

__all__ = [
    "Contact",
    "Frames",
    "contacts_of",
    "evaluate",
    "exchanged",
    "frames_of",
    "slopes",
    "turn_of_quaternion",
]


@dataclass(frozen=True, eq=False)
class Frames:
    """Links and joint axes in the palm frame, by link and by joint.

    Attributes:
        rotations: (3, 3) of each link.
        positions: (3,) of each link, in m.
        origins: (3,) a point of each joint's axis.
        directions: (3,) unit vectors along them.
    """

    rotations: list[Any]
    positions: list[Any]
    origins: list[Any]
    directions: list[Any]


@dataclass(frozen=True, eq=False)
class Contact:
    """One contact.

    Attributes:
        p_object: point (3,) of the object.
        p_hand: point (3,) of the hand.
        inward: unit normal (3,) into the object.
        n_hand: unit outward normal (3,) of the hand; None of a cap.
        tangents: two vectors (3,) of the object's surface; none of a cap.
        misses: what is zero where the bodies meet: three numbers, or between two caps one.
    """

    p_object: Any
    p_hand: Any
    inward: Any
    n_hand: Any
    tangents: list[Any]
    misses: list[Any]


def frames_of(form: Form, q: Any) -> Frames:
    """The hand at independent joints q (n_independent,)."""
    rotations: list[Any] = []
    positions: list[Any] = []
    origins, directions = [], []
    k = 0
    for link in form.links:
        R, p = link.rotation, link.position
        if link.parent >= 0:
            parent = rotations[link.parent]
            R, p = matmul(parent, R), matvec(parent, p) + positions[link.parent]
        for slides in link.slides:
            axis = unit(form.directions[k])
            along = matvec(R, axis)
            origins.append(p)
            directions.append(along)
            j, ratio, offset = form.drives[k]
            angle = q[j] * ratio + offset
            if slides:
                p = p + along * angle[None]
            else:
                cosine, sine = angle.cosine_and_sine()
                R = matmul(R, _turn(axis, cosine, sine))
            k += 1
        rotations.append(R)
        positions.append(p)
    return Frames(rotations, positions, origins, directions)


def _turn(axis: Any, cosine: Any, sine: Any) -> Any:
    """The rotation about a unit axis."""
    rest = 1.0 - cosine
    rows = []
    for i in range(3):
        row = []
        for j in range(3):
            entry = rest * (axis[i] * axis[j])
            if i == j:
                entry = entry + cosine
            else:
                k = 3 - i - j
                sign = 1.0 if (i - j) % 3 == 1 else -1.0
                entry = entry + sine * axis[k] * sign
            row.append(entry)
        rows.append(stack(row))
    return stack(rows)


def turn_of_quaternion(quaternion: Any) -> Any:
    """The rotation of a quaternion w, x, y, z of any length but zero."""
    scale = dot(quaternion, quaternion).inverse() * 2.0
    w, x, y, z = (quaternion[k] for k in range(4))
    return stack(
        [
            stack([1.0 - scale * (y * y + z * z), scale * (x * y - w * z), scale * (x * z + w * y)]),
            stack([scale * (x * y + w * z), 1.0 - scale * (x * x + z * z), scale * (y * z - w * x)]),
            stack([scale * (x * z - w * y), scale * (y * z + w * x), 1.0 - scale * (x * x + y * y)]),
        ]
    )


def contacts_of(form: Form, frames: Frames, R: Any, p: Any, params: Any) -> list[Contact]:
    """The contacts, where the object is turned by R (3, 3) and at p (3,)."""
    out, first = [], 0
    for contact in form.contacts:
        sides = []
        for region, turn, place in (
            (contact.hand, frames.rotations[contact.link], frames.positions[contact.link]),
            (contact.object, R, p),
        ):
            point, normal, tangents = _in_body(region, params[first : first + 2])
            first += 2 if region.kind == "patch" else 0
            moved = [None if v is None else matvec(turn, v) for v in (normal, *tangents)]
            sides.append((matvec(turn, point) + place, moved[0], moved[1:]))
        (h, n_hand, _), (o, n_object, tangents) = sides
        r_hand, r_object = contact.hand.radius, contact.object.radius
        if n_object is not None:
            inward = -n_object
        elif n_hand is not None:
            inward = n_hand
        else:
            inward = unit(o - h)
        on_object, on_hand = o - inward * r_object, h + inward * r_hand
        if n_object is None and n_hand is None:
            apart = o - h
            reach = Spans.of(r_hand) + r_object
            misses = [dot(apart, apart) - reach * reach]
        else:
            gap = on_object - on_hand
            misses = [gap[k] for k in range(3)]
        out.append(Contact(on_object, on_hand, inward, n_hand, tangents, misses))
    return out


def _in_body(region: Region, params: Any) -> tuple[Any, Any, list[Any]]:
    """Point, unit normal and tangents in the frame of the body; of a cap the centre and nothing more."""
    if region.kind == "cap":
        return region.point, None, []
    if region.kind == "point":
        normal = unit(region.normal)
        aside = np.eye(3)[int(np.argmin(normal.most))]
        first = cross(normal, Spans.of(aside))
        return region.point, normal, [first, cross(normal, first)]
    net = region.net
    u, v = params[0], params[1]
    point = evaluate(net, u, v)
    t_u = evaluate(slopes(net), u, v)
    t_v = evaluate(exchanged(slopes(exchanged(net))), u, v)
    return point, unit(cross(t_u, t_v)), [t_u, t_v]


def slopes(net: Any) -> Any:
    """Control points of the derivative along the first axis."""
    degree = net.lo.shape[0] - 1
    return (net[1:] - net[:-1]) * float(degree) if degree else net * 0.0


def exchanged(net: Any) -> Any:
    """A net with its axes exchanged."""
    return type(net)(np.swapaxes(net.lo, 0, 1), np.swapaxes(net.hi, 0, 1))


def evaluate(net: Any, u: Any, v: Any) -> Any:
    """The point of a Bezier net (m + 1, n + 1, 3), by de Casteljau's rule."""
    for t in (u, v):
        rows = [net[i] for i in range(_length(net))]
        while len(rows) > 1:
            rows = [a + (b - a) * t for a, b in pairwise(rows)]
        net = rows[0]
    return net


def _length(net: Any) -> int:
    values = net.value if hasattr(net, "value") else net
    return int(values.lo.shape[0])
