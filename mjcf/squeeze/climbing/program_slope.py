"""How the value of a grasp's linear program changes along the contact manifold.

For a minimum of c x over A x = b with multipliers y, a change dA changes the value by -y dA x. The matrices
are made of the contact maps G and T, so y dA x is a sum W_G . dG + W_T . dT, whose weights follow from the
forces and the multipliers. Only a hinge turns with the object besides.
"""

import numpy as np

from ....base.numeric.arrays import Array
from ....objects import TurnTest
from ....solver import ContactManifold, State
from ...settings import HoldSettings
from ..contact_maps import maps_slope
from ..elastic_response import normals_slope
from ..linear_program import Optimum
from ..load_program import LoadProgram
from ..statics import ARM_M, WRENCH_SCALE, Statics

__all__ = ["imbalance_slope", "load_slope"]


def imbalance_slope(
    manifold: ContactManifold, state: State, statics: Statics, vector: Array, multipliers: Array
) -> Array:
    """Derivative (n_tangent,) of y . (scaled G f) for a contact vector f (4 m,) and multipliers y (6,)."""
    W_G = np.outer(WRENCH_SCALE * multipliers, vector)
    return _slope(manifold, state, statics, W_G, np.zeros_like(statics.T))


def load_slope(
    manifold: ContactManifold,
    settings: HoldSettings,
    state: State,
    statics: Statics,
    program: LoadProgram,
    optimum: Optimum,
    pressed_N: float = 0.0,
) -> Array:
    """Derivative (n_tangent,) of y . A x over all rows of `program` whose optimum is given.

    Besides the forces of the optimum every contact may be `pressed_N` along its normal, in every state.
    """
    n_states = program.n_states
    x = optimum.x[: program.n_unknowns]
    vectors = program.contact_vectors(x).reshape(n_states, -1)
    vectors[:, 0 : 4 * statics.n_contacts : 4] += pressed_N
    # Of each state's limits, upper and lower ones of efforts come first; the others are of forces alone.
    limits, n = optimum.upper[program.rows.b_ub > 0.0].reshape(n_states, -1), len(statics.T)
    W_T = (limits[:, :n] - limits[:, n : 2 * n]).T @ vectors
    W_T /= settings.planned_effort * statics.effort[:, None]
    W_G = np.zeros_like(statics.G)
    test = manifold.task.test
    if program.must_balance:
        wrenches = optimum.equal[: 6 * n_states].reshape(n_states, 6)
        W_G += WRENCH_SCALE[:, None] * (wrenches.T @ vectors)
        of_sums = optimum.equal[6 * n_states :]
        # These rows hold the sums of normals at rest less those under each load.
        rest = np.zeros(6)
        rest[:3] = statics.mass * settings.gravity * np.array(settings.resting_direction)
        weight = x[-1] * (of_sums.sum() * rest - of_sums @ (program.loads / WRENCH_SCALE))
        by_G, by_T = normals_slope(statics, weight)
        W_G, W_T = W_G + by_G, W_T + by_T
    slope = np.zeros(manifold.n_tangent)
    if isinstance(test, TurnTest):
        R, p = state.R_palm_object, state.p_palm_object
        axis = R @ np.array(test.hinge_axis)
        arm = statics.centre - (R @ np.array(test.hinge_point) + p)
        multiplier = optimum.equal[0] / ARM_M
        W_G += multiplier * np.outer(np.concatenate([np.cross(axis, arm), axis]), vectors[0])
        force, moment = (statics.G @ vectors[0]).reshape(2, 3)
        moment = moment + np.cross(arm, force)
        by_turn = np.cross(axis, moment) + np.cross(arm, np.cross(force, axis))
        slope[manifold.n_q + 3 : manifold.n_q + 6] = multiplier * by_turn
    return slope + _slope(manifold, state, statics, W_G, W_T)


def _slope(manifold: ContactManifold, state: State, statics: Statics, W_G: Array, W_T: Array) -> Array:
    centre = state.R_palm_object.T @ (statics.centre - state.p_palm_object)
    points = statics.force_points
    where = (points.contact, points.offsets_m)
    return np.asarray(maps_slope(manifold.tables, *state.copies(), centre, *where, W_G, W_T))
