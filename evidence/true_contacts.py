"""Where the contacts of a task are, and their normals, in balls: over all states near one."""

from dataclasses import dataclass

from ..geometry import Cap, Patch, Region
from ..objects import Task
from ..solver import SolutionRadii, State, region_params
from ..solver.interval import Balls
from .true_links import TrueLinks, true_links
from .true_patches import point_and_normal

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
    for contact, (on_link, on_body) in zip(task.contacts, region_params(task), strict=True):
        sides = []
        for region, R, p, where in (
            (
                contact.hand.region,
                at.links.rotations[contact.hand.link],
                at.links.positions[contact.hand.link],
                on_link,
            ),
            (contact.object.region, at.R, at.p, on_body),
        ):
            point, normal = _in_body(region, at.params[where])
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
            return point_and_normal(region.patch.control_points, params)
    return Balls.exact(region.point), Balls.exact(region.normal).unit()
