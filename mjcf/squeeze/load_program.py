"""The linear program behind a squeeze: its rows, for whoever solves or climbs it (see `squeeze`).

The unknowns x are the shares of all cone edges in each state's contact vector, state by state, and last the
load factor s:

    A_eq x = 0,  A_ub x <= b_ub,  x >= 0.

What a state is depends on the test. A lift has one for the squeeze alone and one for each direction of
gravity; a turn and a press have one, as the stand takes up whatever does not balance.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...base.numeric.arrays import Array
from ...geometry import cone_edges
from ...objects import LiftTest, PressTest, Task, TurnTest
from ...solver import State
from ..settings import HoldSettings
from .elastic_response import elastic_response
from .linear_program import Rows, largest_last
from .sparse_rows import SparseRows
from .statics import ARM_M, WRENCH_SCALE, Statics

__all__ = [
    "STEEPEST_RAD",
    "LoadProgram",
    "hinge_torques",
    "largest_load",
    "load_program",
]

STEEPEST_RAD = 1.45
"""Half angle beyond which no cone is widened."""


@dataclass(frozen=True, eq=False)
class LoadProgram:
    """What the linear program is made of; every cone edge has unit normal force.

    Attributes:
        edges: (4 m, n_edges) edges of all cones as columns, at m force points of n contacts.
        by_contact: (n, n_edges) normal force on each contact by each edge.
        balance: (6, n_edges) force in N and scaled torque on the object by each edge.
        effort: (n_independent, n_edges) share of every servo's planned effort.
        loads: (n_loads, 6) scaled wrenches of the load, one a direction of gravity; none where a stand
            carries the object.
        n_states: number of states.
        compose: makes `rows`.
    """

    edges: Array
    by_contact: Array
    balance: Array
    effort: Array
    loads: Array
    n_states: int
    compose: "Callable[[], ProgramRows]"

    @cached_property
    def rows(self) -> "ProgramRows":
        """What unknowns must fulfil; made when asked for, as many a state turns out before not to balance."""
        return self.compose()

    @property
    def n_unknowns(self) -> int:
        """Number of unknowns."""
        return self.n_states * self.edges.shape[1] + 1

    @property
    def leaning(self) -> NDArray[np.bool_]:
        """Which edges (n_edges,) need friction; the others are the normals themselves."""
        return np.abs(np.delete(self.edges, np.s_[::4], axis=0)).max(axis=0) > 0.0

    @property
    def must_balance(self) -> bool:
        """Whether the contacts alone must balance each other: nothing else holds the object."""
        return len(self.loads) > 0

    def contact_vectors(self, x: Array) -> Array:
        """Contact vectors (n_states, m, 4) of a solution."""
        return (x[:-1].reshape(self.n_states, -1) @ self.edges.T).reshape(self.n_states, -1, 4)


@dataclass(frozen=True, eq=False)
class ProgramRows:
    """Rows of a linear program.

    Attributes:
        A_eq: (m, n_unknowns) rows that must be zero.
        A_ub: (k, n_unknowns) rows that must be at most `b_ub`.
        b_ub: (k,) right-hand sides.
        losses: (n,) normal force in N by which the load may relieve each contact, by the elastic response.
    """

    A_eq: SparseRows
    A_ub: SparseRows
    b_ub: Array
    losses: Array


def load_program(
    statics: Statics,
    task: Task,
    state: State,
    settings: HoldSettings,
    *,
    subdivisions: int,
    spin_arms_m: Array,
) -> LoadProgram:
    """The program of a grasp, for the test of its task.

    Args:
        statics: linear maps of the grasp.
        task: the task.
        state: the grasp's.
        settings: friction, gravity and share of the efforts.
        subdivisions: fineness of the cones: 1 gives each 42 edges, 2 gives 162, whose hull reaches 98.5 % of
            the cone.
        spin_arms_m: (n,) arm at which friction resists spin at each contact, wherever in it; see `pads`.
    """
    mu = settings.sliding_friction(task.object)
    cone = cone_edges(mu, mu, subdivisions)
    if not isinstance(task.test, LiftTest):
        cone = np.column_stack([[1.0, 0.0, 0.0, 0.0], cone])  # for plans that spare friction
    edges = _along_diagonal(cone, len(statics.points))
    edges[3::4] *= spin_arms_m[statics.force_points.contact, None]
    by_contact = statics.by_contact @ edges[0::4]
    effort = statics.T @ edges / (settings.planned_effort * statics.effort[:, None])
    limits = [effort, -effort]
    if task.max_normal_force_N is not None:
        limits.append(by_contact / task.max_normal_force_N)
    balance = WRENCH_SCALE[:, None] * (statics.G @ edges)
    rows = _Rows(edges, by_contact, balance, effort, np.vstack(limits))
    match task.test:
        case LiftTest():
            return _lift(rows, statics, settings)
        case TurnTest():
            return _turn(rows, task.test, statics, state, settings)
        case PressTest():
            return _press(rows, task.test, settings)


@dataclass(frozen=True, eq=False)
class _Rows:
    """What all programs share; `limits` (k, n_edges) are at most 1 in every state."""

    edges: Array
    by_contact: Array
    balance: Array
    effort: Array
    limits: Array

    def program(
        self, n_states: int, compose: Callable[[], ProgramRows], loads: Array | None = None
    ) -> LoadProgram:
        """A program with these rows."""
        return LoadProgram(
            edges=self.edges,
            by_contact=self.by_contact,
            balance=self.balance,
            effort=self.effort,
            loads=np.zeros((0, 6)) if loads is None else loads,
            n_states=n_states,
            compose=compose,
        )

    def composed(
        self, n_states: int, A_eq: SparseRows, more: Array | None = None, losses: Array | None = None
    ) -> ProgramRows:
        """Adds the limits of effort and force, after the rows `more` that must be at most zero."""
        A_ub = SparseRows.of(self.limits).along_diagonal(n_states)
        b_ub = np.ones(len(A_ub))
        A_ub = A_ub.beside(SparseRows.of(np.zeros((len(A_ub), 1))))
        if more is not None:
            A_ub = SparseRows.stacked(SparseRows.of(more), A_ub)
            b_ub = np.concatenate([np.zeros(len(more)), b_ub])
        losses = np.zeros(len(self.by_contact)) if losses is None else losses
        return ProgramRows(A_eq, A_ub, b_ub, losses)


def _lift(rows: _Rows, statics: Statics, settings: HoldSettings) -> LoadProgram:
    """G f_0 + s w_0 = 0, G f + s w = 0, and sum f_n = sum f_0n + s dn, in each direction of gravity.

    The weight w_0 is what acts during the squeeze; in most tests it is zero.
    """
    gravity = np.array([settings.resting_direction, *settings.directions])
    weights = np.zeros((len(gravity), 6))
    weights[:, :3] = statics.mass * settings.gravity * gravity
    scaled = weights * WRENCH_SCALE

    def compose() -> ProgramRows:
        normals = elastic_response(statics, weights)[:, 0::4]
        sums, losses = normals.sum(axis=1), np.maximum(0.0, normals[0] - normals[1:]).max(axis=0)
        count, n = len(weights) - 1, rows.edges.shape[1]
        balance = SparseRows.of(rows.balance).along_diagonal(1 + count)
        balance = balance.beside(SparseRows.of(scaled.reshape(-1, 1)))
        hardness = SparseRows.of(-np.ones((count, n)))
        hardness = hardness.beside(SparseRows.of(np.ones((1, n))).along_diagonal(count))
        hardness = hardness.beside(SparseRows.of((sums[0] - sums[1:])[:, None]))
        return rows.composed(1 + count, SparseRows.stacked(balance, hardness), losses=losses)

    return rows.program(len(weights), compose, scaled[1:])


def _along_diagonal(block: Array, count: int) -> Array:
    """A matrix (count m, count n) with `block` (m, n) so many times along its diagonal."""
    m, n = block.shape
    out = np.zeros((count, m, count, n))
    for k in range(count):
        out[k, :, k] = block
    return out.reshape(count * m, count * n)


def _turn(rows: _Rows, test: TurnTest, statics: Statics, state: State, settings: HoldSettings) -> LoadProgram:
    """The torque about the hinge is s times its friction, and every contact presses."""
    torque = hinge_torques(rows.balance / WRENCH_SCALE[:, None], test, statics, state)
    # Half the usual: the harder each contact must press, the fewer grasps meet the torque exactly.
    least = np.full(statics.n_contacts, 0.5 * settings.planned_force_N)
    A_eq = np.append(torque, -test.friction_torque_Nm)[None] / ARM_M
    return rows.program(1, lambda: rows.composed(1, SparseRows.of(A_eq), _at_least(rows, least)))


def hinge_torques(wrenches: Array, test: TurnTest, statics: Statics, state: State) -> Array:
    """Torques (n,) in N m about the hinge of a turn, of wrenches (6, n) about the centre of mass."""
    R, p = state.R_palm_object, state.p_palm_object
    axis = R @ np.array(test.hinge_axis)
    arm = statics.centre - (R @ np.array(test.hinge_point) + p)
    # The torque about the hinge's point is that about the centre of mass plus arm x force.
    return np.asarray(axis @ (wrenches[3:] + np.cross(arm, wrenches[:3].T).T))


def _press(rows: _Rows, test: PressTest, settings: HoldSettings) -> LoadProgram:
    """The normal force is at least s times what is asked; the other contacts press as well."""
    least = np.full(len(rows.by_contact), settings.planned_force_N)
    least[list(test.contacts)] = test.force_N
    none = SparseRows.of(np.zeros((0, rows.edges.shape[1] + 1)))
    return rows.program(1, lambda: rows.composed(1, none, _at_least(rows, least)))


def _at_least(rows: _Rows, least: Array) -> Array:
    """Rows that are at most zero where each contact's normal force is at least s times `least` (n,) in N."""
    return np.column_stack([-rows.by_contact, least])


def largest_load(A_eq: Rows, A_ub: Rows, b_ub: Array, most: float) -> float:
    """The largest last unknown, at most `most`, where A_eq x = 0, A_ub x <= b_ub and x >= 0; 0 for none."""
    optimum = largest_last(A_eq, A_ub, b_ub, most)
    return 0.0 if optimum is None else max(0.0, float(optimum.x[-1]))
