"""Where the contacts of a task are, and their normals, in balls: over all states near one."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..geometry import Cap, Patch, Region
from ..objects import Task
from ..solver import SolutionRadii, State
from ..solver.interval import Balls
from .true_links import TrueLinks, true_links

__all__ = ["TrueContacts", "TruePlaces", "true_contacts", "true_places"]


@dataclass(frozen=True, eq=False)
class TruePlaces:
    """Hand and object over all states within radii of one.

    Attributes:
        links: of the hand.
        R: rotation (3, 3) of the object.
        p: its position (3,) in m.
        params: patch parameters (n_params,).
    """

    links: TrueLinks
    R: Balls
    p: Balls
    params: Balls


@dataclass(frozen=True, eq=False)
class TrueContacts:
    """Enclosures of the n contacts of a task, in the palm frame.

    Attributes:
        p_object: points (n, 3) of the object in m.
        p_hand: points (n, 3) of the hand, which at a solution are the same.
        inward: unit normals (n, 3) into the object.
    """

    p_object: Balls
    p_hand: Balls
    inward: Balls


def true_places(task: Task, state: State, radii: SolutionRadii) -> TruePlaces:
    """Hand and object at all states within `radii` of a state."""
    return TruePlaces(
        true_links(task.hand, Balls.within(state.q, radii.joints)),
        Balls.within(state.R_palm_object, radii.rotation),
        Balls.within(state.p_palm_object, radii.position),
        Balls.within(state.params, radii.parameters),
    )


def true_contacts(task: Task, at: TruePlaces) -> TrueContacts:
    """The contacts, each with the normal that the contact equations give it.

    That is the object's, where its region is no cap; else the hand's; and between two caps it is along the
    line of their centres.
    """
    on_object, on_hand, inward = [], [], []
    first = 0
    for contact in task.contacts:
        sides = []
        for region, R, p in (
            (
                contact.hand.region,
                at.links.rotations[contact.hand.link],
                at.links.positions[contact.hand.link],
            ),
            (contact.object.region, at.R, at.p),
        ):
            point, normal = _in_body(region, at.params[first : first + 2])
            first += 2 if isinstance(region, Patch) else 0
            sides.append((R @ point + p, None if normal is None else R @ normal))
        (h, n_hand), (o, n_object) = sides
        n = -n_object if n_object is not None else n_hand if n_hand is not None else (o - h).unit()
        on_object.append(o - n * _radius(contact.object.region))
        on_hand.append(h + n * _radius(contact.hand.region))
        inward.append(n)
    return TrueContacts(Balls.stack(on_object), Balls.stack(on_hand), Balls.stack(inward))


def _radius(region: Region) -> float:
    return region.radius if isinstance(region, Cap) else 0.0


def _in_body(region: Region, params: Balls) -> tuple[Balls, Balls | None]:
    """Point (3,) of a region, of a cap its centre, and its unit normal (3,), of a cap none."""
    match region:
        case Cap():
            return Balls.exact(region.centre), None
        case Patch():
            return _on_patch(region.patch.control_points, params)
    return Balls.exact(region.point), Balls.exact(region.normal).unit()


def _on_patch(control_points: Array, params: Balls) -> tuple[Balls, Balls]:
    """Point and unit normal of a Bezier patch with control points (m + 1, n + 1, 3)."""
    net = Balls.exact(control_points)
    u, v = params[0], params[1]
    first, second = (_slopes(axis_net) for axis_net in (net, _exchanged(net)))
    point = _evaluate(net, u, v)
    normal = _evaluate(first, u, v).cross(_evaluate(_exchanged(second), u, v))
    return point, normal.unit()


def _exchanged(net: Balls) -> Balls:
    return Balls(np.swapaxes(net.mid, 0, 1), np.swapaxes(net.rad, 0, 1))


def _slopes(net: Balls) -> Balls:
    """Control points of the derivative along axis 0; of what is constant there, zero."""
    degree = net.shape[0] - 1
    return (net[1:] - net[:-1]) * float(degree) if degree else net * 0.0


def _evaluate(net: Balls, u: Balls, v: Balls) -> Balls:
    """De Casteljau's rule along both axes."""
    for t in (u, v):
        while net.shape[0] > 1:
            net = net[:-1] * (1.0 - t) + net[1:] * t
        net = net[0]
    return net
