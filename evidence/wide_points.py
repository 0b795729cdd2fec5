"""Where forces may act on a wide contact beside its point: where both bodies are, in the area of contact.

Such a point is the contact's own moved along the true tangent plane. It lies within the contact's area
(`contact_areas`), wherever the true solution is, and there each of the two bodies, as its convex pieces have
it, is within what the pad yields of it: so nothing is said to press beside the edge of a link or a facet.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import nnls

from ..base.numeric.arrays import Array, Indices
from ..geometry import perpendicular
from ..mjcf.squeeze import contact_pads
from ..retraction import CollisionModel, collision_model
from ..solver import Configuration, State
from ..solver.interval import Balls
from .contact_areas import ContactAreas, length
from .true_contacts import TrueContacts, TruePlaces

__all__ = ["InBody", "WidePoint", "find_wide_points", "owners_of", "spread_over", "why_not_within"]

# So much closer to the contact's point than the area reaches, for rounding.
_INSIDE = 1.0 - 1e-7
# Where a body ends before the area does, points are drawn in by these.
_DRAWN_IN = (1.0, 0.75, 0.5, 0.3)
# Points that are then nearer than this add nothing to their contact's own.
_LEAST_M = 1e-3
# Weight of "shares add up to one" beside distances in m.
_TOGETHER_M = 10.0


@dataclass(frozen=True)
class InBody:
    """A point of a convex piece: a mixture of vertices of its core.

    Attributes:
        piece: number of the piece in the collision model.
        vertices: of its core.
        weights: of all but the first, which has what is left to one.
    """

    piece: int
    vertices: tuple[int, ...]
    weights: tuple[float, ...]


@dataclass(frozen=True)
class WidePoint:
    """A force point beside a contact's own.

    Attributes:
        contact: which contact it belongs to.
        offset_m: from the contact's point, in the palm frame; what counts is its part in the true tangent
            plane.
        in_hand: a point of the contact's link that is near.
        in_object: one of the part of the object.
    """

    contact: int
    offset_m: tuple[float, float, float]
    in_hand: InBody
    in_object: InBody


def owners_of(wide: tuple[WidePoint, ...], n_contacts: int) -> Indices:
    """The contact (m,) of each force point, those of the contacts first."""
    return np.array([*range(n_contacts), *(point.contact for point in wide)], dtype=np.int64)


def spread_over(contacts: TrueContacts, wide: tuple[WidePoint, ...]) -> TrueContacts:
    """All force points (m,), where they truly are."""
    if not wide:
        return contacts
    owner = [point.contact for point in wide]
    shift = Balls.stack([_tangential(contacts, point) for point in wide])

    def joined(own: Balls, beside: Balls) -> Balls:
        return Balls(np.concatenate([own.mid, beside.mid]), np.concatenate([own.rad, beside.rad]))

    return TrueContacts(
        joined(contacts.p_object, contacts.p_object[owner] + shift),
        joined(contacts.p_hand, contacts.p_hand[owner] + shift),
        joined(contacts.inward, contacts.inward[owner]),
    )


def why_not_within(areas: ContactAreas, wide: tuple[WidePoint, ...]) -> str:
    """Why force points may lie outside their contacts' areas or beside the bodies; empty where none does."""
    model, at, contacts = collision_model(areas.task), areas.at, areas.contacts
    for point in wide:
        area = areas[point.contact]
        d = _tangential(contacts, point)
        if not area.share(d) >= 1.0:
            return "a force point may lie outside its contact's area"
        for place, own in (
            (point.in_hand, contacts.p_hand[point.contact]),
            (point.in_object, contacts.p_object[point.contact]),
        ):
            if not _distance_m(model, at, place, own + d) <= area.yield_m:
                return "a force point may lie beside one of the bodies"
    return ""


def find_wide_points(areas: ContactAreas, state: State) -> tuple[WidePoint, ...]:
    """The points that a squeeze is planned with, drawn in where a body ends before its pad's area.

    Args:
        areas: of the contacts at a state, or at all states near it.
        state: of a configuration.
    """
    task, settings, at, contacts = areas.task, areas.settings, areas.at, areas.contacts
    configuration, n = Configuration(task, state, 0.0, None), len(task.contacts)
    planned = contact_pads(configuration, settings).force_points()
    tangents = [np.asarray(perpendicular(-point.n_object)) for point in configuration.contact_points]
    model = collision_model(task)
    found = []
    for i, along in zip(planned.contact[n:].tolist(), planned.offsets_m[n:], strict=True):
        area = areas[i]
        whole = along @ tangents[i]
        share = _INSIDE * min(1.0, area.share(_in_plane(contacts, i, whole)))
        for drawn_in in _DRAWN_IN:
            offset_m = share * drawn_in * whole
            where = contacts.p_object.mid[i] + offset_m
            bodies = [_nearest(model, at, body, where) for body in model.touching[i]]
            far_m = [_distance_m(model, at, place, Balls.exact(where)) for place in bodies]
            if max(far_m) <= _INSIDE * area.yield_m:
                break
        else:
            continue
        if np.linalg.norm(offset_m) >= _LEAST_M:
            x, y, z = offset_m.tolist()
            found.append(WidePoint(i, (x, y, z), *bodies))
    return tuple(found)


def _tangential(contacts: TrueContacts, point: WidePoint) -> Balls:
    return _in_plane(contacts, point.contact, np.array(point.offset_m))


def _in_plane(contacts: TrueContacts, i: int, offset_m: Array) -> Balls:
    """The part (3,) of an offset that lies in the true tangent plane of contact i."""
    n = contacts.inward[i]
    return offset_m - n * (n * offset_m).sum()


def _distance_m(model: CollisionModel, at: TruePlaces, place: InBody, x: Balls) -> float:
    """Above the distance in m of a point x (3,) in the palm frame from the piece of a place."""
    piece = model.bodies.pieces[place.piece]
    weights = np.array(place.weights)
    if (weights < 0.0).any() or not float(Balls.exact(weights).sum().upper) <= 1.0:
        return np.inf
    first, *rest = piece.core[list(place.vertices)]
    inside = Balls.exact(first)
    for weight, vertex in zip(weights.tolist(), rest, strict=True):
        inside = inside + weight * (Balls.exact(vertex) - first)
    R, p = _placed(model, at, int(model.bodies.piece_body[place.piece]))
    return float(np.nextafter(max(length(R @ inside + p - x) - piece.radius, 0.0), np.inf))


def _nearest(model: CollisionModel, at: TruePlaces, body: int, where: Array) -> InBody:
    """About that point of a body which is nearest to one (3,) in the palm frame."""
    R, p = _placed(model, at, body)
    x = (where - p.mid) @ R.mid
    numbers = np.flatnonzero(model.bodies.piece_body == body).tolist()
    bounds = [_least_distance(model, k, x) for k in numbers]
    nearest: tuple[float, InBody] | None = None
    for k in np.argsort(bounds).tolist():
        if nearest is None or bounds[k] < nearest[0]:
            found = _nearest_in(model, numbers[k], x)
            nearest = found if nearest is None or found[0] < nearest[0] else nearest
    assert nearest is not None, "a body has pieces"
    return nearest[1]


def _least_distance(model: CollisionModel, number: int, x: Array) -> float:
    """A piece is no nearer to a point (3,) in the frame of its body: the distance of a box around it."""
    piece = model.bodies.pieces[number]
    beside = np.maximum(piece.core.min(axis=0) - x, x - piece.core.max(axis=0))
    return float(np.linalg.norm(np.maximum(beside, 0.0))) - piece.radius


def _nearest_in(model: CollisionModel, number: int, x: Array) -> tuple[float, InBody]:
    """About the distance from a piece to a point (3,) in the frame of its body, and where that is."""
    piece = model.bodies.pieces[number]
    rows = np.vstack([(piece.core - x).T, np.full(len(piece.core), _TOGETHER_M)])
    weights, _ = nnls(rows, np.array([0.0, 0.0, 0.0, _TOGETHER_M]))
    weights /= weights.sum()
    distance = max(float(np.linalg.norm(weights @ piece.core - x)) - piece.radius, 0.0)
    order = np.argsort(-weights)[: max(1, int((weights > 0.0).sum()))]
    # A hair less of the others, so that they surely don't add up to more than one.
    others = (weights[order[1:]] * (1.0 - 1e-12)).tolist()
    return distance, InBody(number, tuple(order.tolist()), tuple(others))


def _placed(model: CollisionModel, at: TruePlaces, body: int) -> tuple[Balls, Balls]:
    """Rotation (3, 3) and position (3,) of a body."""
    link = model.bodies.bodies[body].link
    return (at.R, at.p) if link is None else (at.links.rotations[link], at.links.positions[link])
