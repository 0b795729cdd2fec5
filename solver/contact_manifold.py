"""The contacts of a task as smooth equations in joints, object pose and patch parameters.

Around a solution these equations define the contact manifold, on which the local search lands and along
which retraction moves. They say the same as equations (15)-(25) of the paper with the unit normals
eliminated:

- cap against patch or point: the sphere's centre lies on the offset surface, c = o + r n_object (3 rows);
- cap against cap: the centres are r1 + r2 apart (1 row);
- otherwise: the points coincide (3 rows) and the hand's normal is perpendicular to the object's tangents
  (2 rows);
- where the task fixes the object, 6 rows more say so.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..geometry.transforms import rotation_exp
from ..hands.kinematics import joint_axes
from ..objects import Task
from .moving_region import LocalRegion, Side, on_link, on_object
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


class ContactManifold:
    """The contact equations of a task, their derivatives, limits and projection.

    A tangent vector (n_tangent,) is [dq (n_independent), dp (3), dw (3), dparams (n_params)]: dp moves the
    object in the palm frame (m), dw turns it about axes of the palm frame (rad), R <- exp(dw) R.
    """

    def __init__(self, task: Task):
        self.task = task
        self.hand = task.hand
        self.n_q = len(self.hand.independent)
        self._regions: list[tuple[LocalRegion, LocalRegion]] = []
        self.n_params = 0
        for contact in task.contacts:
            on_hand = LocalRegion(contact.hand.region, self.n_params)
            on_object = LocalRegion(contact.object.region, on_hand.columns.stop)
            self._regions.append((on_hand, on_object))
            self.n_params = on_object.columns.stop
        self.n_tangent = self.n_q + 6 + self.n_params
        # Equations, inequalities and contact points of a state are asked for one after the other.
        self._last: tuple[State, list[tuple[Side, Side]]] | None = None

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
        x = np.concatenate([state.q, state.params]) + dx[self.bounded]
        x = np.minimum(np.maximum(x, self.lower), self.upper)
        R = rotation_exp(dx[n + 3 : n + 6]) @ state.R_palm_object
        # Rounding makes long products of rotations drift; a step of Newton's method for the nearest
        # rotation squares the error.
        R = 1.5 * R - 0.5 * R @ (R.T @ R)
        return State(x[:n], R, state.p_palm_object + dx[n : n + 3], x[n:])

    def residual(self, state: State) -> Array:
        """Values of the contact equations, in m."""
        return self.linearise(state)[0]

    def linearise(self, state: State) -> tuple[Array, Array]:
        """Residual (m,) and Jacobian (m, n_tangent) of the contact equations."""
        rows = [_equations(hand, obj) for hand, obj in self._sides(state)]
        if self.task.T_palm_object is not None:
            rows.append(_fixed_object(state, self.task.T_palm_object, self.n_tangent))
        return np.concatenate([c for c, _ in rows]), np.concatenate([J for _, J in rows])

    def inequalities(self, state: State) -> tuple[Array, Array]:
        """Values g (k,) and Jacobian (k, n_tangent) of g(state) >= 0: normals lie within caps, or face.

        For a cap g = cos(angle to the cap's axis) - cos(half angle); where neither side is one, g is the
        cosine between the hand's normal and the reverse of the object's. Limits of q and params are apart.
        """
        values, jacobians = [], []
        for sides in self._sides(state):
            if not (sides[0].is_cap or sides[1].is_cap):
                (n, J_n), (o, J_o) = ((side.directions[0], side.J_directions[0]) for side in sides)
                values.append(-n @ o)
                jacobians.append(-(n @ J_o + o @ J_n))
            for own, other in (sides, sides[::-1]):
                if own.cos_half_angle is None:
                    continue
                normal, J_normal = _cap_normal(own, other)
                axis, J_axis = own.directions[0], own.J_directions[0]
                values.append(axis @ normal - own.cos_half_angle)
                jacobians.append(axis @ J_normal + normal @ J_axis)
        return np.array(values), np.array(jacobians).reshape(-1, self.n_tangent)

    def contact_points(self, state: State) -> list[ContactPoint]:
        """The points that touch, contact by contact; a cap's point is the one that faces the other side."""
        points = []
        for hand, obj in self._sides(state):
            n_hand, n_object = (
                _cap_normal(own, other)[0] if own.is_cap else own.directions[0].copy()
                for own, other in ((hand, obj), (obj, hand))
            )
            p_object, p_hand = obj.p + obj.radius * n_object, hand.p + hand.radius * n_hand
            points.append(ContactPoint(p_object, n_object, p_hand, n_hand))
        return points

    def is_feasible(self, state: State, tolerance: float = 1e-9) -> bool:
        """Whether limits, patch bounds, caps and facing normals hold (the equations are apart)."""
        x = np.concatenate([state.q, state.params])
        if np.any(x < self.lower - tolerance) or np.any(x > self.upper + tolerance):
            return False
        return not np.any(self.inequalities(state)[0] < -tolerance)

    def project(self, state: State, *, tolerance_m: float = 1e-12, max_steps: int = 20) -> State | None:
        """The nearest solution of the contact equations that Newton's method finds, or None.

        Least-norm Gauss-Newton steps; a coordinate that would leave its limits is held there. Caps are not
        enforced: see `is_feasible`.
        """
        free = np.ones(self.n_tangent, dtype=bool)
        for _ in range(max_steps):
            c, J = self.linearise(state)
            if np.abs(c).max() < tolerance_m:
                return state
            step = np.zeros(self.n_tangent)
            step[free] = -np.linalg.lstsq(J[:, free], c, rcond=1e-10)[0]
            target = np.concatenate([state.q, state.params]) + step[self.bounded]
            free[self.bounded[(target < self.lower - 1e-15) | (target > self.upper + 1e-15)]] = False
            state = self.retract(state, step)
        c = self.residual(state)
        return state if np.abs(c).max() < 1e3 * tolerance_m else None

    def _sides(self, state: State) -> list[tuple[Side, Side]]:
        """Both sides of every contact in the palm frame; kept for the state that was last asked for."""
        last = self._last
        if last is not None and last[0] is state:
            return last[1]
        frames = joint_axes(self.hand, self.hand.expand(state.q))
        T_palm_object = state.T_palm_object
        sides = [
            (
                on_link(of_hand, self.hand, contact.hand.link, frames, state),
                on_object(of_object, T_palm_object, state),
            )
            for contact, (of_hand, of_object) in zip(self.task.contacts, self._regions, strict=True)
        ]
        self._last = (state, sides)
        return sides


def _equations(hand: Side, obj: Side) -> tuple[Array, Array]:
    """The rows of one contact and their Jacobian; see the head of this module."""
    apart, J_apart = hand.p - obj.p, hand.J_p - obj.J_p
    if hand.is_cap and obj.is_cap:
        distance = np.sqrt(apart @ apart)
        return np.array([distance - hand.radius - obj.radius]), (apart / distance)[None, :] @ J_apart
    n_hand, J_n_hand = hand.directions[0], hand.J_directions[0]
    if hand.is_cap:
        return apart - hand.radius * obj.directions[0], J_apart - hand.radius * obj.J_directions[0]
    if obj.is_cap:
        return apart + obj.radius * n_hand, J_apart + obj.radius * J_n_hand
    tangents = obj.directions[1:]
    c = _DIRECTION_ARM_M * (tangents @ n_hand)
    J = _DIRECTION_ARM_M * (tangents @ J_n_hand + n_hand @ obj.J_directions[1:])
    return np.concatenate([apart, c]), np.concatenate([J_apart, J])


def _fixed_object(state: State, T: Array, n_tangent: int) -> tuple[Array, Array]:
    """The object is at pose T: rows of its shift, and of its turn as the skew part of R T^-1."""
    n_q = len(state.q)
    M = state.R_palm_object @ T[:3, :3].T
    turn = 0.5 * np.array([M[2, 1] - M[1, 2], M[0, 2] - M[2, 0], M[1, 0] - M[0, 1]])
    c = np.concatenate([state.p_palm_object - T[:3, 3], _DIRECTION_ARM_M * turn])
    J = np.zeros((6, n_tangent))
    J[:3, n_q : n_q + 3] = np.eye(3)
    J[3:, n_q + 3 : n_q + 6] = 0.5 * _DIRECTION_ARM_M * (np.trace(M) * np.eye(3) - M)
    return c, J


def _cap_normal(cap: Side, other: Side) -> tuple[Array, Array]:
    """A cap's contact normal in the palm frame: against the other side's, or towards its centre."""
    if not other.is_cap:
        return -other.directions[0], -other.J_directions[0]
    apart, J_apart = other.p - cap.p, other.J_p - cap.J_p
    distance = np.sqrt(apart @ apart)
    n = apart / distance
    return n, (J_apart - np.outer(n, n @ J_apart)) / distance
