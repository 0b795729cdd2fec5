"""How the signed distances change with the configuration."""

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, Indices
from ..hands import joint_axes
from ..jit import compiled
from ..solver import ContactManifold, State
from .distance import Gaps
from .pairs import CollisionModel

__all__ = ["distance_jacobian"]


def distance_jacobian(manifold: ContactManifold, model: CollisionModel, state: State, gaps: Gaps) -> Array:
    """Derivatives (k, n_tangent) of signed distances along a tangent vector of the manifold, in m per unit.

    d' = n . (v_b - v_a): only the velocities of the two nearest points count, for at the least distance
    it does not matter, to first order, how these points slide over their surfaces.
    """
    hand = model.task.hand
    _, origins, directions = joint_axes(hand, hand.expand(state.q))
    bodies = model.bodies.piece_body[gaps.pairs]
    n = manifold.n_q
    J_joints, J = np.zeros((len(gaps.pairs), len(hand.axes))), np.zeros((len(gaps.pairs), manifold.n_tangent))
    J_pose = np.zeros((len(gaps.pairs), 6))
    for side, points, sign in ((0, gaps.p_a, -1.0), (1, gaps.p_b, 1.0)):
        _add_speeds(
            bodies[:, side].copy(),
            points,
            sign * gaps.normals,
            hand.tree.moves,
            hand.tree.prismatic,
            origins,
            directions,
            state.p_palm_object,
            J_joints,
            J_pose,
        )
    J[:, :n] = J_joints @ hand.coupling_matrix
    J[:, n : n + 6] = J_pose
    return J


@compiled
def _add_speeds(
    body: Indices,
    points: Array,
    along: Array,
    moves: NDArray[np.bool_],
    prismatic: NDArray[np.bool_],
    origins: Array,
    directions: Array,
    p_palm_object: Array,
    J_joints: Array,
    J_pose: Array,
) -> None:
    """Adds the speeds of points (k, 3) of bodies along (k, 3): by each joint, and by the object's pose."""
    for k in range(len(body)):
        p, n = points[k], along[k]
        if body[k] >= len(moves):  # the object, which only its pose moves
            for c in range(3):
                u, v = (c + 1) % 3, (c + 2) % 3
                J_pose[k, c] += n[c]
                J_pose[k, 3 + c] += (p[u] - p_palm_object[u]) * n[v] - (p[v] - p_palm_object[v]) * n[u]
            continue
        for j in range(len(prismatic)):
            if not moves[body[k], j]:
                continue
            o, d = origins[j], directions[j]
            for c in range(3):
                u, v = (c + 1) % 3, (c + 2) % 3
                turning = (p[u] - o[u]) * n[v] - (p[v] - o[v]) * n[u]
                J_joints[k, j] += d[c] * (n[c] if prismatic[j] else turning)
