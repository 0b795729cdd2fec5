"""One step of a retraction as a quadratic program.

    minimise    |y|^2 / 2 + weight |s|^2 / 2
    subject to  J_contact dx = -c                   contacts, linearised
                J_cap dx >= -share g                contact normals stay within their caps
                J_distance dx >= target - distance  for pairs that are clear
                J_distance dx + s >= same           for pairs that are not, with slack s >= 0 that leaves no
                                                    pair deeper than the deepest was
                limits of joints and parameters, |y| <= trust region,

where y = scale dx measures all coordinates as the motion they cause, in m. With y = 0 every constraint but
the slack ones holds, so the program has a solution. After Zhang, Kim & Manocha, "A fast and practical
algorithm for generalized penetration depth computation" (RSS 2007), who move along linearised contact
constraints, with the task's own contacts as equalities.
"""

from dataclasses import dataclass

import numpy as np

from ..base.numeric.arrays import Array, Mask
from ..base.numeric.quadratic_program import solve_quadratic_program
from ..geometry import Patch
from ..solver import ContactManifold, State

__all__ = ["StepProblem", "build_step", "coordinate_scale", "solve_step"]


# Against the motion of 1 m: a metre of depth is worth this many metres of motion, squared.
_SLACK_WEIGHT = 1e3
# A step may use up this share of the room left within a cap, so that curvature does not carry it out.
_CAP_SHARE = 0.8
# Typical distance from a joint to what it moves, by which turning is compared with sliding.
_FINGER_ARM_M = 0.05


@dataclass(frozen=True, eq=False)
class StepProblem:
    """min z'Hz/2 with lower <= (z, A z) <= upper, z = (y, s); `scale` turns dx into y.

    Attributes:
        H: (n, n), diagonal.
        A: (m, n), general constraints.
        lower: (n + m,) bounds of the variables, then of the constraints.
        upper: (n + m,).
        equal: (n + m,) marks constraints whose bounds are equal.
        scale: (n_tangent,) metres of y per unit of dx.
    """

    H: Array
    A: Array
    lower: Array
    upper: Array
    equal: Mask
    scale: Array


def coordinate_scale(manifold: ContactManifold) -> Array:
    """Motion in m that a unit of each tangent coordinate causes, (n_tangent,)."""
    task = manifold.task
    prismatic = task.hand.tree.prismatic[task.hand.independent]
    joints = np.where(prismatic, 1.0, _FINGER_ARM_M)
    turning = np.full(3, 0.25 * task.object.size_m)
    regions = [region for c in task.contacts for region in (c.hand.region, c.object.region)]
    patches = [np.repeat(_patch_size(region), 2) for region in regions if isinstance(region, Patch)]
    return np.concatenate([joints, np.ones(3), turning, *patches])


def _patch_size(region: Patch) -> float:
    points = region.patch.control_points.reshape(-1, 3)
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def build_step(
    manifold: ContactManifold,
    state: State,
    scale: Array,
    J_distance: Array,
    room_m: Array,
    trust_m: float,
) -> StepProblem:
    """The program of a step from `state`.

    Args:
        manifold: the contacts.
        state: a state on the manifold.
        scale: from `coordinate_scale`.
        J_distance: (k, n_tangent) derivatives of the signed distances of near pairs.
        room_m: (k,) their distances less what they should be at least; negative where they are too deep.
        trust_m: bound on every coordinate of y.
    """
    c, J = manifold.linearise(state)
    g, G = manifold.inequalities(state)
    deep = np.flatnonzero(room_m < 0.0)
    n, n_slack = manifold.n_tangent, len(deep)
    slack = np.zeros((len(room_m), n_slack))
    slack[deep, np.arange(n_slack)] = 1.0

    step_lower, step_upper = _step_bounds(manifold, state, scale, trust_m)
    rows = np.concatenate([J, G, J_distance]) / scale
    A = np.hstack([rows, np.concatenate([np.zeros((len(c) + len(g), n_slack)), slack])])
    # One step asks no more of a pair than the trust region can give.
    wanted = np.minimum(-room_m, trust_m)
    lower = np.concatenate([step_lower, np.zeros(n_slack), -c, -_CAP_SHARE * np.maximum(g, 0.0), wanted])
    upper = np.full(len(lower), np.inf)
    upper[:n] = step_upper
    upper[n : n + n_slack] = wanted[deep] + room_m[deep] - room_m.min(initial=0.0)
    equalities = slice(n + n_slack, n + n_slack + len(c))
    upper[equalities] = -c
    equal = np.zeros(len(lower), dtype=bool)
    equal[equalities] = True
    H = np.diag(np.concatenate([np.ones(n), np.full(n_slack, _SLACK_WEIGHT)]))
    return StepProblem(H, A, lower, upper, equal, scale)


def _step_bounds(
    manifold: ContactManifold, state: State, scale: Array, trust_m: float
) -> tuple[Array, Array]:
    """Bounds (n_tangent,) on y from the trust region and the limits."""
    lower, upper = np.full(manifold.n_tangent, -trust_m), np.full(manifold.n_tangent, trust_m)
    x, limited = np.concatenate([state.q, state.params]), manifold.bounded
    lower[limited] = np.maximum(lower[limited], np.minimum(manifold.lower - x, 0.0) * scale[limited])
    upper[limited] = np.minimum(upper[limited], np.maximum(manifold.upper - x, 0.0) * scale[limited])
    return lower, upper


def solve_step(problem: StepProblem) -> Array | None:
    """The tangent step dx (n_tangent,), or None where the solver finds none."""
    f = np.zeros(len(problem.H))
    z = solve_quadratic_program(problem.H, f, problem.A, problem.lower, problem.upper, problem.equal)
    return None if z is None else z[: len(problem.scale)] / problem.scale
