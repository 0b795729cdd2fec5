"""A push: steps along the contacts that take every link out of the object in one direction.

A descent stalls where a link sits in several pieces of the object and the shortest way out of one leads
deeper into another: a finger in the neck of a guitar is sent up by some pieces and down by others. A push
asks all these pieces to be left the same way, the one that is shortest for the worst of them. Depths may grow
on the way, so a push only leads to another place from which to descend.
"""

import numpy as np

from ..base.numeric.arrays import Array, Indices
from ..solver import State
from .descent import PenetrationProblem, Point
from .distance import Gaps
from .jacobian import distance_jacobian
from .qp import build_step, solve_step
from .restarts import back_on_manifold

__all__ = ["push"]


_STEPS = 8
# Longest step of one coordinate, in m of motion that it causes; pairs up to half of it apart are watched.
_TRUST_M = 0.03
# Further out than what is just enough.
_EXTRA_M = 2e-4
_SHARES = (1.0, 0.4)
# The direction of the step before is kept unless another one is so much shorter.
_PREFERENCE = 0.6


def push(problem: PenetrationProblem, start: State) -> State:
    """The least deep state on the way of a push that begins at `start`, a state on the manifold."""
    reached = best = problem.point(start)
    directions: dict[int, Array] = {}
    for _ in range(_STEPS):
        following = _step(problem, reached, directions)
        if following is None:
            break
        reached = problem.point(following)
        if reached.total_m < best.total_m:
            best = reached
        if reached.worst_m <= 0.0:
            break
    return best.state


def _step(problem: PenetrationProblem, point: Point, directions: dict[int, Array]) -> State | None:
    """The state a step further; `directions` of the links (index) so far are brought up to date."""
    near, gaps = point.near(0.5 * _TRUST_M)
    gaps = _aligned(problem, point, near, gaps, directions)
    room = gaps.distance_m - problem.targets[near]
    asked = np.where(room < 0.0, room - _EXTRA_M, room)
    J = distance_jacobian(problem.manifold, problem.model, point.state, gaps)
    dx = solve_step(build_step(problem.manifold, point.state, problem.scale, J, asked, _TRUST_M))
    if dx is None:
        return None
    tried = (problem.manifold.retract(point.state, share * dx) for share in _SHARES)
    landed = (back_on_manifold(problem.manifold, state) for state in tried)
    return next((state for state in landed if state is not None), None)


def _aligned(
    problem: PenetrationProblem, point: Point, near: Indices, gaps: Gaps, directions: dict[int, Array]
) -> Gaps:
    """The gaps with those of each link to pieces of the object that it is too deep in along one direction."""
    bodies = problem.model.bodies.piece_body[gaps.pairs]
    deep = (bodies[:, 1] >= len(problem.model.task.hand.links)) & (gaps.distance_m < problem.targets[near])
    normals, distance_m = gaps.normals.copy(), gaps.distance_m.copy()
    for link in np.unique(bodies[deep, 0]).tolist():
        rows = np.flatnonzero(deep & (bodies[:, 0] == link))
        candidates = list(gaps.normals[rows])
        if link in directions:
            candidates.append(directions[link])
        along = [point.gaps_along(gaps.pairs[rows], n) for n in candidates]
        depth = np.array([-gap.min() for gap in along])
        if link in directions:
            depth[-1] *= _PREFERENCE
        chosen = int(np.argmin(depth))
        directions[link] = candidates[chosen]
        normals[rows] = candidates[chosen]
        distance_m[rows] = along[chosen]
    return Gaps(gaps.pairs, distance_m, gaps.p_a, gaps.p_b, normals)
