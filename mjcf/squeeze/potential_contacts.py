"""Where hand and object are so near each other that they may touch in a test, named by the task or not."""

import numpy as np
from numpy.typing import NDArray

from ...objects import TurnTest
from ...retraction import CollisionModel, collision_model, measure
from ...solver import Configuration
from .statics import PointContact

__all__ = ["potential_contacts"]


def potential_contacts(configuration: Configuration, within_m: float) -> list[PointContact]:
    """Nearest points of all pieces of links and of what the hand moves that are `within_m` of each other.

    A link that can't move drives no turn, so these are left out of one.
    """
    task = configuration.task
    model = collision_model(task)
    gaps = measure(model.place(configuration.state), _hand_and_object(model))
    links = model.bodies.piece_body[gaps.pairs[:, 0]]
    is_near = gaps.distance_m <= within_m
    if isinstance(task.test, TurnTest):
        is_near &= task.hand.tree.moves[links].any(axis=1)
    return [
        PointContact(int(links[k]), gaps.p_a[k], gaps.p_b[k], gaps.normals[k])
        for k in np.flatnonzero(is_near)
    ]


def _hand_and_object(model: CollisionModel) -> NDArray[np.int64]:
    """Pairs (n, 2) of pieces of links and of the parts that the hand moves, or of all where it moves none."""
    task = model.task
    names = {f"object/{part.name}" for part in task.carried or task.object.parts}
    felt = [i for i, body in enumerate(model.bodies.bodies) if body.name in names]
    b = model.bodies.piece_body[model.piece_pairs[:, 1]]
    return model.piece_pairs[np.isin(b, felt)]
