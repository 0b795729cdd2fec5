"""Where forces may act on wide contacts beside their points: in the area of contact, at both bodies.

How large the area is, is the pad's model, whose numbers are the caller's. That each point lies in it, and so
near to the link and to the object as the pad yields, is shown here, wherever the solution is.
"""

from dataclasses import replace
from math import pi
from typing import Any

import numpy as np

from ...base.numeric.arrays import Indices
from ..intervals import down, up
from ..reading import Rejected, indices, items, numbers
from .form import Form, Pad, Region, field
from .places import Contact, Frames, evaluate, exchanged, slopes
from .spans import Spans, cross, dot, matmul, matvec, stack, unit

__all__ = ["force_points"]

# No honest file has more points.
_MOST_POINTS = 64


def force_points(
    form: Form,
    stable: dict[str, Any],
    settings: dict[str, Any],
    frames: Frames,
    R: Spans,
    p: Spans,
    params: Spans,
    contacts: list[Contact],
) -> tuple[list[Contact], Indices]:
    """All force points, those of the contacts first, and which contact each (m,) belongs to.

    Raises:
        Rejected: one may lie where no force is passed on.
    """
    written = items(stable.get("wide", []))
    if written and (field(form.test, "kind", str) == "press" or len(written) > _MOST_POINTS):
        raise Rejected("there are force points where none belong")
    points, owners = list(contacts), list(range(len(contacts)))
    for point in written:
        (i,) = indices([point.get("contact") if isinstance(point, dict) else None], len(contacts), 1).tolist()
        contact = contacts[i]
        offset = Spans.of(numbers(point.get("offset"), 3))
        d = offset - contact.inward * dot(contact.inward, offset)[None]
        K = _curvature(form, i, frames, R, params, contact)
        yields = _least_yield(form.pad, K)
        _check_area(form.pad, settings, K, yields, d)
        hand, thing = _piece(form, point.get("hand")), _piece(form, point.get("object"))
        pair = np.array([hand, thing])
        meet = (form.pairs == pair).all(axis=1) & form.intended
        if form.pieces[hand].link != form.contacts[i].link or not meet.any():
            raise Rejected("a force point is between other bodies")
        link = frames.rotations[form.contacts[i].link], frames.positions[form.contacts[i].link]
        for number, where, place, own in (
            (hand, point["hand"], link, contact.p_hand),
            (thing, point["object"], (R, p), contact.p_object),
        ):
            inside = matvec(place[0], _in_piece(form, number, where)) + place[1]
            if not _length(inside - (own + d)) <= yields + form.pieces[number].radius:
                raise Rejected("a force point may lie beside one of the bodies")
        points.append(replace(contact, p_object=contact.p_object + d, p_hand=contact.p_hand + d))
        owners.append(i)
    return points, np.array(owners, dtype=np.int64)


def _check_area(pad: Pad, settings: dict[str, Any], K: Spans, yields: float, d: Spans) -> None:
    """Raises Rejected where an offset d (3,) may lie outside the area."""
    limit = settings.get("rotation_limit_rad")
    turn = down(pad.turn_share * (pi if limit is None else float(numbers([limit], 1)[0])))
    tilt = matvec(K, d)
    sag, square = float(dot(d, tilt).hi), float(dot(d, d).hi)
    if not (
        _length(tilt) <= turn
        and sag <= 2.0 * yields
        and up(pad.flattest * square) <= 2.0 * yields
        and _length(d) <= pad.thickness
    ):
        raise Rejected("a force point may lie outside its contact's area")


def _piece(form: Form, where: Any) -> int:
    (number,) = indices([field({"where": where}, "where", dict).get("piece")], len(form.pieces), 1).tolist()
    return int(number)


def _in_piece(form: Form, number: int, where: dict[str, Any]) -> Spans:
    """A mixture (3,) of vertices of a piece, in the frame of its body."""
    core = form.pieces[number].core
    vertices = indices(where.get("vertices"), len(core))
    if not len(vertices):
        raise Rejected("a force point is at no vertex")
    weights = numbers(where.get("weights"), len(vertices) - 1)
    if (weights < 0.0).any() or not float(Spans.of(weights).sum(0).hi) <= 1.0:
        raise Rejected("a force point's weights are none")
    first = Spans.of(core[vertices[0]])
    out = first
    for weight, vertex in zip(weights.tolist(), vertices[1:].tolist(), strict=True):
        out = out + (Spans.of(core[vertex]) - first) * weight
    return out


def _length(v: Spans) -> float:
    """Above the length of a vector (3,)."""
    most = Spans.of(v.most)
    return float(dot(most, most).sqrt().hi)


def _least_yield(pad: Pad, K: Spans) -> float:
    """Below what the pad yields under its usual force on a relative curvature K (3, 3)."""
    trace = K[0, 0] + K[1, 1] + K[2, 2]
    squares = Spans.of(0.0)
    for i in range(3):
        squares = squares + dot(K[i], K[i])
    # (k1 - k2)^2 = 2 (k1^2 + k2^2) - (k1 + k2)^2
    apart = (squares * 2.0 - trace * trace).sqrt()
    least = [
        max(down(0.5 * down(float(trace.lo) - float(apart.hi))), pad.flattest),
        max(down(0.5 * down(float(trace.lo) + float(apart.lo))), pad.flattest),
    ]
    k1, k2 = (Spans.of(min(float(k), pad.sharpest)) for k in least)
    pressed = Spans.of(pad.usual_force) * pad.thickness * (Spans.around(pi, 1e-15) * pad.modulus).inverse()
    return float((pressed * (k1 * k2).sqrt()).sqrt().lo)


def _curvature(form: Form, i: int, frames: Frames, R: Spans, params: Spans, contact: Contact) -> Spans:
    """Relative curvature (3, 3) in the palm frame at a contact, in its tangent plane."""
    before = [side.kind for c in form.contacts[:i] for side in (c.hand, c.object)]
    first = 2 * before.count("patch")
    said = form.contacts[i]
    K = Spans.of(np.zeros((3, 3)))
    for region, turn in ((said.hand, frames.rotations[said.link]), (said.object, R)):
        own = _in_body(region, params[first : first + 2])
        K = K + matmul(matmul(turn, own), _transposed(turn))
        first += 2 if region.kind == "patch" else 0
    n = contact.inward
    across = Spans.of(np.eye(3)) - n[:, None] * n[None, :]
    return matmul(matmul(across, K), across)


def _transposed(A: Spans) -> Spans:
    return Spans(A.lo.T, A.hi.T)


def _in_body(region: Region, params: Spans) -> Spans:
    """The curvature (3, 3) of a region in its body, positive where it bends away from its outward normal."""
    if region.kind == "cap":
        return Spans.of(np.eye(3)) * Spans.of(region.radius).inverse()
    if region.kind == "point":
        return Spans.of(np.zeros((3, 3)))
    u, v = params[0], params[1]
    by_u, by_v = slopes(region.net), exchanged(slopes(exchanged(region.net)))
    t_u, t_v = evaluate(by_u, u, v), evaluate(by_v, u, v)
    n = unit(cross(t_u, t_v))
    uu = dot(evaluate(slopes(by_u), u, v), n)
    uv = dot(evaluate(slopes(by_v), u, v), n)
    vv = dot(evaluate(exchanged(slopes(exchanged(by_v))), u, v), n)
    # With E, F, G of the first fundamental form, (t_u, t_v) (E F; F G)^-1 are vectors dual to the tangents.
    E, F, G = dot(t_u, t_u), dot(t_u, t_v), dot(t_v, t_v)
    scale = (E * G - F * F).inverse()
    a = (t_u * G[None] - t_v * F[None]) * scale[None]
    b = (t_v * E[None] - t_u * F[None]) * scale[None]

    def entry(k: int, m: int) -> Any:
        mixed = a[k] * b[m] + b[k] * a[m]
        return -(uu * a[k] * a[m] + uv * mixed + vv * b[k] * b[m])

    return stack([stack([entry(k, m) for m in range(3)]) for k in range(3)])
