"""Flat pads that no posture can lay on the object's flat faces, and the room that would let them."""

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import region_normal
from ...objects import Task
from ..contacts import ContactManifold, ContactPoint, State

__all__ = ["PadMisfit", "pad_misfits"]

# Postures in which the pads are compared.
_POSTURES = 8
# Pads that turn against each other by less than this (rad) don't turn.
_STIFF = 1e-9
# The stated room lies above what is needed by this share, or so many degrees.
_ABOVE, _STEP_DEG = 1.01, 1e-3


@dataclass(frozen=True)
class PadMisfit:
    """Two flat pads that stand at the same angle in every posture, and faces that stand at another one.

    Attributes:
        hand: names of the two regions of the hand.
        object: those of the object.
        hand_deg: angle between the normals of the pads.
        object_deg: between those of the faces.
    """

    hand: tuple[str, ...]
    object: tuple[str, ...]
    hand_deg: float
    object_deg: float

    @property
    def room_deg(self) -> float:
        """An `align_within_deg` of both contacts that is large enough, three digits after the point."""
        half = 0.5 * abs(self.hand_deg - self.object_deg)
        return float(np.ceil(_ABOVE * half / _STEP_DEG) * _STEP_DEG)

    def __str__(self) -> str:
        pads, faces = " and ".join(self.hand), " and ".join(self.object)
        return (
            f"{pads} stand {self.hand_deg:.6g} deg apart in every posture, "
            f"{faces} {self.object_deg:.6g} deg: align_within_deg: {self.room_deg:.4g} would do"
        )


def pad_misfits(task: Task) -> tuple[PadMisfit, ...]:
    """Pairs of flat contacts whose normals can't be opposed within their room, by postures tried at random.

    Whether pads turn against each other is judged by some postures; so this explains, and proves nothing.
    """
    flat = [
        k
        for k, contact in enumerate(task.contacts)
        if region_normal(contact.hand.region) is not None and region_normal(contact.object.region) is not None
    ]
    postures = _postures(task) if len(flat) > 1 else []
    found = []
    for a, b in combinations(flat, 2):
        angles = [_angle(points[a].n_hand, points[b].n_hand) for points in postures]
        if np.ptp(angles) > _STIFF:
            continue
        faces = _angle(postures[0][a].n_object, postures[0][b].n_object)
        pair = task.contacts[a], task.contacts[b]
        if abs(angles[0] - faces) > sum(contact.align_within_rad for contact in pair) + _STIFF:
            hand, obj = [c.hand.name for c in pair], [c.object.name for c in pair]
            found.append(PadMisfit(tuple(hand), tuple(obj), *np.rad2deg([angles[0], faces]).tolist()))
    return tuple(found)


def _postures(task: Task) -> list[list[ContactPoint]]:
    """The contacts in some postures, with the object at the palm's origin."""
    manifold, rng = ContactManifold(task), np.random.default_rng(0)
    params = np.full(manifold.n_params, 0.5)
    return [
        manifold.contact_points(State(q, np.eye(3), np.zeros(3), params))
        for q in rng.uniform(task.limits[:, 0], task.limits[:, 1], (_POSTURES, manifold.n_q))
    ]


def _angle(a: Array, b: Array) -> float:
    return float(np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b))
