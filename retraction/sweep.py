"""Whether the hand keeps clear all along a straight line in joint space: proved, not sampled."""

from dataclasses import dataclass

import numpy as np

from ..base.numeric.arrays import Array, Indices, Mask
from ..solver import State
from .bodies import PlacedBodies
from .distance import lower_bounds, measure
from .motion_bound import carried_together, motion_bounds
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

    A pair that slides along its limit would take hundreds of halves, so each half is also asked of the gap
    along one fixed normal n, that in the segment's middle: it is nowhere above the distance, and the least
    over pairs of vertices of functions whose second derivative is bounded (see `_Line.bend_m`). So it lies
    above the line between its ends less K s (1 - s) / 2 at the share s of a half with bound K.

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
        placed = line.place(share)
        room, _ = line.room(placed, everything, 0.5 * line.travel_m)
        if room.min(initial=0.0) < 0.0:
            return line.obstruction(share, everything, room)
        ends.append(_End(share, placed, room))
    # Start and end, and the pairs that may collide in between.
    segments = [(ends[0], ends[1], everything)]
    while segments:
        start, end, pairs = segments.pop()
        length = end.share - start.share
        travel_m = length * line.travel_m[pairs]
        doubtful = start.room_m + end.room_m < travel_m
        if not doubtful.any():
            continue
        start, end, pairs, travel_m = (
            start.of(doubtful),
            end.of(doubtful),
            pairs[doubtful],
            travel_m[doubtful],
        )
        share = 0.5 * (start.share + end.share)
        placed = line.place(share)
        room, normals = line.room(placed, pairs, 0.25 * travel_m)
        if room.min() < 0.0 or travel_m.max() < _LEAST_MOTION_M:
            return line.obstruction(share, pairs, room)
        middle = _End(share, placed, room)
        bend_m = (0.5 * length) ** 2 * line.bend_m[pairs]
        along = [line.room_along(normals, there.placed, pairs) for there in (start, middle, end)]
        for i, (first, last) in ((1, (middle, end)), (0, (start, middle))):
            # Without a normal nothing is proved along it.
            open_ = (lowest_between(along[i], along[i + 1], bend_m) < 0.0) | ~normals.any(axis=1)
            if open_.any():
                segments.append((first.of(open_), last.of(open_), pairs[open_]))
    return None


def lowest_between(start: Array, end: Array, bend: Array) -> Array:
    """Least value over [0, 1] that functions with these values (k,) at the ends may take.

    Args:
        start: at 0.
        end: at 1.
        bend: what their second derivative is at most.
    """
    rise = end - start
    is_inside = np.abs(rise) < 0.5 * bend
    divisor = np.where(is_inside, 2.0 * bend, 1.0)
    inside = 0.5 * (start + end) - 0.125 * bend - rise**2 / divisor
    return np.where(is_inside, inside, np.minimum(start, end))


@dataclass(frozen=True, eq=False)
class _End:
    """Where a segment starts or ends: the share of the line, the bodies there, and room (k,) of its pairs."""

    share: float
    placed: PlacedBodies
    room_m: Array

    def of(self, pairs: Mask) -> "_End":
        """For some of the pairs."""
        return _End(self.share, self.placed, self.room_m[pairs])


class _Line:
    """A straight line in joint space.

    Attributes:
        travel_m: (n_pairs_of_pieces,) most by which the distance of each pair can change along it.
        bend_m: (n_pairs_of_pieces,) most second derivative, by the share of the line, of the distance of two
            points of the pair along any fixed direction; infinite where joints that move carry both pieces,
            as these turn the pair against what is fixed.

    Of a point x, moved by joints i and j, j further out, the mixed derivative is a_i x (a_j x (x - o_j)) with
    axes a and origins o, or a_i x a_j where j slides, and 0 where i does: never more than what j moves x by.
    So the second derivative along the line is at most twice the travel times the sum of all turns.
    """

    def __init__(self, model: CollisionModel, state: State, q_end: Array, required_m: Array):
        self._model = model
        self._state = state
        self._step = q_end - state.q
        self._required_m = required_m
        hand = model.task.hand
        bounds, turns = motion_bounds(model.task), np.abs(hand.coupling_matrix @ self._step)
        self.travel_m = bounds @ turns
        is_apart = carried_together(model.task) @ turns == 0.0
        self.bend_m = np.where(is_apart, 2.0 * self.travel_m * ((bounds > 0.0) @ turns), np.inf)

    def place(self, share: float) -> PlacedBodies:
        """The bodies at a share of the line."""
        state = self._state
        q = state.q + share * self._step
        return self._model.place(State(q, state.R_palm_object, state.p_palm_object, state.params))

    def room_along(self, normals: Array, placed: PlacedBodies, pairs: Indices) -> Array:
        """Gaps (k,) of pairs along fixed normals (k, 3), less what is required: never above the room."""
        of_pieces = self._model.piece_pairs[pairs]
        radii_m = placed.bodies.radius[of_pieces].sum(axis=1)
        return placed.separations(of_pieces, normals) - radii_m - self._required_m[pairs]

    def room(self, placed: PlacedBodies, pairs: Indices, enough_m: Array) -> tuple[Array, Array]:
        """Distances (k,) of pairs less what is required, and normals (k, 3) along which they are.

        Where there is `enough_m` (k,) the distance may be a lower bound, and the normal zero.
        """
        room, normals = np.full(len(pairs), -np.inf), np.zeros((len(pairs), 3))
        if len(pairs) > _FEW:
            room = lower_bounds(placed, self._model.piece_pairs[pairs]) - self._required_m[pairs]
        near = room < enough_m
        gaps = measure_quickly(placed, self._model.piece_pairs[pairs[near]])
        room[near], normals[near] = gaps.distance_m - self._required_m[pairs[near]], gaps.normals
        # It overstates no distance either, so what is clear by it is proved; that something is not, is FCL's
        # to say.
        short = room < 0.0
        if short.any():
            gaps = measure(placed, self._model.piece_pairs[pairs[short]])
            room[short], normals[short] = gaps.distance_m - self._required_m[pairs[short]], gaps.normals
        return room, normals

    def obstruction(self, share: float, pairs: Indices, room: Array) -> Obstruction:
        """The pair with the least room."""
        worst = int(np.argmin(room))
        pair = int(pairs[worst])
        return Obstruction(pair, share, float(room[worst] + self._required_m[pair]))
