"""The way of a turn: the fingers roll along with the part that they turn."""

from collections.abc import Iterator

import numpy as np
from scipy.optimize import lsq_linear

from ...base.numeric.arrays import Array
from ...geometry import axis_rotation
from ...hands import jacobian_from_axes, joint_axes
from ...objects import TurnTest
from ...solver import Configuration, ContactManifold, State

__all__ = ["TURN_STATES", "squeeze_trajectory", "turn_path", "turn_ways", "turned_pose"]

TURN_STATES = 10
"""States on the way of a turn, counted without its beginning."""
# It goes so many times as far as it must, as the part lags behind the fingers (by up to a quarter of the
# 15 deg of `tuning`), or less, or at least as far.
_TURN_EXCESSES = (1.3, 1.1, 1.0)
# Rolling is followed in steps of this angle at most.
_STEP_RAD = np.deg2rad(0.5)
_MOST_PROJECTIONS = 20
# A contact may roll out of its region by this share of a patch.
_OVERROLL = 0.3
# Weight of turning along with the object against moving along, in m: what turns along need not roll as far.
_SPIN_M = 2e-4
# How far a joint moves (rad) in place of a whole patch, to return to the contacts.
_JOINT_SHARE = 0.01
# Weight of a small step against the way to go, in m/rad.
_EASE_M = 1e-6
_TOLERANCE_M = 1e-9


def squeeze_trajectory(configuration: Configuration) -> list[Configuration]:
    """The configuration and, in a turn, `TURN_STATES` that follow, or as many as the fingers can follow."""
    test = configuration.task.test
    if not isinstance(test, TurnTest):
        return [configuration]
    for states in turn_ways(configuration, test):
        way = [configuration, *states]
        if len(way) > TURN_STATES:
            break
    return way


def turn_ways(configuration: Configuration, test: TurnTest) -> Iterator[Iterator[Configuration]]:
    """The states that follow the configuration in a turn, for every way that counts, the farthest one first.

    A way that is whole has `TURN_STATES` of them. They are computed as they are asked for.
    """
    return (turn_path(configuration, test, TURN_STATES, excess=excess) for excess in _TURN_EXCESSES)


def turned_pose(state: State, test: TurnTest, angle_rad: float) -> tuple[Array, Array]:
    """Rotation (3, 3) and position (3,) of the object as if all of it turned about the hinge."""
    R, p = state.R_palm_object, state.p_palm_object
    turn = axis_rotation(R @ np.array(test.hinge_axis), angle_rad)
    hinge = R @ np.array(test.hinge_point) + p
    return turn @ R, hinge + turn @ (p - hinge)


def turn_path(
    configuration: Configuration, test: TurnTest, count: int, *, excess: float = 1.0
) -> Iterator[Configuration]:
    """The next `count` configurations on the way to the test's angle, evenly spaced; fewer where it ends.

    Each step moves the joints, within their limits, so that the touching points of the hand move with those
    of the object, which is rolling without sliding; and then returns to the contact equations with the
    object's pose held. A contact may roll a little way out of its region: the regions say where the grasp
    begins. The way ends where the contacts can't be held. It leads to `excess` times the angle.
    """
    manifold = ContactManifold(configuration.task)
    angle_rad = excess * test.angle_rad
    substeps = max(1, int(np.ceil(angle_rad / count / _STEP_RAD)))
    start = state = configuration.state
    for k in range(1, count * substeps + 1):
        R, p = turned_pose(start, test, angle_rad * k / (count * substeps))
        q = state.q + _rolling(manifold, state, R, p)
        followed = _onto_contacts(manifold, State(q, R, p, state.params))
        if followed is None:
            break
        state = followed
        if k % substeps == 0:
            residual_m = float(np.abs(manifold.residual(state)).max())
            yield Configuration(configuration.task, state, residual_m, None)


def _rolling(manifold: ContactManifold, state: State, R: Array, p: Array) -> Array:
    """Change (n_independent,) of the joints with which touching points follow the object to a new pose."""
    hand = manifold.hand
    _, origins, directions = joint_axes(hand, hand.expand(state.q))
    turn = R @ state.R_palm_object.T
    spin = 0.5 * np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    rows, ways = [], []
    for contact, point in zip(manifold.task.contacts, manifold.contact_points(state), strict=True):
        J_p, J_w = jacobian_from_axes(hand, origins, directions, contact.hand.link, point.p_hand)
        rows.append(J_p @ hand.coupling_matrix)
        local = state.R_palm_object.T @ (point.p_object - state.p_palm_object)
        ways.append(R @ local + p - point.p_object)
        rows.append(_SPIN_M * (J_w @ hand.coupling_matrix))
        ways.append(_SPIN_M * spin)
    n = manifold.n_q
    room = manifold.lower[:n] - state.q, manifold.upper[:n] - state.q
    return _bounded_least_squares(np.concatenate(rows), np.concatenate(ways), *room)


def _onto_contacts(manifold: ContactManifold, state: State) -> State | None:
    """The nearest state with the same pose of the object at which the contacts hold; None if not found."""
    n = manifold.n_q
    beyond = np.concatenate([np.zeros(n), np.full(manifold.n_params, _OVERROLL)])
    # The points that touch move over the patches, as they do in rolling, before the joints move again.
    reach = np.concatenate([np.full(n, _JOINT_SHARE), np.ones(manifold.n_params)])
    for _ in range(_MOST_PROJECTIONS):
        c, J = manifold.linearise(state)
        if np.abs(c).max() < _TOLERANCE_M:
            return state
        x = np.concatenate([state.q, state.params])
        room = manifold.lower - beyond - x, manifold.upper + beyond - x
        x += reach * _bounded_least_squares(J[:, manifold.bounded] * reach, -c, *(r / reach for r in room))
        state = State(x[:n], state.R_palm_object, state.p_palm_object, x[n:])
    return None


def _bounded_least_squares(A: Array, b: Array, lower: Array, upper: Array) -> Array:
    """A small x within bounds with A x nearest to b."""
    eased = np.vstack([A, _EASE_M * np.eye(A.shape[1])])
    target = np.concatenate([b, np.zeros(A.shape[1])])
    # What is at its limit still needs a way to go, however short.
    lower, upper = np.minimum(lower, -1e-12), np.maximum(upper, 1e-12)
    x = np.linalg.lstsq(eased, target, rcond=-1)[0]
    if np.all((x >= lower) & (x <= upper)):  # mostly so, and SciPy takes as long again to say so
        return x
    return lsq_linear(eased, target, (lower, upper), method="bvls").x
