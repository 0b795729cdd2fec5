"""Other places from which a descent may succeed where the first one stalled, nearest first.

- Free joints, those of fingers without a contact, go to rest: no contact notices, so the way there is open.
- A walk along the contact manifold, in a random direction of its null space, passes over the ridge that
  stopped the descent; the contacts hold all the way. This is the retraction idea of Zhang & Manocha, "An
  efficient retraction-based RRT planner" (ICRA 2008): sample in contact space, prefer what is near.
- A landing leaves the manifold and comes down where the solver's local search finds it again. With limits
  and caps the manifold of a task falls into components (thumb and index on either side of a bar, fingers
  crossed or not), and in some of them nothing is clear.
"""

import numpy as np
from numpy.typing import NDArray

from ..base.numeric.arrays import Array
from ..geometry import rotation_exp
from ..solver import ContactManifold, State, search_locally

__all__ = ["back_on_manifold", "contact_joints", "land_elsewhere", "rest_free_joints", "walk"]


# Spread of the object's turn about each axis at full reach, which makes every attitude likely.
_TURN_RAD = 2.0
# Longest step of a walk, in m of the motion that the coordinate which moves most causes.
_STRIDE_M = 0.02
# Contacts of the points on the way hold to this; the last one is refined when it is certified.
_ON_MANIFOLD_M = 1e-10
# Steps of the local search that brings a contact back into its cap.
_LANDING_STEPS = 8


def contact_joints(manifold: ContactManifold) -> NDArray[np.bool_]:
    """Which independent joints (n_q,) move a link that has a contact; the others are free."""
    hand = manifold.task.hand
    links = [contact.hand.link for contact in manifold.task.contacts]
    moving = hand.tree.moves[links].any(axis=0)
    return (hand.coupling_matrix[moving] != 0.0).any(axis=0)


def rest_free_joints(manifold: ContactManifold, state: State) -> State:
    """The state with its free joints at zero, or at the limit next to it; contacts don't notice."""
    rest = np.clip(0.0, *manifold.task.limits.T)
    q = np.where(contact_joints(manifold), state.q, rest)
    return State(q, state.R_palm_object, state.p_palm_object, state.params)


def back_on_manifold(manifold: ContactManifold, state: State) -> State | None:
    """The state on the manifold next to where a step led, or None; the step may have left a cap."""
    landed = manifold.project(state, tolerance_m=_ON_MANIFOLD_M)
    if landed is None or manifold.is_feasible(landed):
        return landed
    return search_locally(manifold, landed, max_steps=_LANDING_STEPS)


def walk(
    manifold: ContactManifold, state: State, scale: Array, length_m: float, rng: np.random.Generator
) -> State | None:
    """The end of a straight walk along the manifold in a random direction, or None where no step is possible.

    Args:
        manifold: the contacts.
        state: a state on the manifold.
        scale: (n_tangent,) metres of motion per unit of each tangent coordinate.
        length_m: motion of the coordinate that moves most; less where caps or the manifold end the walk.
        rng: chooses the direction.
    """
    direction = rng.normal(size=manifold.n_tangent)
    count = max(1, round(length_m / _STRIDE_M))
    reached = None
    for _ in range(count):
        A = manifold.linearise(state)[1] / scale
        along = direction - np.linalg.lstsq(A, A @ direction, rcond=1e-9)[0]
        step = length_m / count * along / np.abs(along).max(initial=1e-300)
        following = back_on_manifold(manifold, manifold.retract(state, step / scale))
        if following is None:
            break
        reached = state = following
    return reached


def land_elsewhere(
    manifold: ContactManifold, state: State, reach: float, rng: np.random.Generator
) -> State | None:
    """A random state on the manifold, or None for a miss; `reach` in (0, 1] says how far it may be.

    Joints and parameters go the share `reach` of the way to random values, and the object turns about the
    middle of its contacts.
    """
    x = np.concatenate([state.q, state.params])
    x = x + reach * (rng.uniform(manifold.lower, manifold.upper) - x)
    turn = rotation_exp(rng.normal(scale=_TURN_RAD * reach, size=3))
    middle = np.mean([point.p_object for point in manifold.contact_points(state)], axis=0)
    p = middle + turn @ (state.p_palm_object - middle)
    start = State(x[: manifold.n_q], turn @ state.R_palm_object, p, x[manifold.n_q :])
    return search_locally(manifold, start)
