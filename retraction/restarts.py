"""Other places on the contact manifold from which a stalled descent is tried again.

With limits and caps the manifold of a task falls into components (thumb and index on either side of a bar,
with the fingers crossed or not), and in some of them nothing is clear. So the restarts begin nearby and
soon leap: they leave the manifold, and land where the solver's local search finds it again.
"""

import numpy as np
from numpy.typing import NDArray

from ..geometry.transforms import rotation_exp
from ..solver import ContactManifold, State
from ..solver.local_search import search_locally

__all__ = ["contact_joints", "land_elsewhere", "rest_free_joints"]

Array = NDArray[np.float64]

# Spread of the object's turn about each axis at full reach, which makes every attitude likely.
_TURN_RAD = 2.0


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
