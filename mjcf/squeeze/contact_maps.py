"""The linear maps of a task's contacts, and how they change along the contact manifold, in compiled loops.

They are `G` and `T` of `statics`, at the force points of the contacts that the task names. Their derivatives
are asked for in one sum, W_G . G + W_T . T with given weights: that is all a linear program's value needs,
and it takes one pass over the points whatever the number of directions in which the state may move.
"""

from typing import NamedTuple

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array, Indices, Mask
from ...hands import place_links
from ...solver.contacts import CAP, ContactFrames, ContactTables, contact_frames, joint_vector

__all__ = ["ContactMaps", "contact_maps", "maps_slope"]


class ContactMaps(NamedTuple):
    """The maps of m force points, in the palm frame.

    Attributes:
        points: (m, 3), see `Statics`.
        frames: (m, 3, 3), see `Statics`.
        G: grasp matrix (6, 4 m), see `Statics`.
        T: (n_independent, 4 m), see `Statics`.
    """

    points: Array
    frames: Array
    G: Array
    T: Array


class _Side(NamedTuple):
    """Where a contact is, with derivatives along the tangent space.

    Attributes:
        p_object: (3,) in m; J_object (3, n_tangent).
        p_hand: (3,) in m; J_hand (3, n_tangent).
        frame: (3, 3) inward normal and tangents in rows; J_frame (3, 3, n_tangent).
    """

    p_object: Array
    J_object: Array
    p_hand: Array
    J_hand: Array
    frame: Array
    J_frame: Array


@compiled
def contact_maps(
    t: ContactTables,
    q: Array,
    R: Array,
    p: Array,
    params: Array,
    centre_object: Array,
    contact: Indices,
    offsets: Array,
) -> ContactMaps:
    """The maps at a state.

    Args:
        t: the task's contacts.
        q: independent joints.
        R: rotation (3, 3) of the object.
        p: position (3,) of the object in m.
        params: parameters of patches.
        centre_object: centre of mass (3,) in the object's frame, in m.
        contact: which contact each force point belongs to (m,); see `ForcePoints`.
        offsets: where it is (m, 2), in m.
    """
    at = contact_frames(t, q, R, p, params)
    n_points = len(contact)
    _, origins, axes = _axes(t, q)
    centre = _placed(R, p, centre_object)
    maps = ContactMaps(
        np.zeros((n_points, 3)),
        np.zeros((n_points, 3, 3)),
        np.zeros((6, 4 * n_points)),
        np.zeros((len(q), 4 * n_points)),
    )
    for i in range(n_points):
        side = _beside(_contact(t, at, contact[i]), offsets[i])
        maps.points[i] = side.p_object
        maps.frames[i] = side.frame
        arm = side.p_object - centre
        for j in range(3):
            moment = _cross(arm, side.frame[j])
            for a in range(3):
                maps.G[a, 4 * i + j] = side.frame[j, a]
                maps.G[3 + a, 4 * i + j] = moment[a]
        for a in range(3):
            maps.G[3 + a, 4 * i + 3] = side.frame[0, a]
        moves = t.tree.moves[t.link[2 * contact[i]]]
        for k in range(len(origins)):
            if not moves[k]:
                continue
            for j in range(4):
                effort = _effort(t.tree.prismatic[k], origins[k], axes[k], side, j)
                for c in range(len(q)):
                    maps.T[c, 4 * i + j] += t.coupling[k, c] * effort
    return maps


@compiled
def _effort(prismatic: bool, origin: Array, axis: Array, side: _Side, j: int) -> float:
    """What a joint does for component j of a contact vector."""
    if j == 3:
        return 0.0 if prismatic else _dot(axis, side.frame[0])
    return _dot(axis if prismatic else _cross(axis, side.p_hand - origin), side.frame[j])


@compiled
def maps_slope(
    t: ContactTables,
    q: Array,
    R: Array,
    p: Array,
    params: Array,
    centre_object: Array,
    contact: Indices,
    offsets: Array,
    W_G: Array,
    W_T: Array,
) -> Array:
    """Derivative (n_tangent,) of the sum of W_G * G and W_T * T.

    Args:
        t: the task's contacts.
        q: independent joints.
        R: rotation (3, 3) of the object.
        p: position (3,) of the object in m.
        params: parameters of patches.
        centre_object: centre of mass (3,) in the object's frame, in m.
        contact: which contact each force point belongs to (m,); see `ForcePoints`.
        offsets: where it is (m, 2), in m.
        W_G: (6, 4 m)
        W_T: (n_independent, 4 m)
    """
    at = contact_frames(t, q, R, p, params)
    _, origins, axes = _axes(t, q)
    slope = np.zeros(len(q) + 6 + len(params))
    centre = _placed(R, p, centre_object)
    J_centre = np.zeros((3, len(slope)))
    for a in range(3):
        b, c = (a + 1) % 3, (a + 2) % 3
        J_centre[a, len(q) + a] = 1.0
        J_centre[a, len(q) + 3 + b] = centre[c] - p[c]
        J_centre[a, len(q) + 3 + c] = p[b] - centre[b]
    by_joint = np.zeros(len(origins))
    for i in range(len(contact)):
        side = _beside(_contact(t, at, contact[i]), offsets[i])
        W = np.ascontiguousarray(W_G[:, 4 * i : 4 * i + 4].T)
        _add_wrenches(side, side.p_object - centre, side.J_object - J_centre, W, slope)
        V = np.zeros((len(origins), 4))
        for k in range(len(origins)):
            for c in range(len(q)):
                for j in range(4):
                    V[k, j] += t.coupling[k, c] * W_T[c, 4 * i + j]
        _add_efforts(t, t.tree.moves[t.link[2 * contact[i]]], origins, axes, side, V, slope, by_joint)
    for k in range(len(origins)):
        for c in range(len(q)):
            slope[c] += t.coupling[k, c] * by_joint[k]
    return slope


@compiled
def _add_wrenches(side: _Side, arm: Array, J_arm: Array, W: Array, slope: Array) -> None:
    """One contact's part of W_G . G; W (4, 6) has a row for each component."""
    for j in range(3):
        force, moment = W[j, :3], W[j, 3:]
        _add(force + _cross(moment, arm), side.J_frame[j], slope)
        _add(_cross(side.frame[j], moment), J_arm, slope)
    _add(W[3, 3:], side.J_frame[0], slope)


@compiled
def _add_efforts(
    t: ContactTables,
    moves: Mask,
    origins: Array,
    axes: Array,
    side: _Side,
    V: Array,
    slope: Array,
    by_joint: Array,
) -> None:
    """One contact's part of W_T . T; V (n_joints, 4) are the weights of joints.

    The part that comes from how joints move each other's axes goes to `by_joint` (n_joints,).
    """
    for k in range(len(origins)):
        if not moves[k]:
            continue
        prismatic = t.tree.prismatic[k]
        force = V[k, 0] * side.frame[0] + V[k, 1] * side.frame[1] + V[k, 2] * side.frame[2]
        # What multiplies the change of the axis' direction, and of its origin.
        if prismatic:
            by_axis, by_origin = force, np.zeros(3)
            lever = axes[k]
        else:
            lever = _cross(axes[k], side.p_hand - origins[k])
            by_axis = _cross(side.p_hand - origins[k], force) + V[k, 3] * side.frame[0]
            by_origin = -_cross(force, axes[k])
            _add(-by_origin, side.J_hand, slope)
            _add(V[k, 3] * axes[k], side.J_frame[0], slope)
        for j in range(3):
            _add(V[k, j] * lever, side.J_frame[j], slope)
        for before in range(k):  # joints come in the order of links, parents first
            if not moves[before]:
                continue
            if t.tree.prismatic[before]:
                by_joint[before] += _dot(by_origin, axes[before])
            else:
                by_joint[before] += _dot(by_axis, _cross(axes[before], axes[k]))
                by_joint[before] += _dot(by_origin, _cross(axes[before], origins[k] - origins[before]))


@compiled
def _axes(t: ContactTables, q: Array) -> tuple[Array, Array, Array]:
    """Poses of links, origins and directions of joints, as `place_links` has them."""
    tree = t.tree
    return place_links(
        tree.parents, tree.n_axes, tree.T_parent_link0, tree.directions, tree.prismatic, joint_vector(t, q)
    )


@compiled
def _contact(t: ContactTables, at: ContactFrames, i: int) -> _Side:
    """Contact i; a cap's point is the one that faces the other side."""
    h, o = 2 * i, 2 * i + 1
    n = at.J_p.shape[2]
    inward, J_inward = np.zeros(3), np.zeros((3, n))
    if t.kind[o] != CAP:
        inward[:] = -at.directions[o, 0]
        J_inward[:] = -at.J_directions[o, 0]
    elif t.kind[h] != CAP:
        inward[:] = at.directions[h, 0]
        J_inward[:] = at.J_directions[h, 0]
    else:
        inward[:] = at.p[o] - at.p[h]
        J_inward[:] = at.J_p[o] - at.J_p[h]
        _normalise(inward, J_inward)
    frame, J_frame = np.zeros((3, 3)), np.zeros((3, 3, n))
    _put_frame(inward, J_inward, frame, J_frame)
    return _Side(
        at.p[o] - t.radius[o] * inward,
        at.J_p[o] - t.radius[o] * J_inward,
        at.p[h] + t.radius[h] * inward,
        at.J_p[h] + t.radius[h] * J_inward,
        frame,
        J_frame,
    )


@compiled
def _beside(side: _Side, offset: Array) -> _Side:
    """The same contact at a point beside its own, by (2,) along its tangents."""
    if offset[0] == 0.0 and offset[1] == 0.0:
        return side
    shift = offset[0] * side.frame[1] + offset[1] * side.frame[2]
    J_shift = offset[0] * side.J_frame[1] + offset[1] * side.J_frame[2]
    return _Side(
        side.p_object + shift,
        side.J_object + J_shift,
        side.p_hand + shift,
        side.J_hand + J_shift,
        side.frame,
        side.J_frame,
    )


@compiled
def _put_frame(normal: Array, J_normal: Array, frame: Array, J_frame: Array) -> None:
    """The normal with the tangents of `perpendicular`, and derivatives."""
    least = 0
    for a in range(1, 3):
        if abs(normal[a]) < abs(normal[least]):
            least = a
    frame[0] = normal
    J_frame[0] = J_normal
    # normal x e_least
    b, c = (least + 1) % 3, (least + 2) % 3
    first, J_first = np.zeros(3), np.zeros(J_normal.shape)
    first[b], first[c] = normal[c], -normal[b]
    J_first[b], J_first[c] = J_normal[c], -J_normal[b]
    _normalise(first, J_first)
    frame[1] = first
    J_frame[1] = J_first
    frame[2] = _cross(normal, first)
    for a in range(3):
        b, c = (a + 1) % 3, (a + 2) % 3
        J_frame[2, a] = (
            J_normal[b] * first[c] + normal[b] * J_first[c] - J_normal[c] * first[b] - normal[c] * J_first[b]
        )


@compiled
def _normalise(v: Array, J: Array) -> None:
    """Scales a vector (3,) to unit length, and its derivatives (3, n) to match, in place."""
    length = np.sqrt(_dot(v, v))
    v /= length
    J /= length
    for k in range(J.shape[1]):
        along = v[0] * J[0, k] + v[1] * J[1, k] + v[2] * J[2, k]
        for a in range(3):
            J[a, k] -= v[a] * along


@compiled
def _add(by: Array, J: Array, slope: Array) -> None:
    """Adds by . J, with `by` (3,) and J (3, n), to `slope` (n,)."""
    for a in range(3):
        for k in range(len(slope)):
            slope[k] += by[a] * J[a, k]


@compiled
def _placed(R: Array, p: Array, x: Array) -> Array:
    out = np.empty(3)
    for a in range(3):
        out[a] = _dot(R[a], x) + p[a]
    return out


@compiled
def _dot(x: Array, y: Array) -> float:
    return float(x[0] * y[0] + x[1] * y[1] + x[2] * y[2])


@compiled
def _cross(x: Array, y: Array) -> Array:
    out = np.empty(3)
    out[0] = x[1] * y[2] - x[2] * y[1]
    out[1] = x[2] * y[0] - x[0] * y[2]
    out[2] = x[0] * y[1] - x[1] * y[0]
    return out
