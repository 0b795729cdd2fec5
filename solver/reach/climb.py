"""Configurations that need less friction, or carry more: local search along the contact manifold.

A step minimises what is asked for, to first order over the tangent space, within a trust region, limits and
caps, by a linear program; then the state is projected onto the contacts. What it ends at is computed.
"""

import numpy as np
from scipy.optimize import linprog

from ...base.machine.cancellation import give_up_if_asked
from ...base.numeric.arrays import Array
from ...objects import Task
from ..contacts import ContactManifold, State
from ..statics import UNIT_M, StaticsProblem, point_maps
from .objectives import Measured, Objective

__all__ = ["HandClimber"]

# Trust region in rad, m and shares of patches: at first, at last, and how it changes; the last climb of
# several, from the best of their ends, takes its time.
_FIRST, _LAST, _SHRINK, _GROW = 0.2, 1e-4, 0.4, 1.6
_SHRINK_AT_LAST = 0.7
_MOST_STEPS = 60
# Linear programs of a step, each but the first with room for what the one before it left out of account.
_CORRECTIONS, _BEYOND = 3, 1.5
# Forward differences along the tangent space.
_DIFFERENCE = 1e-5
# A step helps where it gains such a share.
_GAIN = 1e-5


class HandClimber:
    """Local search over the configurations of one task.

    Args:
        task: the task.
        problem: statics of its regions.
        objective: what is made small.
    """

    def __init__(self, task: Task, problem: StaticsProblem, objective: Objective):
        self._manifold, self._objective = ContactManifold(task), objective
        # Slopes are of the costs beyond limits, too: clipped there, those along the others would be wrong.
        limits = np.full(len(self._manifold.lower), np.inf)
        self._unlimited = self._manifold.within(-limits, limits)
        self._centre = np.array(problem.form["centre_m"])

    def cost(self, state: State, *, below: float = np.inf) -> float:
        """What a state costs; where that is no less than `below`, it may be any that is no less."""
        return self._measured(state, below).cost

    def _measured(self, state: State, below: float = np.inf) -> Measured:
        return self._objective(self._maps(state), below=below)

    def _maps(self, state: State) -> Array:
        points, normals = [], []
        for contact in self._manifold.contact_points(state):
            p = state.R_palm_object.T @ (contact.p_object - state.p_palm_object)
            points.append((p - self._centre) / UNIT_M)
            normals.append(-state.R_palm_object.T @ contact.n_object)
        return point_maps(np.array(points), np.array(normals))

    def climb(self, state: State, *, at_last: bool = False) -> tuple[State, float]:
        """From a state that solves the task to such that cost less, as far as local search goes.

        Args:
            state: where it begins.
            at_last: more slowly, which gets further where many twists are as bad.
        """
        shrink = _SHRINK_AT_LAST if at_last else _SHRINK
        here, reach = self._measured(state), _FIRST
        for _ in range(_MOST_STEPS):
            give_up_if_asked()
            if reach < _LAST or not np.isfinite(here.cost):
                break
            there = self._step(state, here, reach)
            after = None if there is None else self._measured(there, here.cost)
            if there is not None and after is not None and after.cost < here.cost - _GAIN * abs(here.cost):
                state, here, reach = there, after.knowing(here), min(_FIRST, _GROW * reach)
            else:
                reach *= shrink
                # What was in the way of this step is so in that of the next.
                here = here if after is None else here.knowing(after)
        return state, here.cost

    def _step(self, state: State, here: Measured, reach: float) -> State | None:
        """A state within reach that is best to first order; None where none solves the task."""
        manifold = self._manifold
        N = _null_space(manifold.linearise(state)[1])
        if not N.shape[1]:
            return None
        moved = [self._maps(self._unlimited.retract(state, _DIFFERENCE * d)) for d in N.T]
        cuts = here.cuts(moved)
        slopes = cuts.changes / _DIFFERENCE
        if not np.isfinite(slopes).all() or not slopes.any():
            return None
        g, G = manifold.inequalities(state)
        at = np.concatenate([state.q, state.params])
        limited = N[manifold.bounded]
        rows = np.vstack([limited, -limited, -G @ N])
        room = np.maximum(np.concatenate([manifold.upper - at, at - manifold.lower, g]), 0.0)
        # The last unknown is the largest of the costs, which are measured by the steepest of them.
        steepest, d = float(np.abs(slopes).max()), N.shape[1]
        below = np.hstack([slopes / steepest, np.full((len(slopes), 1), -1.0)])
        rows = np.vstack([below, np.hstack([rows, np.zeros((len(rows), 1))])])
        missing = (cuts.values.max() - cuts.values) / steepest
        for _ in range(_CORRECTIONS):
            found = linprog(
                np.append(np.zeros(d), 1.0),
                rows,
                np.concatenate([missing, room]),
                bounds=[(-reach, reach)] * d + [(None, None)],
                method="highs",
            )
            if found.status != 0:
                return None
            step = N @ found.x[:-1]
            there = manifold.project(manifold.retract(state, step))
            if there is None or manifold.is_feasible(there):
                return there
            # Caps and facing normals are curved: what the step lacks there is asked of the next one besides.
            lacking = np.maximum(g + G @ step - manifold.inequalities(there)[0], 0.0)
            room[len(room) - len(g) :] = g - _BEYOND * lacking
        return None


def _null_space(J: Array) -> Array:
    """An orthonormal basis (n, d) of the kernel of J (m, n)."""
    _, sizes, Vt = np.linalg.svd(J)
    rank = int((sizes > 1e-9 * sizes.max(initial=0.0)).sum())
    basis: Array = Vt[rank:].T
    return basis
