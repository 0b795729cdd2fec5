"""How far any point of a body can get when the joints move: the ground of collision checks without gaps.

With every joint k moving by dq_k in a straight line in joint space, no point of a link travels further than
the sum of |dq_k| R_k over the joints that move it, where R_k is the greatest distance that the joint's axis
ever has to the link's points. After Schwarzer, Saha & Latombe, "Adaptive dynamic collision checking for
single and multiple articulated robots in complex environments" (IEEE T-RO 2005).
"""

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ..base.numeric.arrays import Array, offsets
from ..hands import Hand
from ..objects import Task
from .pairs import CollisionModel, collision_model

__all__ = ["carried_together", "motion_bounds"]


@lru_cache(maxsize=16)
def motion_bounds(task: Task) -> Array:
    """Bounds (n_pairs_of_pieces, n_joints), in m per rad (or per m), of relative motion.

    With the object held still and the joint vector moving by dq, the distance of pair k of pieces of
    `collision_model(task)` changes by at most bounds[k] @ |dq|. Joints that carry both bodies do not count.
    """
    model, hand = collision_model(task), task.hand
    of_piece = np.array([_piece_bounds(hand, model, i) for i in range(len(model.bodies.pieces))])
    moves = np.array([_moves(hand, model, i) for i in range(len(model.bodies.pieces))])
    a, b = model.piece_pairs.T
    return np.where(moves[a] != moves[b], of_piece[a] + of_piece[b], 0.0)


@lru_cache(maxsize=16)
def carried_together(task: Task) -> NDArray[np.bool_]:
    """Which joints (n_pairs_of_pieces, n_joints) carry both pieces of each pair."""
    model = collision_model(task)
    moves = np.array([_moves(task.hand, model, i) for i in range(len(model.bodies.pieces))])
    a, b = model.piece_pairs.T
    return np.asarray(moves[a] & moves[b])


def _moves(hand: Hand, model: CollisionModel, piece: int) -> NDArray[np.bool_]:
    """Which joints (n_joints,) move a piece; none where it belongs to the object."""
    link = model.bodies.bodies[model.bodies.piece_body[piece]].link
    return np.zeros(len(hand.axes), dtype=bool) if link is None else hand.tree.moves[link]


def _piece_bounds(hand: Hand, model: CollisionModel, piece: int) -> Array:
    """Most motion (n_joints,) of a point of a piece by each joint; 0 for joints that do not move it."""
    bounds = np.zeros(len(hand.axes))
    link = model.bodies.bodies[model.bodies.piece_body[piece]].link
    if link is None:
        return bounds
    shape = model.bodies.pieces[piece]
    # From the frame of the link to its furthest point, then from frame to frame up to the palm.
    arm = float(np.linalg.norm(shape.core, axis=1).max()) + shape.radius
    first_axis = offsets(hand.tree.n_axes)
    while link >= 0:
        # Slides of this link shift what is further out against the axes before them.
        for k in range(first_axis[link + 1] - 1, first_axis[link] - 1, -1):
            if hand.tree.prismatic[k]:
                bounds[k] = 1.0
                arm += max(abs(hand.axes[k].lower), abs(hand.axes[k].upper))
            else:
                bounds[k] = arm
        arm += float(np.linalg.norm(hand.tree.T_parent_link0[link][:3, 3]))
        link = int(hand.tree.parents[link])
    return bounds
