"""How far points of the hand get, and how much their ways bend, along a straight line in joint space."""

import numpy as np

from ..base.numeric.arrays import Array, offsets
from ..hands import Hand
from ..retraction import CollisionModel

__all__ = ["bends", "lowest_between"]

# More than what the roundings of some hundred sums of non-negative numbers take away.
_UP = 1.0 + 1e-12
# A joint that stands at its limit may be beyond it by so much (rad or m).
_LIMIT_ROOM = 1e-6


def bends(model: CollisionModel, step: Array) -> Array:
    """What the second derivative (n_pieces,) of a point of each piece is at most, in m, by the line's share.

    The independent joints move by `step` (n_independent,) along the line; the object stays where it is.

    Of a point x the derivative by joints i and j, j further out or the same, is a_i x (a_j x (x - o_j)) with
    axes a and origins o, or a_i x a_j where j slides; it is zero where i slides. So with d the motions of the
    joints and r_j the farthest that joint j's axis has to a point of the piece (1 where it slides), it is at
    most the sum over j of r_j d_j (d_j + 2 (sum of the turns d_i before j)); see Schwarzer, Saha & Latombe,
    "Adaptive dynamic collision checking" (IEEE T-RO 2005), for the first derivative.
    """
    hand, bodies = model.task.hand, model.bodies
    moves = np.abs(hand.coupling_matrix) @ np.abs(step) * _UP
    slides = hand.tree.prismatic
    turns = np.where(slides, 0.0, moves)
    out = np.zeros(len(bodies.pieces))
    for i, piece in enumerate(bodies.pieces):
        link = bodies.bodies[bodies.piece_body[i]].link
        if link is None:
            continue
        far = float(np.linalg.norm(piece.core, axis=1).max()) + piece.radius
        reach = _reach(hand, link, far)
        carried = hand.tree.moves[link]
        before = np.cumsum(np.where(carried, turns, 0.0)) - np.where(carried, turns, 0.0)
        own = np.where(slides, 0.0, moves)
        out[i] = float((np.where(carried, reach * moves * (own + 2.0 * before), 0.0)).sum())
    return out * _UP


def _reach(hand: Hand, link: int, far: float) -> Array:
    """The farthest (n_joints,) that each joint's axis ever has to points within `far` m of a link's frame.

    Of sliding joints 1; of those that do not move the link 0.
    """
    out = np.zeros(len(hand.axes))
    first = offsets(hand.tree.n_axes)
    arm = far
    while link >= 0:
        for k in range(first[link + 1] - 1, first[link] - 1, -1):
            if hand.tree.prismatic[k]:
                out[k] = 1.0
                # A slide shifts what is further out against the axes before it.
                arm += max(abs(hand.axes[k].lower), abs(hand.axes[k].upper)) + _LIMIT_ROOM
            else:
                out[k] = arm
        arm += float(np.linalg.norm(hand.tree.T_parent_link0[link][:3, 3]))
        link = int(hand.tree.parents[link])
    return out * _UP


def lowest_between(start: Array, end: Array, bend: Array) -> Array:
    """Below the values over [0, 1] of functions with these least values at the ends.

    They lie above the line between their ends less bend s (1 - s) / 2 at s, as their second derivative is at
    most `bend`. That parabola is least at s = 1/2 - (end - start) / bend, or at an end.
    """
    rise, bend = end - start, bend + 1e-30
    # Terms of the parabola's lowest value, which is below the least on [0, 1] wherever it lies.
    terms = np.abs(start) + np.abs(end) + bend + rise * rise / bend
    inside = 0.5 * (start + end) - 0.125 * bend - rise * rise / (2.0 * bend) - 1e-14 * terms
    return np.where(np.abs(rise) < 0.5 * bend * _UP, inside, np.minimum(start, end))
