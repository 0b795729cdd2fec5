"""The contacts of a task as smooth equations in joints, object pose and patch parameters.

Around a solution these equations define the contact manifold, on which the local search lands and along
which retraction moves. They say the same as equations (15)-(25) of the paper with the unit normals
eliminated:

- cap against patch or point: the sphere's centre lies on the offset surface, c = o + r n_object (3 rows);
- cap against cap: the centres are r1 + r2 apart (1 row);
- otherwise: the points coincide (3 rows) and the hand's normal is perpendicular to the object's tangents
  (2 rows), unless the task leaves the normals room: then an inequality says so;
- where the task fixes the object, 6 rows more say so.
"""

from copy import copy
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...base.numeric.arrays import Array, Indices
from ...objects import Task
from .frames import ContactFrames, contact_frames
from .kernel import is_feasible, largest_error, move, project, put_equations, put_inequalities
from .state import State
from .tables import CAP, ContactTables, contact_tables

__all__ = ["ContactManifold", "ContactPoint"]


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
        self.tables: ContactTables = contact_tables(task)
        self.exact_tables = contact_tables(task, exact=True) if task.has_room else self.tables
        self.n_q = len(self.hand.independent)
        self.n_params = len(self.tables.lower) - self.n_q
        self.n_tangent = self.n_q + 6 + self.n_params

    @property
    def lower(self) -> Array:
        """Lower limits of (q, params), shape (n_independent + n_params,)."""
        return self.tables.lower

    @property
    def upper(self) -> Array:
        """Upper limits of (q, params), shape (n_independent + n_params,)."""
        return self.tables.upper

    def within(self, lower: Array, upper: Array) -> "ContactManifold":
        """The same with other limits of (q, params), each (n_independent + n_params,)."""
        other = copy(self)
        other.tables = self.tables._replace(lower=lower, upper=upper)
        is_exact = self.exact_tables is self.tables
        other.exact_tables = (
            other.tables if is_exact else self.exact_tables._replace(lower=lower, upper=upper)
        )
        return other

    @cached_property
    def bounded(self) -> Indices:
        """Indices in a tangent vector of the coordinates (q, params) that have limits."""
        return np.concatenate([np.arange(self.n_q), self.n_q + 6 + np.arange(self.n_params)])

    def retract(self, state: State, dx: Array) -> State:
        """The state that a tangent step leads to; limited coordinates are clipped to their limits."""
        x = state.copies()
        move(self.tables, *x, np.ascontiguousarray(dx), 1.0)
        return State(*x)

    def residual(self, state: State) -> Array:
        """Values of the contact equations, in m."""
        return self.linearise(state)[0]

    def linearise(self, state: State) -> tuple[Array, Array]:
        """Residual (m,) and Jacobian (m, n_tangent) of the contact equations."""
        c, J = np.empty(self.tables.n_rows), np.empty((self.tables.n_rows, self.n_tangent))
        x = state.copies()
        put_equations(self.tables, contact_frames(self.tables, *x), x[1], x[2], c, J)
        return c, J

    def error_m(self, state: State) -> float:
        """The largest absolute value of the contact equations, in m."""
        return float(largest_error(self.tables, *state.copies()))

    def inequalities(self, state: State) -> tuple[Array, Array]:
        """Values g (k,) and Jacobian (k, n_tangent) of g(state) >= 0: normals lie within caps, or face.

        For a cap g = cos(angle to the cap's axis) - cos(half angle); where neither side is one, g is the
        cosine between the hand's normal and the reverse of the object's, and where these have room, the next
        g is the sine of the room less that of their angle. Limits of q and params are apart.
        """
        g, G = np.empty(self.tables.n_inequalities), np.empty((self.tables.n_inequalities, self.n_tangent))
        put_inequalities(self.tables, contact_frames(self.tables, *state.copies()), g, G)
        return g, G

    def contact_points(self, state: State) -> list[ContactPoint]:
        """The points that touch, contact by contact; a cap's point is the one that faces the other side."""
        at = contact_frames(self.tables, *state.copies())
        points = []
        for hand in range(0, len(at.p), 2):
            n_object, n_hand = self._normal(at, hand + 1, hand), self._normal(at, hand, hand + 1)
            p_object, p_hand = (
                at.p[side] + self.tables.radius[side] * n
                for side, n in ((hand + 1, n_object), (hand, n_hand))
            )
            points.append(ContactPoint(p_object, n_object, p_hand, n_hand))
        return points

    def is_feasible(self, state: State, tolerance: float = 1e-9) -> bool:
        """Whether limits, patch bounds, caps and facing normals hold (the equations are apart)."""
        x = state.copies()
        return bool(is_feasible(self.tables, contact_frames(self.tables, *x), x[0], x[3], tolerance))

    def project(self, state: State, *, tolerance_m: float = 1e-12, max_steps: int = 20) -> State | None:
        """The nearest solution of the contact equations that Newton's method finds, or None.

        Least-norm Gauss-Newton steps; a coordinate that would leave its limits is held there. Caps are not
        enforced: see `is_feasible`.
        """
        x = state.copies()
        steps = project(self.tables, *x, tolerance_m, max_steps)
        if steps < 0:
            return None
        return State(*x) if steps else state

    def align(self, state: State) -> State:
        """The state next to one that solves the task, with normals exactly opposed if there is one."""
        if self.exact_tables is self.tables:
            return state
        x = state.copies()
        if project(self.exact_tables, *x, 1e-12, 20) <= 0:
            return state
        aligned = State(*x)
        return aligned if self.is_feasible(aligned) else state

    def _normal(self, at: ContactFrames, own: int, other: int) -> Array:
        """A side's contact normal (3,); a cap's is against the other side's, or towards its centre."""
        if self.tables.kind[own] != CAP:
            return at.directions[own, 0].copy()
        if self.tables.kind[other] != CAP:
            return -at.directions[other, 0]
        apart = at.p[other] - at.p[own]
        return apart / np.sqrt(apart @ apart)
