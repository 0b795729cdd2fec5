"""Whether the hand keeps clear all along a straight line in joint space: proved, not sampled."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Indices
from ..solver import State
from .distance import lower_bounds, measure
from .motion_bound import motion_bounds
from .nearest import measure_quickly
from .pairs import CollisionModel

__all__ = ["Obstruction", "sweep"]


# Segments during which nothing moves further than this are not cut again: what then is not proved clear
# touches its limit to within rounding.
_LEAST_MOTION_M = 1e-8
# So many pairs are measured sooner than they are bounded.
_FEW = 20


@dataclass(frozen=True)
class Obstruction:
    """Where a line is not clear.

    Attributes:
        pair: index of the pair of pieces that comes too close.
        share: where on the line, from 0 at its start to 1 at its end.
        distance_m: signed distance of the pair there.
    """

    pair: int
    share: float
    distance_m: float


def sweep(model: CollisionModel, state: State, q_end: Array, required_m: Array) -> Obstruction | None:
    """Proves that every pair of pieces keeps its distance while the joints move in a straight line.

    On a segment with distances d and d' at its ends, along which the pair's distance can change by no more
    than L, it is nowhere below (d + d' - L) / 2: each point is within some share of L of one end and within
    the rest of the other. Segments on which that is too little for some pair are halved, for these pairs.

    Args:
        model: bodies and pairs.
        state: where the line starts; the object stays where it is.
        q_end: independent joints (n_independent,) at its end.
        required_m: (n_pairs_of_pieces,) least signed distances.

    Returns:
        None where the line is clear in all its points, else a point at which it is not.
    """
    line = _Line(model, state, q_end, required_m)
    everything = np.arange(len(model.piece_pairs))
    ends = []
    for share in (0.0, 1.0):
        ends.append(line.room(share, everything, 0.5 * line.travel_m))
        if ends[-1].min(initial=0.0) < 0.0:
            return line.obstruction(share, everything, ends[-1])
    # Start, end, the pairs that may collide in between, and their room at either end.
    segments = [(0.0, 1.0, everything, ends[0], ends[1])]
    while segments:
        start, end, pairs, room_start, room_end = segments.pop()
        travel_m = (end - start) * line.travel_m[pairs]
        doubtful = room_start + room_end < travel_m
        if not doubtful.any():
            continue
        pairs, travel_m = pairs[doubtful], travel_m[doubtful]
        middle = 0.5 * (start + end)
        room = line.room(middle, pairs, 0.25 * travel_m)
        if room.min() < 0.0 or travel_m.max() < _LEAST_MOTION_M:
            return line.obstruction(middle, pairs, room)
        segments.append((middle, end, pairs, room, room_end[doubtful]))
        segments.append((start, middle, pairs, room_start[doubtful], room))
    return None


class _Line:
    """A straight line in joint space.

    Attributes:
        travel_m: (n_pairs_of_pieces,) most by which the distance of each pair can change along it.
    """

    def __init__(self, model: CollisionModel, state: State, q_end: Array, required_m: Array):
        self._model = model
        self._state = state
        self._step = q_end - state.q
        self._required_m = required_m
        hand = model.task.hand
        self.travel_m = motion_bounds(model.task) @ np.abs(hand.coupling_matrix @ self._step)

    def room(self, share: float, pairs: Indices, enough_m: Array) -> Array:
        """Distances (k,) of pairs less what is required; a lower bound where that is `enough_m` (k,)."""
        state = self._state
        q = state.q + share * self._step
        placed = self._model.place(State(q, state.R_palm_object, state.p_palm_object, state.params))
        room = np.full(len(pairs), -np.inf)
        if len(pairs) > _FEW:
            room = lower_bounds(placed, self._model.piece_pairs[pairs]) - self._required_m[pairs]
        near = room < enough_m
        gaps = measure_quickly(placed, self._model.piece_pairs[pairs[near]])
        room[near] = gaps.distance_m - self._required_m[pairs[near]]
        # It overstates no distance either, so what is clear by it is proved; that something is not, is FCL's
        # to say.
        short = room < 0.0
        if short.any():
            gaps = measure(placed, self._model.piece_pairs[pairs[short]])
            room[short] = gaps.distance_m - self._required_m[pairs[short]]
        return room

    def obstruction(self, share: float, pairs: Indices, room: Array) -> Obstruction:
        """The pair with the least room."""
        worst = int(np.argmin(room))
        pair = int(pairs[worst])
        return Obstruction(pair, share, float(room[worst] + self._required_m[pair]))
