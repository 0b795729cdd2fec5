"""The contacts of a task as smooth equations in joints, object pose and patch parameters.

Around a solution these equations define the contact manifold, on which the local search lands and
along which retraction moves. They say the same as equations (15)-(25) of the paper with the unit normals eliminated:

- cap against patch or point: the sphere's centre lies on the offset surface, c = o + r n_object (3 rows);
- cap against cap: the centres are r1 + r2 apart (1 row);
- otherwise: the points coincide (3 rows) and the hand's normal is perpendicular to the object's tangents
  (2 rows).
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..geometry import Cap, Patch, PointRegion
from ..geometry.transforms import perpendicular, rotation_exp, skew
from ..hands.kinematics import jacobian_from_axes, joint_axes
from ..objects import Contact, Task
from .state import State

__all__ = ["ContactManifold", "ContactPoint"]

Array = NDArray[np.float64]
# Rows that compare directions are weighed as if they acted at this arm, so that all rows are in metres.
_DIRECTION_ARM_M = 0.02


@dataclass(frozen=True, eq=False)
class ContactPoint:
    """One contact of a state, in the palm frame.

    Attributes:
        p_object: point (3,) of the object's region in m.
        n_object: unit outward normal (3,) of the object there.
        p_hand: point (3,) of the hand's region in m.
        n_hand: unit outward normal (3,) of the hand there; opposite to `n_object` at a solution.
    """

    p_object: Array
    n_object: Array
    p_hand: Array
    n_hand: Array

    @property
    def gap_m(self) -> float:
        """Distance between the two points."""
        return float(np.linalg.norm(self.p_hand - self.p_object))

    @property
    def normal_angle_rad(self) -> float:
        """Angle between the hand's normal and the reverse of the object's."""
        sine = np.linalg.norm(np.cross(self.n_hand, self.n_object))
        return float(np.arctan2(sine, -self.n_hand @ self.n_object))


@dataclass(frozen=True, eq=False)
class _Side:
    """A region's point and directions with their derivatives, in the palm frame.

    Columns of derivatives are those of the tangent space (n_tangent).
    """

    p: Array
    J_p: Array
    n: Array | None  # unit normal; None for a cap, which takes the other side's
    J_n: Array
    tangents: Array  # (2, 3) unit tangents
    J_tangents: Array  # (2, 3, n_tangent)


class ContactManifold:
    """The contact equations of a task, their derivatives, limits and projection.

    A tangent vector (n_tangent,) is [dq (n_independent), dp (3), dw (3), dparams (n_params)]: dp moves the
    object in the palm frame (m), dw turns it about axes of the palm frame (rad), R <- exp(dw) R.
    """

    def __init__(self, task: Task):
        self.task = task
        self.hand = task.hand
        self.n_q = len(self.hand.independent)
        self._slots: list[tuple[slice, slice]] = []
        start = 0
        for contact in task.contacts:
            ends = []
            for region in (contact.hand.region, contact.object.region):
                count = 2 if isinstance(region, Patch) else 0
                ends.append(slice(start, start + count))
                start += count
            self._slots.append((ends[0], ends[1]))
        self.n_params = start
        self.n_tangent = self.n_q + 6 + self.n_params

    @cached_property
    def lower(self) -> Array:
        """Lower limits of (q, params), shape (n_independent + n_params,)."""
        return np.concatenate([self.task.limits[:, 0], np.zeros(self.n_params)])

    @cached_property
    def upper(self) -> Array:
        """Upper limits of (q, params), shape (n_independent + n_params,)."""
        return np.concatenate([self.task.limits[:, 1], np.ones(self.n_params)])

    @cached_property
    def bounded(self) -> NDArray[np.int64]:
        """Indices in a tangent vector of the coordinates (q, params) that have limits."""
        return np.concatenate([np.arange(self.n_q), self.n_q + 6 + np.arange(self.n_params)])

    def retract(self, state: State, dx: Array) -> State:
        """The state that a tangent step leads to; limited coordinates are clipped to their limits."""
        n = self.n_q
        q = np.clip(state.q + dx[:n], self.lower[:n], self.upper[:n])
        params = np.clip(state.params + dx[n + 6 :], 0.0, 1.0)
        R = rotation_exp(dx[n + 3 : n + 6]) @ state.R_palm_object
        # Rounding makes long products of rotations drift, so the factor nearest to R is taken.
        U, _, Vt = np.linalg.svd(R)
        return State(q, U @ Vt, state.p_palm_object + dx[n : n + 3], params)

    def residual(self, state: State) -> Array:
        """Values of the contact equations, in m."""
        return self.linearise(state)[0]

    def linearise(self, state: State) -> tuple[Array, Array]:
        """Residual (m,) and Jacobian (m, n_tangent) of the contact equations."""
        frames = joint_axes(self.hand, self.hand.expand(state.q))
        rows, jacobians = [], []
        for contact, slots in zip(self.task.contacts, self._slots, strict=True):
            c, J = self._contact_rows(contact, slots, state, frames)
            rows.append(c)
            jacobians.append(J)
        return np.concatenate(rows), np.concatenate(jacobians)

    def inequalities(self, state: State) -> tuple[Array, Array]:
        """Values g (k,) and Jacobian (k, n_tangent) of g(state) >= 0: contact normals lie within their caps.

        g = cos(angle to the cap's axis) - cos(half angle), dimensionless; limits of q and params are apart.
        """
        frames = joint_axes(self.hand, self.hand.expand(state.q))
        values, jacobians = [], []
        for contact, slots in zip(self.task.contacts, self._slots, strict=True):
            for cap, own, other in self._caps(contact, slots, state, frames):
                direction, J_direction = self._cap_direction(own, other, cap)
                axis, J_axis = self._cap_axis(contact, cap, state, frames)
                values.append(axis @ direction - np.cos(cap.half_angle_rad))
                jacobians.append(axis @ J_direction + direction @ J_axis)
        if not values:
            return np.zeros(0), np.zeros((0, self.n_tangent))
        return np.array(values), np.array(jacobians)

    def contact_points(self, state: State) -> list[ContactPoint]:
        """The points that touch, contact by contact; a cap's point is the one that faces the other side."""
        frames = joint_axes(self.hand, self.hand.expand(state.q))
        points = []
        for contact, slots in zip(self.task.contacts, self._slots, strict=True):
            hand = self._hand_side(contact, slots[0], state, frames)
            obj = self._object_side(contact, slots[1], state)
            n_object = (
                obj.n if obj.n is not None else (-hand.n if hand.n is not None else _unit(hand.p - obj.p))
            )
            n_hand = hand.n if hand.n is not None else -n_object
            p_hand, p_object = hand.p, obj.p
            if isinstance(contact.hand.region, Cap):
                p_hand = p_hand + contact.hand.region.radius * n_hand
            if isinstance(contact.object.region, Cap):
                p_object = p_object + contact.object.region.radius * n_object
            points.append(ContactPoint(p_object, n_object, p_hand, n_hand))
        return points

    def is_feasible(self, state: State, tolerance: float = 1e-9) -> bool:
        """Whether limits, patch bounds, caps and facing normals hold (the equations are apart)."""
        x = np.concatenate([state.q, state.params])
        if np.any(x < self.lower - tolerance) or np.any(x > self.upper + tolerance):
            return False
        if np.any(self.inequalities(state)[0] < -tolerance):
            return False
        return all(point.n_hand @ point.n_object < 0.0 for point in self.contact_points(state))

    def project(self, state: State, *, tolerance_m: float = 1e-12, max_steps: int = 20) -> State | None:
        """The nearest solution of the contact equations that Newton's method finds, or None.

        Least-norm Gauss-Newton steps; a coordinate that would leave its limits is held there. Caps are not
        enforced: see `is_feasible`.
        """
        held = np.zeros(self.n_tangent, dtype=bool)
        for _ in range(max_steps):
            c, J = self.linearise(state)
            if np.abs(c).max() < tolerance_m:
                return state
            step = np.zeros(self.n_tangent)
            step[~held] = -np.linalg.lstsq(J[:, ~held], c, rcond=1e-10)[0]
            x = np.concatenate([state.q, state.params])
            target = x + step[self.bounded]
            held[self.bounded[(target < self.lower - 1e-15) | (target > self.upper + 1e-15)]] = True
            state = self.retract(state, step)
        c = self.residual(state)
        return state if np.abs(c).max() < 1e3 * tolerance_m else None

    def _contact_rows(
        self,
        contact: Contact,
        slots: tuple[slice, slice],
        state: State,
        frames: tuple[Array, Array, Array],
    ) -> tuple[Array, Array]:
        hand = self._hand_side(contact, slots[0], state, frames)
        obj = self._object_side(contact, slots[1], state)
        on_hand, on_object = contact.hand.region, contact.object.region
        apart, J_apart = hand.p - obj.p, hand.J_p - obj.J_p
        if isinstance(on_hand, Cap) and isinstance(on_object, Cap):
            distance = np.linalg.norm(apart)
            c = np.array([distance - on_hand.radius - on_object.radius])
            return c, (apart / distance)[None, :] @ J_apart
        if isinstance(on_hand, Cap):
            assert obj.n is not None
            return apart - on_hand.radius * obj.n, J_apart - on_hand.radius * obj.J_n
        if isinstance(on_object, Cap):
            assert hand.n is not None
            return apart + on_object.radius * hand.n, J_apart + on_object.radius * hand.J_n
        assert hand.n is not None
        c_dir = obj.tangents @ hand.n
        J_dir = obj.tangents @ hand.J_n + np.einsum("k,ikt->it", hand.n, obj.J_tangents)
        arm = _DIRECTION_ARM_M
        return np.concatenate([apart, arm * c_dir]), np.concatenate([J_apart, arm * J_dir])

    def _hand_side(
        self, contact: Contact, slot: slice, state: State, frames: tuple[Array, Array, Array]
    ) -> _Side:
        Ts, origins, directions = frames
        link = contact.hand.link
        R, t = Ts[link][:3, :3], Ts[link][:3, 3]
        p_link, derivatives = self._local(contact.hand.region, state.params[slot])
        p = R @ p_link + t
        J_p, J_w = jacobian_from_axes(self.hand, origins, directions, link, p)
        E = self.hand.coupling_matrix
        motion_p, motion_w = np.zeros((3, self.n_tangent)), np.zeros((3, self.n_tangent))
        motion_p[:, : self.n_q], motion_w[:, : self.n_q] = J_p @ E, J_w @ E
        return self._side(contact.hand.region, R, p, motion_p, motion_w, derivatives, slot, state)

    def _object_side(self, contact: Contact, slot: slice, state: State) -> _Side:
        R = state.R_palm_object
        p_object, derivatives = self._local(contact.object.region, state.params[slot])
        arm = R @ p_object
        motion_p, motion_w = np.zeros((3, self.n_tangent)), np.zeros((3, self.n_tangent))
        n = self.n_q
        motion_p[:, n : n + 3], motion_p[:, n + 3 : n + 6] = np.eye(3), -skew(arm)
        motion_w[:, n + 3 : n + 6] = np.eye(3)
        p = arm + state.p_palm_object
        return self._side(contact.object.region, R, p, motion_p, motion_w, derivatives, slot, state)

    @staticmethod
    def _local(region: Cap | Patch | PointRegion, params: Array) -> tuple[Array, Array]:
        """The region's point (3,) in its body's frame with derivatives (3, 2) by its parameters."""
        match region:
            case Cap():
                return region.centre, np.zeros((3, 0))
            case PointRegion():
                return region.point, np.zeros((3, 0))
            case Patch():
                u, v = params
                patch = region.patch
                return patch.evaluate(u, v), np.column_stack(
                    [patch.du.evaluate(u, v), patch.dv.evaluate(u, v)]
                )

    def _side(
        self,
        region: Cap | Patch | PointRegion,
        R: Array,
        p: Array,
        motion_p: Array,
        motion_w: Array,
        derivatives: Array,
        slot: slice,
        state: State,
    ) -> _Side:
        """Moves a region's point, normal and tangents with its body (`motion_*`) and its parameters."""
        columns = slice(self.n_q + 6 + slot.start, self.n_q + 6 + slot.stop)
        J_p = motion_p.copy()
        J_p[:, columns] += R @ derivatives
        if isinstance(region, Cap):
            empty = np.zeros((3, self.n_tangent))
            return _Side(p, J_p, None, empty, np.zeros((2, 3)), np.zeros((2, 3, self.n_tangent)))
        if isinstance(region, PointRegion):
            local, local_derivatives = (
                np.vstack([region.normal, perpendicular(region.normal)]),
                np.zeros((3, 3, 0)),
            )
        else:
            local, local_derivatives = _patch_directions(region, state.params[slot])
        vectors = local @ R.T
        J = np.stack([-skew(v) @ motion_w for v in vectors])
        J[:, :, columns] += np.einsum("ab,ibk->iak", R, local_derivatives)
        return _Side(p, J_p, vectors[0], J[0], vectors[1:], J[1:])

    def _caps(
        self, contact: Contact, slots: tuple[slice, slice], state: State, frames: tuple[Array, Array, Array]
    ) -> list[tuple[Cap, _Side, _Side]]:
        hand = self._hand_side(contact, slots[0], state, frames)
        obj = self._object_side(contact, slots[1], state)
        pairs = [(contact.hand.region, hand, obj), (contact.object.region, obj, hand)]
        return [(region, own, other) for region, own, other in pairs if isinstance(region, Cap)]

    @staticmethod
    def _cap_direction(own: _Side, other: _Side, cap: Cap) -> tuple[Array, Array]:
        """The cap's contact normal in the palm frame: against the other side's, or towards its centre."""
        if other.n is not None:
            return -other.n, -other.J_n
        apart, J_apart = other.p - own.p, other.J_p - own.J_p
        return _unit(apart), _unit_jacobian(apart, J_apart)

    def _cap_axis(
        self, contact: Contact, cap: Cap, state: State, frames: tuple[Array, Array, Array]
    ) -> tuple[Array, Array]:
        motion_w = np.zeros((3, self.n_tangent))
        if cap is contact.hand.region:
            link = contact.hand.link
            R = frames[0][link][:3, :3]
            J_w = jacobian_from_axes(self.hand, frames[1], frames[2], link, np.zeros(3))[1]
            motion_w[:, : self.n_q] = J_w @ self.hand.coupling_matrix
        else:
            R = state.R_palm_object
            motion_w[:, self.n_q + 3 : self.n_q + 6] = np.eye(3)
        axis = R @ cap.axis
        return axis, -skew(axis) @ motion_w


def _patch_directions(region: Patch, params: Array) -> tuple[Array, Array]:
    """Unit normal and unit tangents (3, 3) of a patch, one a row, with derivatives (3, 3, 2)."""
    u, v = params
    patch = region.patch
    raw = np.array([patch.normal.evaluate(u, v), patch.du.evaluate(u, v), patch.dv.evaluate(u, v)])
    slopes = [[_slope(piece, axis, u, v) for axis in (0, 1)] for piece in (patch.normal, patch.du, patch.dv)]
    units = np.array([_unit(r) for r in raw])
    derivatives = np.array([_unit_jacobian(r, np.column_stack(s)) for r, s in zip(raw, slopes, strict=True)])
    return units, derivatives


def _slope(patch, axis: int, u: float, v: float) -> Array:  # type: ignore[no-untyped-def]
    """Derivative (3,) of a patch by u or v, zero where it does not depend on it."""
    if patch.degree[axis] == 0:
        return np.zeros(3)
    return (patch.du if axis == 0 else patch.dv).evaluate(u, v)


def _unit(v: Array) -> Array:
    return v / np.linalg.norm(v)


def _unit_jacobian(v: Array, J: Array) -> Array:
    """Derivative of v / |v| from that of v (3, k)."""
    length = np.linalg.norm(v)
    n = v / length
    return (J - np.outer(n, n @ J)) / length
