"""How much every contact of a grasp may lose before it slips, under the planned load.

With all of the friction, in the squeeze and in each direction of gravity, let the force of contact i be a
normal force s and one inside its cone, so that it stays inside if s of its normal force goes. The largest s
that balances the planned load within efforts is the slack of the grasp, in N. It is negative where cones that
are as much wider would be needed. So it goes on where the load that a part of the friction carries says
nothing: where it is zero, and by how much forces of sum 1 miss a balance is no measure of what is missing.

In terms of the load's program, with unknowns x and a load factor that is given, it is one more column in all
rows: what a newton at every contact does.
"""

import numpy as np

from ....base.numeric.arrays import Array
from ....solver import ContactManifold, State
from ...settings import HoldSettings
from ..linear_program import Optimum, minimise
from ..sparse_rows import SparseRows
from ..statics import WRENCH_SCALE, Statics
from .grasp_measure import ProgramAt, Strength
from .program_slope import load_slope

__all__ = ["SlackMeasure"]


class SlackMeasure:
    """The slack of a lift, and in which direction it grows.

    Args:
        manifold: the contacts.
        settings: of the test; the friction is what they have.
        start: see `ProgramAt`.
    """

    def __init__(self, manifold: ContactManifold, settings: HoldSettings, start: State):
        self._program_at = ProgramAt(manifold, settings, start)
        self._last: Optimum | None = None

    def at(self, state: State) -> Strength:
        """The slack of a state in N, at the planned load."""
        statics, program = self._program_at(state)
        settings, task = self._program_at.settings, self._program_at.manifold.task
        on_balance, on_limits = _pressed(statics, settings, task.max_normal_force_N)
        k = program.n_states
        # The rows behind the balances compare sums of normal forces, to which s adds the same everywhere.
        equal = np.concatenate([np.tile(on_balance, k), np.zeros(len(program.rows.A_eq) - 6 * k)])
        upper = np.tile(on_limits, k)
        either_way = np.array([1.0, -1.0])
        A_eq = program.rows.A_eq.beside(SparseRows.of(equal[:, None] * either_way))
        A_ub = program.rows.A_ub.beside(SparseRows.of(upper[:, None] * either_way))
        n = program.n_unknowns
        cost = np.concatenate([np.zeros(n), -either_way])
        load = settings.planned_load
        optimum = minimise(
            cost, A_eq, None, A_ub, program.rows.b_ub, bounds={n - 1: (load, load)}, start=self._last
        )
        self._last = optimum or self._last
        value = -np.inf if optimum is None else -optimum.value
        return Strength(state, statics, value, program, True, optimum)

    def gradient(self, at: Strength) -> Array:
        """Derivative (n_tangent,) of the slack."""
        manifold, settings = self._program_at.manifold, self._program_at.settings
        if at.optimum is None:
            return np.zeros(manifold.n_tangent)
        slack_N = float(at.optimum.x[-2] - at.optimum.x[-1])
        return load_slope(manifold, settings, at.state, at.statics, at.program, at.optimum, slack_N)


def _pressed(statics: Statics, settings: HoldSettings, most_N: float | None) -> tuple[Array, Array]:
    """What a newton at every contact does to the balance (6,), and to the limits (k,) of a state."""
    n = 4 * statics.n_contacts
    effort = statics.T[:, 0:n:4].sum(axis=1) / (settings.planned_effort * statics.effort)
    limits = [effort, -effort]
    if most_N is not None:
        limits.append(np.full(statics.n_contacts, 1.0 / most_N))
    return WRENCH_SCALE * statics.G[:, 0:n:4].sum(axis=1), np.concatenate(limits)
