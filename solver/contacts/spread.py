"""How different configurations are: how far each is from its nearest neighbour, by several measures."""

from collections.abc import Sequence

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import Cap, Region, perpendicular
from ...hands import forward_kinematics
from .configuration import Configuration
from .distance import nearest_neighbours, nearest_rows
from .manifold import ContactManifold

__all__ = ["contact_coordinates", "spread"]


def contact_coordinates(configuration: Configuration, manifold: ContactManifold | None = None) -> Array:
    """Where the contacts lie in their regions, contact by contact, hand side first.

    Two numbers for each patch, u and v in [0, 1]; two for each cap, in the unit disc: the direction in which
    the contact lies from the cap's axis, as long as its angle is in half angles. None for a point.

    Args:
        configuration: the configuration.
        manifold: of its task, where it is at hand.
    """
    task, state = configuration.task, configuration.state
    coordinates = list(state.params)
    if not any(isinstance(side.region, Cap) for c in task.contacts for side in (c.hand, c.object)):
        return np.array(coordinates)
    frames = forward_kinematics(task.hand, configuration.joint_vector)
    points = (manifold or ContactManifold(task)).contact_points(state)
    for contact, point in zip(task.contacts, points, strict=True):
        R_palm_link = frames[contact.hand.link][:3, :3]
        coordinates += _on_cap(contact.hand.region, R_palm_link.T @ point.n_hand)
        coordinates += _on_cap(contact.object.region, state.R_palm_object.T @ point.n_object)
    return np.array(coordinates)


def _on_cap(region: Region, normal: Array) -> list[float]:
    if not isinstance(region, Cap):
        return []
    aside = perpendicular(region.axis) @ normal
    length = float(np.linalg.norm(aside))
    angle = float(np.arctan2(length, region.axis @ normal))
    return (aside / max(length, 1e-12) * (angle / region.half_angle_rad)).tolist()


def spread(configurations: Sequence[Configuration]) -> dict[str, float] | None:
    """Distances from configurations to their nearest neighbours; None for less than two.

    `smallest` and `median` are by `distance`; `joints_smallest` and `joints_median` by the largest joint
    difference (rad or m) alone; `contacts_smallest` and `contacts_median` by the largest difference of
    `contact_coordinates`.
    """
    if len(configurations) < 2:
        return None
    manifold = ContactManifold(configurations[0].task)
    contacts = np.array([contact_coordinates(c, manifold) for c in configurations])
    nearest = {
        "": nearest_neighbours([c.state for c in configurations]),
        "joints_": nearest_rows(np.array([c.state.q for c in configurations])),
        "contacts_": nearest_rows(contacts),
    }
    measures = (("smallest", np.min), ("median", np.median))
    return {f"{kind}{name}": float(f(d)) for kind, d in nearest.items() for name, f in measures}
