"""A descent: steps along the contact manifold, each of which makes the configuration less deep."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..solver import ContactManifold, State
from .distance import Gaps, lower_bounds, measure
from .jacobian import distance_jacobian
from .pairs import CollisionModel
from .qp import build_step, coordinate_scale, solve_step
from .restarts import land_elsewhere
from .settings import RetractionSettings

__all__ = ["Descent", "Point", "Terrain"]

Array = NDArray[np.float64]

# Pairs that are nearer than this many trust regions can come together within a step.
_REACH_TRUSTS = 1.5
# A step is asked for a little more than is needed, for the surfaces curve away from their tangents.
_EXTRA_M = 5e-5
# Refining a state to its certificate moves it by less.
_ROUNDING_M = 1e-7
_BACKTRACKS = (1.0, 0.5, 0.25, 0.1)
# A step must take away this share of what a straight terrain would give, or a shorter one is tried.
_SUFFICIENT = 0.1
# A descent that lost less than this share of its depth in so many steps has stalled.
# Landing takes 5 ms, a descent that ends badly 30 ms: so the best of a few landings is gone down from.
_LANDINGS = 5
_STALL_SHARE, _STALL_STEPS = 0.1, 4


@dataclass(frozen=True, eq=False)
class Point:
    """A state on the contact manifold with the pairs that are near each other there.

    Attributes:
        state: the state.
        gaps: signed distances of the near pairs.
        near: (k,) their indices among the pairs of pieces.
        excess_m: (k,) how much deeper each is than it should be at most, 0 where it is not.
    """

    state: State
    gaps: Gaps
    near: NDArray[np.int64]
    excess_m: Array

    @property
    def worst_m(self) -> float:
        """The greatest excess."""
        return float(self.excess_m.max(initial=0.0))

    @property
    def total_m(self) -> float:
        """The sum of all excesses."""
        return float(self.excess_m.sum())


@dataclass(frozen=True, eq=False)
class Descent:
    """The points of a descent; neither the worst nor the total excess grows along them."""

    points: tuple[Point, ...]

    @property
    def end(self) -> Point:
        """Where it ended."""
        return self.points[-1]

    @property
    def steps(self) -> int:
        """Accepted steps."""
        return len(self.points) - 1


class Terrain:
    """The contact manifold of a task with the depth of its bodies as height."""

    def __init__(self, model: CollisionModel, manifold: ContactManifold, settings: RetractionSettings):
        self.model = model
        self.manifold = manifold
        self.settings = settings
        self.scale = coordinate_scale(manifold)
        targets = np.where(model.intended, settings.target_m(True), settings.target_m(False))
        self.targets = targets + _ROUNDING_M

    def point(self, state: State) -> Point:
        """Distances at a state."""
        placed = self.model.place(state)
        bounds = lower_bounds(placed, self.model.piece_pairs)
        near = np.flatnonzero(bounds < self.targets + _REACH_TRUSTS * self.settings.trust_m)
        gaps = measure(placed, self.model.piece_pairs[near])
        return Point(state, gaps, near, np.maximum(self.targets[near] - gaps.distance_m, 0.0))

    def descend(self, start: State) -> Descent:
        """Steps down until nothing is too deep, the descent stalls or its steps are spent."""
        points = [self.point(start)]
        trust = self.settings.trust_m
        while points[-1].worst_m > 0.0 and len(points) <= self.settings.max_steps:
            if _has_stalled(points):
                break
            following = self._step(points[-1], trust)
            if following is None:
                break
            points.append(following)
        return Descent(tuple(points))

    def _step(self, point: Point, trust_m: float) -> Point | None:
        """The next point, or None where no step along the program's direction goes down."""
        J = distance_jacobian(self.manifold, self.model, point.state, point.gaps)
        extra = np.where(self.model.intended[point.near], 0.5 * self.settings.contact_depth_m, _EXTRA_M)
        room = point.gaps.distance_m - self.targets[point.near]
        room = np.where(point.excess_m > 0.0, room - extra, np.maximum(room - extra, 0.0))
        problem = build_step(self.manifold, point.state, self.scale, J, room, trust_m)
        dx = solve_step(problem)
        if dx is None:
            return None
        for share in _BACKTRACKS:
            state = self.manifold.project(self.manifold.retract(point.state, share * dx))
            if state is None or not self.manifold.is_feasible(state):
                continue
            reached = self.point(state)
            if (
                reached.worst_m <= point.worst_m
                and reached.total_m <= (1.0 - _SUFFICIENT * share) * point.total_m
            ):
                return reached
        return None

    def land_elsewhere(self, state: State, reach: float, rng: np.random.Generator) -> State | None:
        """The least deep of a few random landings around a state, or None where all miss the manifold."""
        best: Point | None = None
        for _ in range(_LANDINGS):
            landed = land_elsewhere(self.manifold, state, reach, rng)
            if landed is None:
                continue
            point = self.point(landed)
            if best is None or point.total_m < best.total_m:
                best = point
        return None if best is None else best.state


def _has_stalled(points: list[Point]) -> bool:
    if len(points) <= _STALL_STEPS:
        return False
    return points[-1].total_m > (1.0 - _STALL_SHARE) * points[-1 - _STALL_STEPS].total_m
