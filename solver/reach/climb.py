"""Configurations that need less friction, or carry more: local search along the contact manifold.

A step minimises the slope of what is asked for over the tangent space, within a trust region, limits and
caps, by a linear program; then the state is projected onto the contacts. What it ends at is computed.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linprog

from ...arrays import Array
from ...cancellation import give_up_if_asked
from ...objects import Task
from ..contacts import ContactManifold, State
from ..statics import UNIT_M, StaticsProblem, point_maps

__all__ = ["HandClimber", "Objective"]

Objective = Callable[[Array], float]
"""What maps (n, 8, 6) of the contacts' points cost; infinite where they are of no use."""

# Trust region in rad, m by `_STEP_M` and shares of patches: at first, at last, and how it changes.
_FIRST, _LAST, _SHRINK, _GROW = 0.2, 1e-4, 0.4, 1.6
_MOST_STEPS = 60
# Forward differences along the tangent space.
_DIFFERENCE = 1e-5
# A step helps where it gains such a share.
_GAIN = 1e-5


@dataclass(frozen=True, eq=False)
class Reached:
    """A state on the contact manifold with what it costs."""

    state: State
    cost: float


class HandClimber:
    """Local search over the configurations of one task.

    Args:
        task: the task.
        problem: statics of its regions.
        objective: what is made small.
    """

    def __init__(self, task: Task, problem: StaticsProblem, objective: Objective):
        self._manifold, self._objective = ContactManifold(task), objective
        self._centre = np.array(problem.form["centre_m"])

    def cost(self, state: State) -> float:
        """What a state costs."""
        points, normals = [], []
        for contact in self._manifold.contact_points(state):
            p = state.R_palm_object.T @ (contact.p_object - state.p_palm_object)
            points.append((p - self._centre) / UNIT_M)
            normals.append(-state.R_palm_object.T @ contact.n_object)
        return self._objective(point_maps(np.array(points), np.array(normals)))

    def climb(self, state: State) -> tuple[State, float]:
        """From a state that solves the task to such that cost less, as far as local search goes."""
        cost, reach = self.cost(state), _FIRST
        for _ in range(_MOST_STEPS):
            give_up_if_asked()
            if reach < _LAST or not np.isfinite(cost):
                break
            there = self._step(state, cost, reach)
            after = np.inf if there is None else self.cost(there)
            if there is not None and after < cost - _GAIN * abs(cost):
                state, cost, reach = there, after, min(_FIRST, _GROW * reach)
            else:
                reach *= _SHRINK
        return state, cost

    def _step(self, state: State, cost: float, reach: float) -> State | None:
        """A state within reach where the slope says it is best; None where none solves the task."""
        manifold = self._manifold
        N = _null_space(manifold.linearise(state)[1])
        if not N.shape[1]:
            return None
        slope = np.array([self.cost(manifold.retract(state, _DIFFERENCE * d)) - cost for d in N.T])
        if not np.isfinite(slope).all() or not slope.any():
            return None
        g, G = manifold.inequalities(state)
        at = np.concatenate([state.q, state.params])
        limited = N[manifold.bounded]
        rows = np.vstack([limited, -limited, -G @ N])
        room = np.concatenate([manifold.upper - at, at - manifold.lower, g])
        found = linprog(
            slope / np.abs(slope).max(), rows, np.maximum(room, 0.0), bounds=(-reach, reach), method="highs"
        )
        if found.status != 0:
            return None
        there = manifold.project(manifold.retract(state, N @ found.x))
        return there if there is not None and manifold.is_feasible(there) else None


def _null_space(J: Array) -> Array:
    """An orthonormal basis (n, d) of the kernel of J (m, n)."""
    _, sizes, Vt = np.linalg.svd(J)
    rank = int((sizes > 1e-9 * sizes.max(initial=0.0)).sum())
    basis: Array = Vt[rank:].T
    return basis
