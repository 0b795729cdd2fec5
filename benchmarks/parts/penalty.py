"""The baseline that retraction is compared with: penalty minimisation by SciPy from the same start."""

import numpy as np
from holdfast.base.numeric.arrays import Array
from holdfast.geometry.transforms import rotation_exp
from holdfast.objects import Task
from holdfast.retraction import RetractionSettings
from holdfast.retraction.descent import PenetrationProblem
from holdfast.retraction.jacobian import distance_jacobian
from holdfast.retraction.pairs import collision_model
from holdfast.solver import ContactManifold, State
from scipy.optimize import minimize

__all__ = ["minimise_penalty"]


# Weights of the contacts against the depths, one minimisation after the other.
WEIGHTS = (1.0, 100.0, 1e4)
MAX_ITERATIONS = 100
CAP_WEIGHT_M = 0.02


def minimise_penalty(task: Task, manifold: ContactManifold, start: State) -> State:
    """Minimises the squares of depths, contact errors and cap violations by L-BFGS-B, within joint limits.

    The contacts are a penalty like the others, whose weight grows from one minimisation to the next: the
    usual way of grasp synthesis by optimisation. Derivatives are exact.
    """
    problem = PenetrationProblem(collision_model(task), manifold, RetractionSettings())
    state = start
    for weight in WEIGHTS:
        state = _minimise(problem, state, weight)
    return state


def _minimise(problem: PenetrationProblem, start: State, weight: float) -> State:
    manifold = problem.manifold
    scale = problem.scale
    x = np.concatenate([start.q, start.params])
    bounds = np.full((manifold.n_tangent, 2), [-np.inf, np.inf])
    bounds[manifold.bounded] = np.column_stack([manifold.lower - x, manifold.upper - x])

    def cost(y: Array) -> tuple[float, Array]:
        dx = y / scale
        state = manifold.retract(start, dx)
        point = problem.point(state)
        near, gaps = point.near(0.0)
        depth = np.maximum(problem.targets[near] - gaps.distance_m, 0.0)
        J_depth = -distance_jacobian(manifold, problem.model, state, gaps)
        c, J = manifold.linearise(state)
        g, G = manifold.inequalities(state)
        short = CAP_WEIGHT_M * np.maximum(-g, 0.0)
        value = depth @ depth + weight * (c @ c + short @ short)
        gradient = 2.0 * (depth @ J_depth + weight * (c @ J - CAP_WEIGHT_M * short @ G))
        gradient[manifold.n_q + 3 : manifold.n_q + 6] = (
            _left_jacobian(dx[manifold.n_q + 3 : manifold.n_q + 6]).T
            @ gradient[manifold.n_q + 3 : manifold.n_q + 6]
        )
        return 1e4 * value, 1e4 * gradient / scale

    found = minimize(
        cost,
        np.zeros(manifold.n_tangent),
        jac=True,
        method="L-BFGS-B",
        bounds=bounds * scale[:, None],
        options={"maxiter": MAX_ITERATIONS, "ftol": 1e-14, "gtol": 1e-12},
    )
    return manifold.retract(start, found.x / scale)


def _left_jacobian(w: Array) -> Array:
    """Turn about axes of the palm frame by a change of the rotation vector w, (3, 3), by differences."""
    step = 1e-6
    columns = []
    for axis in np.eye(3):
        R = rotation_exp(w + step * axis) @ rotation_exp(w - step * axis).T
        columns.append(np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / (4.0 * step))
    return np.column_stack(columns)
