"""How the signed distances change with the configuration."""

import numpy as np
from numpy.typing import NDArray

from ..hands.kinematics import joint_axes
from ..solver import ContactManifold, State
from .distance import Gaps
from .pairs import CollisionModel

__all__ = ["distance_jacobian"]

Array = NDArray[np.float64]


def distance_jacobian(manifold: ContactManifold, model: CollisionModel, state: State, gaps: Gaps) -> Array:
    """Derivatives (k, n_tangent) of signed distances along a tangent vector of the manifold, in m per unit.

    d' = n . (v_b - v_a): only the velocities of the two nearest points count, for at the least distance
    it does not matter, to first order, how these points slide over their surfaces.
    """
    hand = model.task.hand
    _, origins, directions = joint_axes(hand, hand.expand(state.q))
    bodies = model.bodies.piece_body[gaps.pairs]
    J_joints = np.zeros((len(gaps.pairs), len(hand.axes)))
    J = np.zeros((len(gaps.pairs), manifold.n_tangent))
    n = manifold.n_q
    for side, points, sign in ((0, gaps.p_a, -1.0), (1, gaps.p_b, 1.0)):
        along = sign * gaps.normals
        on_object = (bodies[:, side] >= len(hand.links))[:, None]
        link = np.where(on_object[:, 0], 0, bodies[:, side])
        turning = np.einsum("kji,ji->kj", np.cross(points[:, None] - origins, along[:, None]), directions)
        speed = np.where(hand.tree.prismatic, along @ directions.T, turning)
        J_joints += np.where(on_object, 0.0, hand.tree.moves[link] * speed)
        J[:, n : n + 3] += on_object * along
        J[:, n + 3 : n + 6] += on_object * np.cross(points - state.p_palm_object, along)
    J[:, :n] = J_joints @ hand.coupling_matrix
    return J
