"""What the touches of a given grasp can carry: forces within friction that balance the object's weight."""

from collections.abc import Sequence
from typing import NamedTuple

from ...geometry import even_directions
from ...hands import Hand
from ...mjcf import HoldSettings
from ...objects import ObjectModel
from ...objects.carrying import Places, carried_forces, least_multiple, object_load, usual_fingertip
from .measured import Measured, Touch

__all__ = ["Carried", "carried_multiples"]


class Carried(NamedTuple):
    """Multiples of the object's weight that fingers carry.

    Attributes:
        least: those that touch, however the object is turned.
        most: the same, as the object is turned best.
        closed: at least, were all fingers that are near to touch.
    """

    least: float
    most: float
    closed: float


def carried_multiples(
    hand: Hand, obj: ObjectModel, given: Measured, touches: Sequence[Touch], *, touched_alone: bool = False
) -> tuple[float, float]:
    """The multiple of the object's weight that these touches carry at least, and at most, as it is turned.

    Each presses with what a fingertip of the hand can, over all its places; 0 for less than two.

    Args:
        hand: the hand.
        obj: the object, in its size.
        given: the grasp.
        touches: those of its touches that press.
        touched_alone: whether only those parts of the object are to be carried that are touched, as where a
            lid is lifted off its pot.
    """
    if len(touches) < 2:
        return 0.0, 0.0
    parts = [obj.parts[i] for i in sorted({touch.part for touch in touches})] if touched_alone else None
    load, tip = object_load(obj, parts), usual_fingertip(hand)
    R, p = given.T_palm_object[:3, :3], given.T_palm_object[:3, 3]
    places = [Places((t.places - p) @ R, t.normals @ R, tip.force_N, tip.spin_arm_m) for t in touches]
    mu = HoldSettings().sliding_friction(obj)
    forces = carried_forces(places, load.centre, mu, even_directions(0))
    return least_multiple(forces, load.weight_N), float(forces.along.max()) / load.weight_N
