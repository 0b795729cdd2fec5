"""How far configurations are apart, and how far each is from its nearest neighbour."""

from collections.abc import Sequence

import numpy as np

from ...arrays import Array
from ...geometry import Cap, Region, perpendicular, rotation_angle
from ...hands import forward_kinematics
from .configuration import Configuration
from .state import State

__all__ = ["contact_coordinates", "distance", "nearest_neighbours", "spread", "spread_out"]

# A shift of the object by so much weighs as much as a turn by one radian.
SHIFT_M = 0.1


def distance(a: State, b: State) -> float:
    """How far two states are apart: the largest of joint difference (rad), turn (rad) and shift / 0.1 m."""
    joints = float(np.abs(a.q - b.q).max(initial=0.0))
    turn = rotation_angle(a.R_palm_object.T @ b.R_palm_object)
    shift = float(np.linalg.norm(a.p_palm_object - b.p_palm_object)) / SHIFT_M
    return max(joints, turn, shift)


class _Distances:
    """Distances, by `distance`, from one of many states to all of them."""

    def __init__(self, states: Sequence[State]):
        self._q = np.array([s.q for s in states])
        self._R = np.array([s.R_palm_object.ravel() for s in states])
        self._p = np.array([s.p_palm_object for s in states]) / SHIFT_M

    def of(self, k: int) -> Array:
        """From number k, (n,)."""
        chord = np.linalg.norm(self._R - self._R[k], axis=1)
        turn = 2.0 * np.arcsin(np.minimum(chord / np.sqrt(8.0), 1.0))
        shift = np.linalg.norm(self._p - self._p[k], axis=1)
        joints = np.abs(self._q - self._q[k]).max(axis=1, initial=0.0)
        return np.maximum(np.maximum(turn, shift), joints)


def nearest_neighbours(states: Sequence[State]) -> Array:
    """Distance (n,) from each of two or more states to the one nearest to it, by `distance`."""
    distances = _Distances(states)
    nearest = np.empty(len(states))
    for k in range(len(states)):
        apart = distances.of(k)
        apart[k] = np.inf
        nearest[k] = apart.min()
    return nearest


def spread_out(configurations: Sequence[Configuration], count: int) -> list[Configuration]:
    """So many of the configurations, far apart: the first, then always the one farthest from those chosen."""
    if len(configurations) <= count:
        return list(configurations)
    distances = _Distances([c.state for c in configurations])
    chosen = [0]
    nearest = distances.of(0)
    while len(chosen) < count:
        chosen.append(int(np.argmax(nearest)))
        nearest = np.minimum(nearest, distances.of(chosen[-1]))
    return [configurations[k] for k in chosen]


def contact_coordinates(configuration: Configuration) -> Array:
    """Where the contacts lie in their regions, contact by contact, hand side first.

    Two numbers for each patch, u and v in [0, 1]; two for each cap, in the unit disc: the direction in which
    the contact lies from the cap's axis, as long as its angle is in half angles. None for a point.
    """
    task, state = configuration.task, configuration.state
    frames = forward_kinematics(task.hand, configuration.joint_vector)
    coordinates = list(state.params)
    for contact, point in zip(task.contacts, configuration.contact_points, strict=True):
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
    nearest = {
        "": nearest_neighbours([c.state for c in configurations]),
        "joints_": _nearest_rows(np.array([c.state.q for c in configurations])),
        "contacts_": _nearest_rows(np.array([contact_coordinates(c) for c in configurations])),
    }
    measures = (("smallest", np.min), ("median", np.median))
    return {f"{kind}{name}": float(f(d)) for kind, d in nearest.items() for name, f in measures}


def _nearest_rows(rows: Array) -> Array:
    nearest = np.empty(len(rows))
    for k in range(len(rows)):
        apart = np.abs(rows - rows[k]).max(axis=1, initial=0.0)
        apart[k] = np.inf
        nearest[k] = apart.min()
    return nearest
