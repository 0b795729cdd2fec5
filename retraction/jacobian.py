"""How the signed distances change with the configuration."""

from typing import NamedTuple

import numpy as np

from ..base.machine.jit import compiled
from ..base.numeric.arrays import Array, Indices, Mask
from ..hands import joint_axes
from ..solver import ContactManifold, State
from .distance import Gaps
from .pairs import CollisionModel

__all__ = ["distance_jacobian"]


class _Joints(NamedTuple):
    """What the joints of a hand move, and how.

    Attributes:
        moves: (n_links, n_joints) whether a joint moves a link.
        prismatic: (n_joints,) whether a joint slides.
        origins: (n_joints, 3) points of the axes in the palm frame, in m.
        directions: (n_joints, 3) unit vectors along the axes.
    """

    moves: Mask
    prismatic: Mask
    origins: Array
    directions: Array


def distance_jacobian(manifold: ContactManifold, model: CollisionModel, state: State, gaps: Gaps) -> Array:
    """Derivatives (k, n_tangent) of signed distances along a tangent vector of the manifold, in m per unit.

    d' = n . (v_b - v_a): only the velocities of the two nearest points count, for at the least distance
    it does not matter, to first order, how these points slide over their surfaces.
    """
    hand = model.task.hand
    _, origins, directions = joint_axes(hand, hand.expand(state.q))
    joints = _Joints(hand.tree.moves, hand.tree.prismatic, origins, directions)
    bodies = model.bodies.piece_body[gaps.pairs]
    n = manifold.n_q
    J_joints, J = np.zeros((len(gaps.pairs), len(hand.axes))), np.zeros((len(gaps.pairs), manifold.n_tangent))
    J_pose = np.zeros((len(gaps.pairs), 6))
    for side, points, sign in ((0, gaps.p_a, -1.0), (1, gaps.p_b, 1.0)):
        _add_speeds(
            bodies[:, side].copy(),
            points,
            sign * gaps.normals,
            joints,
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
    joints: _Joints,
    p_palm_object: Array,
    J_joints: Array,
    J_pose: Array,
) -> None:
    """Adds the speeds of points (k, 3) of bodies along (k, 3): by each joint, and by the object's pose."""
    for k in range(len(body)):
        p, n = points[k], along[k]
        if body[k] >= len(joints.moves):  # the object, which only its pose moves
            for c in range(3):
                u, v = (c + 1) % 3, (c + 2) % 3
                J_pose[k, c] += n[c]
                J_pose[k, 3 + c] += (p[u] - p_palm_object[u]) * n[v] - (p[v] - p_palm_object[v]) * n[u]
            continue
        for j in range(len(joints.prismatic)):
            if not joints.moves[body[k], j]:
                continue
            o, d = joints.origins[j], joints.directions[j]
            for c in range(3):
                u, v = (c + 1) % 3, (c + 2) % 3
                turning = (p[u] - o[u]) * n[v] - (p[v] - o[v]) * n[u]
                J_joints[k, j] += d[c] * (n[c] if joints.prismatic[j] else turning)
