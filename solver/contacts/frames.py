"""Both sides of every contact in the palm frame, with derivatives by the motion and the patch parameters."""

from typing import NamedTuple

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array
from ...geometry import bernstein_jets
from ...hands import place_links
from .tables import PATCH, ContactTables

__all__ = ["ContactFrames", "contact_frames", "joint_vector"]


class ContactFrames(NamedTuple):
    """The sides of all contacts at a state; columns of derivatives are those of the tangent space.

    Attributes:
        p: (n_sides, 3) in m: the point of a patch or point region, the centre of a cap.
        J_p: (n_sides, 3, n_tangent).
        directions: (n_sides, 3, 3), unit vectors in rows: the outward normal (of a cap: its axis) and two
            tangents.
        J_directions: (n_sides, 3, 3, n_tangent).
    """

    p: Array
    J_p: Array
    directions: Array
    J_directions: Array


@compiled
def contact_frames(t: ContactTables, q: Array, R: Array, p: Array, params: Array) -> ContactFrames:
    """The sides at joints (n_q,), rotation (3, 3) and position (3,) of the object, and parameters."""
    n_sides, n_q, n_tangent = len(t.kind), len(q), len(q) + 6 + len(params)
    at = ContactFrames(
        np.zeros((n_sides, 3)),
        np.zeros((n_sides, 3, n_tangent)),
        np.zeros((n_sides, 3, 3)),
        np.zeros((n_sides, 3, 3, n_tangent)),
    )
    tree = t.tree
    Ts, origins, axes = place_links(
        tree.parents, tree.n_axes, tree.T_parent_link0, tree.directions, tree.prismatic, joint_vector(t, q)
    )
    T_object = np.zeros((4, 4))
    for a in range(3):
        T_object[a, 3] = p[a]
        for b in range(3):
            T_object[a, b] = R[a, b]
    J_w = np.zeros((3, n_tangent))
    for s in range(n_sides):
        point, d_point, local, d_local = _in_body(t, s, params)
        for a in range(3):
            for j in range(n_tangent):
                J_w[a, j] = 0.0
        if t.link[s] < 0:
            T = T_object
            _move_with_object(T, point, n_q, at.p[s], at.J_p[s], J_w)
        else:
            T = Ts[t.link[s]]
            _move_with_link(T, point, t, t.link[s], origins, axes, at.p[s], at.J_p[s], J_w)
        first = n_q + 6 + t.first_param[s]
        _carry(T, local, d_point, d_local, J_w, first, at.J_p[s], at.directions[s], at.J_directions[s])
    return at


@compiled
def joint_vector(t: ContactTables, q: Array) -> Array:
    """Positions of all joints, coupled ones included."""
    out = t.coupling_offset.copy()
    for i in range(t.coupling.shape[0]):
        for j in range(t.coupling.shape[1]):
            out[i] += t.coupling[i, j] * q[j]
    return out


@compiled
def _in_body(t: ContactTables, s: int, params: Array) -> tuple[Array, Array, Array, Array]:
    """Point (3,), derivatives (3, k) by the side's k parameters, directions (3, 3) and theirs (3, 3, k)."""
    if t.kind[s] != PATCH:
        return t.point[s], np.zeros((3, 0)), t.directions[s], np.zeros((3, 3, 0))
    rows, columns = t.net_shape[s]
    first = t.net_start[s]
    net = t.nets[first : first + rows * columns].reshape(rows, columns, 3)
    k = t.first_param[s]
    return _patch_frame(net, params[k], params[k + 1])


@compiled
def _patch_frame(points: Array, u: float, v: float) -> tuple[Array, Array, Array, Array]:
    """Point, derivatives, unit normal and tangents, and their derivatives, of a Bezier patch."""
    bu, bu1, bu2 = bernstein_jets(points.shape[0] - 1, u)
    bv, bv1, bv2 = bernstein_jets(points.shape[1] - 1, v)
    jet = np.zeros((6, 3))  # p, p_u, p_v, p_uu, p_uv, p_vv
    for i in range(points.shape[0]):
        for j in range(points.shape[1]):
            for a in range(3):
                x = points[i, j, a]
                jet[0, a] += bu[i] * bv[j] * x
                jet[1, a] += bu1[i] * bv[j] * x
                jet[2, a] += bu[i] * bv1[j] * x
                jet[3, a] += bu2[i] * bv[j] * x
                jet[4, a] += bu1[i] * bv1[j] * x
                jet[5, a] += bu[i] * bv2[j] * x
    point, d_point = np.zeros(3), np.zeros((3, 2))
    directions, slopes = np.zeros((3, 3)), np.zeros((3, 3, 2))
    for a in range(3):
        point[a] = jet[0, a]
        d_point[a, 0] = directions[1, a] = jet[1, a]
        d_point[a, 1] = directions[2, a] = jet[2, a]
        slopes[1, a, 0] = jet[3, a]
        slopes[1, a, 1] = slopes[2, a, 0] = jet[4, a]
        slopes[2, a, 1] = jet[5, a]
        b, c = (a + 1) % 3, (a + 2) % 3
        directions[0, a] = jet[1, b] * jet[2, c] - jet[1, c] * jet[2, b]
        for k in range(2):
            slopes[0, a, k] = jet[3 + k, b] * jet[2, c] - jet[3 + k, c] * jet[2, b]
            slopes[0, a, k] += jet[1, b] * jet[4 + k, c] - jet[1, c] * jet[4 + k, b]
    _normalise(directions, slopes)
    return point, d_point, directions, slopes


@compiled
def _normalise(vectors: Array, slopes: Array) -> None:
    """Scales each row to unit length, and its derivatives to match, in place."""
    for i in range(3):
        length = np.sqrt(vectors[i, 0] ** 2 + vectors[i, 1] ** 2 + vectors[i, 2] ** 2)
        for a in range(3):
            vectors[i, a] /= length
        for k in range(2):
            along = (
                vectors[i, 0] * slopes[i, 0, k]
                + vectors[i, 1] * slopes[i, 1, k]
                + vectors[i, 2] * slopes[i, 2, k]
            )
            for a in range(3):
                slopes[i, a, k] = (slopes[i, a, k] - vectors[i, a] * along) / length


@compiled
def _move_with_link(
    T: Array,
    p_link: Array,
    t: ContactTables,
    link: int,
    origins: Array,
    axes: Array,
    p: Array,
    J_p: Array,
    J_w: Array,
) -> None:
    """A link's point in the palm frame, its velocity and the link's angular velocity (3, n_tangent each)."""
    _place(T, p_link, p)
    for k in range(t.coupling.shape[0]):
        if not t.tree.moves[link, k]:
            continue
        for j in range(t.coupling.shape[1]):
            e = t.coupling[k, j]
            if e == 0.0:
                continue
            for a in range(3):
                if t.tree.prismatic[k]:
                    J_p[a, j] += e * axes[k, a]
                else:
                    b, c = (a + 1) % 3, (a + 2) % 3
                    J_p[a, j] += e * (
                        axes[k, b] * (p[c] - origins[k, c]) - axes[k, c] * (p[b] - origins[k, b])
                    )
                    J_w[a, j] += e * axes[k, a]


@compiled
def _move_with_object(T: Array, p_object: Array, n_q: int, p: Array, J_p: Array, J_w: Array) -> None:
    """The same for a point of the object, which moves freely."""
    _place(T, p_object, p)
    for a in range(3):
        b, c = (a + 1) % 3, (a + 2) % 3
        J_p[a, n_q + a] = 1.0
        J_w[a, n_q + 3 + a] = 1.0
        J_p[a, n_q + 3 + b] = p[c] - T[c, 3]
        J_p[a, n_q + 3 + c] = T[b, 3] - p[b]


@compiled
def _place(T: Array, p_local: Array, p: Array) -> None:
    for a in range(3):
        p[a] = T[a, 0] * p_local[0] + T[a, 1] * p_local[1] + T[a, 2] * p_local[2] + T[a, 3]


@compiled
def _carry(
    T: Array,
    local: Array,
    d_point: Array,
    d_local: Array,
    J_w: Array,
    first: int,
    J_p: Array,
    directions: Array,
    J: Array,
) -> None:
    """Directions in the palm frame with derivatives; adds the parameters' columns from `first` on to J_p."""
    for a in range(3):
        for k in range(d_point.shape[1]):
            for b in range(3):
                J_p[a, first + k] += T[a, b] * d_point[b, k]
    for i in range(3):
        for a in range(3):
            directions[i, a] = T[a, 0] * local[i, 0] + T[a, 1] * local[i, 1] + T[a, 2] * local[i, 2]
        for a in range(3):
            b, c = (a + 1) % 3, (a + 2) % 3
            for t in range(J_w.shape[1]):
                J[i, a, t] = J_w[b, t] * directions[i, c] - J_w[c, t] * directions[i, b]
            for k in range(d_point.shape[1]):
                for b in range(3):
                    J[i, a, first + k] += T[a, b] * d_local[i, b, k]
