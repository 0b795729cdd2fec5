"""Whether the fingers have room on the way of a turn.

They roll along with the part that they turn, and the links behind them move, too. What does not turn stays
where it is: a thumb whose base comes to lean against the body of a guitar neither follows nor lets go. Of a
task's bodies links are where the joints of a state put them, the parts that turn are where the state has the
object, and all others where the object was at the beginning.
"""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import rotation_angle
from ...hands import forward_kinematics
from ...objects import TurnTest
from ...retraction import CollisionModel, collision_model, lower_bounds, measure_quickly
from ...solver import Configuration
from .refusal import Obstacle
from .turn_path import TURN_STATES, turn_ways

__all__ = ["follows_turn", "in_the_way", "why_not_followed"]

# Links yield to what they lean on, but begin no better where they lean on more.
_LEANING_M = 1e-3
# Of an angle, short of rounding.
_WHOLE = 1.0 - 1e-6


def why_not_followed(way: Sequence[Configuration], slip_limit_m: float) -> Obstacle | None:
    """What keeps the fingers from following a turn, of which `squeeze_trajectory` has found this way.

    Args:
        way: the grasp and the states that follow it.
        slip_limit_m: how far contacts may slide, and so lead links past what is in their way.
    """
    if len(way) < 1 + TURN_STATES:
        return Obstacle.REACH
    return None if in_the_way(way, deeper_than_m=slip_limit_m) is None else Obstacle.ROOM


def follows_turn(configuration: Configuration) -> bool:
    """Whether the fingers can follow a turn from there, their contacts held and nothing in the way.

    Bodies sink into each other by 1 mm at most. The way is looked at no farther than to the first obstacle,
    and counts where it becomes whole.
    """
    test = configuration.task.test
    assert isinstance(test, TurnTest)
    for states in turn_ways(configuration, test):
        before, n_states = configuration, 0
        for there in states:
            if _blocked(configuration, before, there, _LEANING_M) is not None:
                return False
            before, n_states = there, n_states + 1
        if n_states == TURN_STATES:
            return True
    return False


def in_the_way(way: Sequence[Configuration], *, deeper_than_m: float = _LEANING_M) -> tuple[str, str] | None:
    """The first two bodies that sink too deep into each other on the way of a turn; None for none.

    It is looked at as far as the test asks for.

    Args:
        way: the grasp and the states that follow it, at least one.
        deeper_than_m: what is too deep.
    """
    blocked = (_blocked(way[0], before, there, deeper_than_m) for before, there in pairwise(way))
    return next((pair for pair in blocked if pair is not None), None)


def _blocked(
    start: Configuration, before: Configuration, there: Configuration, deeper_than_m: float
) -> tuple[str, str] | None:
    """The two bodies that sink too deep at a state of the way, behind `before`; None for none.

    None as well where the way has been as far as the test asks for: what is beyond is there to make up for a
    lag.
    """
    model, test = collision_model(start.task), start.task.test
    assert isinstance(test, TurnTest)
    if _turned_rad(start, before) >= _WHOLE * test.angle_rad:
        return None
    # What touches on purpose is kept by the way itself.
    pairs = np.flatnonzero(~model.intended)
    placed = model.bodies.place(_poses(model, start, there))
    close = pairs[lower_bounds(placed, model.piece_pairs[pairs]) < -deeper_than_m]
    depth_m = -measure_quickly(placed, model.piece_pairs[close]).distance_m
    if depth_m.max(initial=0.0) <= deeper_than_m:
        return None
    deepest = close[np.argmax(depth_m)]
    return model.name(model.pairs[model.pair_of[deepest]])


def _poses(model: CollisionModel, start: Configuration, there: Configuration) -> Array:
    """Poses (n_bodies, 4, 4) in the palm frame."""
    links = forward_kinematics(there.task.hand, there.joint_vector)
    others = np.tile(start.state.T_palm_object, (len(model.bodies.bodies) - len(links), 1, 1))
    for i, part in enumerate(there.task.object.parts):
        if part not in there.task.obstacles:
            others[i] = there.state.T_palm_object
    return np.concatenate([links, others])


def _turned_rad(start: Configuration, there: Configuration) -> float:
    """By how much the part has turned."""
    return rotation_angle(there.state.R_palm_object @ start.state.R_palm_object.T)
