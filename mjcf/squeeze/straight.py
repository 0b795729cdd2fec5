"""Servo targets that lead each fingertip straight along its normal, by as much as its pad yields.

A pad gives way by a millimetre or two, and the joints follow. Where they just go on as their efforts push
them, the tips also go sideways, and friction takes the object along. So the place q* is found at which every
tip has moved inwards by its pad's yield and not sideways, the object staying where it is; the targets are
q* + T(q*) f / k, with the efforts of the planned forces f there.

A link that can't follow, such as the palm, can only be met by the object: its motion is an unknown as well,
at a price that makes it the last resort. The equations are solved by Gauss-Newton in the sense of least
squares.
"""

from dataclasses import dataclass

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import invert, perpendicular, skew
from ...hands import jacobian_from_axes, joint_axes
from ...solver import Configuration
from .statics import ForcePoints, PointContact, Statics, contact_efforts, spread_out, task_contacts

__all__ = ["straight_targets"]

_STEPS = 3
# Sideways motion of a tip counts for so much of motion along the normal.
_SIDEWAYS = 0.5
# A metre by which the object moves costs as much as 1000 rad of a joint, a radian as much as 100.
_OBJECT_M, _OBJECT_RAD = 1e-3, 1e-2
# Directions in which the contacts hardly move are left alone.
_CUTOFF = 1e-4
# No pad asks a joint for more; a singular finger might.
_LARGEST_RAD = 0.3


@dataclass(frozen=True, eq=False)
class _Tip:
    """A contact and where its point is on its link (3,), in the link's frame."""

    contact: PointContact
    p_link: Array

    @classmethod
    def of(cls, contact: PointContact, links: Array) -> "_Tip":
        """That of a contact, with the links (n_links, 4, 4) where they are in the grasp."""
        return cls(contact, (invert(links[contact.link]) @ np.append(contact.p_hand, 1.0))[:3])

    def placed(self, links: Array) -> Array:
        """The point (3,) in the palm frame, with the links (n_links, 4, 4) where they are."""
        T = links[self.contact.link]
        return T[:3, :3] @ self.p_link + T[:3, 3]


def straight_targets(
    configuration: Configuration,
    statics: Statics,
    contact_vector: Array,
    yields_m: Array,
    centres_m: Array,
) -> tuple[Array, Array]:
    """Efforts and servo targets, each (n_independent,), for planned forces.

    Args:
        configuration: the grasp.
        statics: its linear maps.
        contact_vector: planned forces and torques (n, 4).
        yields_m: how far each pad yields (n,) under them.
        centres_m: where on each contact they act (n, 2), along its tangents.
    """
    hand = configuration.task.hand
    links, _, _ = joint_axes(hand, configuration.joint_vector)
    contacts = task_contacts(configuration)
    tips = [_Tip.of(contact, links) for contact in contacts]
    q = configuration.state.q + _inward(configuration, statics.centre, tips, yields_m)
    pressed = spread_out(contacts, ForcePoints(np.arange(len(contacts)), centres_m))
    T = _efforts(configuration, q, [_Tip.of(contact, links) for contact in pressed], statics)
    efforts = T @ contact_vector.ravel()
    return efforts, q + efforts / statics.stiffness


def _inward(configuration: Configuration, centre: Array, tips: list[_Tip], yields_m: Array) -> Array:
    """Change (n_independent,) of the joints that leads the tips inwards."""
    hand, start = configuration.task.hand, configuration.state.q
    prices = np.concatenate([np.ones(len(start)), np.full(3, _OBJECT_M), np.full(3, _OBJECT_RAD)])
    dq = np.zeros(len(start))
    for _ in range(_STEPS):
        links, origins, directions = joint_axes(hand, hand.expand(start + dq))
        rows, wishes = [], []
        for tip, yield_m in zip(tips, yields_m, strict=True):
            contact = tip.contact
            p = tip.placed(links)
            J_p = jacobian_from_axes(hand, origins, directions, contact.link, p)[0] @ hand.coupling_matrix
            arm = contact.p_object - centre
            follows = np.hstack([J_p, -np.eye(3), skew(arm)])
            weights = np.vstack([contact.inward, _SIDEWAYS * perpendicular(contact.inward)])
            rows.append(weights @ follows)
            wishes.append(weights @ (contact.p_hand + yield_m * contact.inward - p + J_p @ dq))
        step = np.linalg.lstsq(np.vstack(rows) * prices, np.concatenate(wishes), rcond=_CUTOFF)[0]
        dq = np.clip((step * prices)[: len(start)], -_LARGEST_RAD, _LARGEST_RAD)
    return dq


def _efforts(configuration: Configuration, q: Array, tips: list[_Tip], statics: Statics) -> Array:
    """The map T (n_independent, 4 n) of `Statics` with the joints at `q` and the frames as they are."""
    hand = configuration.task.hand
    links, origins, directions = joint_axes(hand, hand.expand(q))
    columns = [
        contact_efforts(hand, (origins, directions), tip.contact.link, tip.placed(links), frame)
        for tip, frame in zip(tips, statics.frames[: len(tips)], strict=True)
    ]
    return np.column_stack(columns)
