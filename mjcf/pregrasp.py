"""The pregrasp: the grasp with its fingers a little open."""

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear

from ..hands.kinematics import jacobian_from_axes, joint_axes
from ..solver import Configuration

__all__ = ["pregrasp"]

Array = NDArray[np.float64]
# Weight of a small motion against opening by the whole way, in m/rad.
_EASE_M = 1e-4


def pregrasp(configuration: Configuration, opening_m: float = 0.005) -> Array:
    """Independent joints (n_independent,) from which the fingers close on the object.

    A small motion of the joints, within their limits, that takes each touching point of the hand away from
    the object along the contact's normal by `opening_m`, to first order, or as far as it can.
    """
    hand = configuration.task.hand
    _, origins, directions = joint_axes(hand, configuration.joint_vector)
    rows = []
    for contact, point in zip(configuration.task.contacts, configuration.contact_points, strict=True):
        J_p, _ = jacobian_from_axes(hand, origins, directions, contact.hand.link, point.p_hand)
        rows.append(point.n_object @ J_p @ hand.coupling_matrix)
    q, n = configuration.state.q, len(hand.independent)
    A = np.vstack([np.array(rows), _EASE_M * np.eye(n)])
    b = np.concatenate([np.full(len(rows), opening_m), np.zeros(n)])
    lower, upper = configuration.task.limits.T
    # A joint held fixed by its limits still needs a way to go, however short.
    bounds = np.minimum(lower - q, -1e-12), np.maximum(upper - q, 1e-12)
    return np.clip(q + lsq_linear(A, b, bounds, method="bvls").x, lower, upper)
