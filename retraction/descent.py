"""A descent: steps along the contact manifold, each of which makes the configuration less deep."""

from dataclasses import dataclass

import numpy as np

from ..base.machine.cancellation import give_up_if_asked
from ..base.numeric.arrays import Array, Indices
from ..solver import ContactManifold, State
from .distance import Gaps, joined, lower_bounds
from .jacobian import distance_jacobian
from .nearest import measure_quickly
from .pairs import CollisionModel
from .qp import build_step, coordinate_scale, solve_step
from .restarts import back_on_manifold
from .settings import RetractionSettings

__all__ = ["Descent", "PenetrationProblem", "Point"]


# Pairs that are nearer than this many trust regions are watched during a step; few others come together, and
# a step after which they have is not accepted.
_REACH_TRUSTS = 0.75
# A step is asked for a little more than is needed, for the surfaces curve away from their tangents.
_EXTRA_M = 5e-5
# Refining a state to its certificate moves it by less.
_ROUNDING_M = 1e-7
_BACKTRACKS = (1.0, 0.4)
# A step must take away this share of what flat surfaces would give and of all depth, or a shorter one is
# tried; then one of a smaller trust region, down to a share of the first.
_SUFFICIENT, _LEAST_GAIN = 0.1, 1e-3
_LEAST_TRUST_SHARE = 0.05
# A descent that lost less than this share of its depth in so many steps has stalled.
_STALL_SHARE, _STALL_STEPS = 0.2, 4


class Point:
    """A state on the contact manifold, with how deep its bodies sink into each other.

    Attributes:
        state: the state.
        worst_m: the greatest excess: how much deeper some pair is than it should be at most.
        total_m: the sum of the excesses of all pairs.
    """

    def __init__(self, model: CollisionModel, targets: Array, state: State):
        self.state = state
        self._model = model
        self._placed = model.place(state)
        self._bounds = lower_bounds(self._placed, model.piece_pairs) - targets
        # Pairs further apart have no excess, so most points need no more than these few.
        self._close = np.flatnonzero(self._bounds < 0.0)
        self._gaps = measure_quickly(self._placed, model.piece_pairs[self._close])
        excess = np.maximum(targets[self._close] - self._gaps.distance_m, 0.0)
        self.worst_m = float(excess.max(initial=0.0))
        self.total_m = float(excess.sum())

    def near(self, reach_m: float) -> tuple[Indices, Gaps]:
        """Pairs of pieces (k,) that may be within `reach_m` of their targets, and their distances."""
        further = np.flatnonzero((self._bounds >= 0.0) & (self._bounds < reach_m))
        gaps = measure_quickly(self._placed, self._model.piece_pairs[further])
        return np.concatenate([self._close, further]), joined(self._gaps, gaps)

    def gaps_along(self, pairs: Indices, normal: Array) -> Array:
        """Gaps (k,) of pairs (k, 2) of pieces along a unit vector (3,) from a to b; negative in overlap."""
        radii = self._model.bodies.radius[pairs].sum(axis=1)
        return self._placed.separations(pairs, np.tile(normal, (len(pairs), 1))) - radii


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


class PenetrationProblem:
    """The contact manifold of a task with the depth of its bodies as height."""

    def __init__(self, model: CollisionModel, manifold: ContactManifold, settings: RetractionSettings):
        self.model = model
        self.manifold = manifold
        self.settings = settings
        self.scale = coordinate_scale(manifold)
        targets = np.where(model.intended, settings.target_m(True), settings.target_m(False))
        self.targets = targets - model.stands_out_m + _ROUNDING_M

    def point(self, state: State) -> Point:
        """The depth at a state."""
        return Point(self.model, self.targets, state)

    def descend(self, start: State) -> Descent:
        """Steps down until nothing is too deep, the descent stalls or its steps are spent."""
        points = [self.point(start)]
        widest = trust = self.settings.trust_m
        while points[-1].worst_m > 0.0 and len(points) <= self.settings.max_steps:
            give_up_if_asked()
            if _has_stalled(points) or trust < _LEAST_TRUST_SHARE * widest:
                break
            following = self._step(points[-1], trust)
            if following is None:
                trust *= 0.25
            else:
                trust = min(2.0 * trust, widest)
                points.append(following)
        return Descent(tuple(points))

    def _step(self, point: Point, trust_m: float) -> Point | None:
        """The next point, or None where no step along the program's direction goes down."""
        near, gaps = point.near(_REACH_TRUSTS * self.settings.trust_m)
        J = distance_jacobian(self.manifold, self.model, point.state, gaps)
        extra = np.where(self.model.intended[near], 0.5 * self.settings.contact_depth_m, _EXTRA_M)
        room = gaps.distance_m - self.targets[near]
        asked = np.where(room < 0.0, room - extra, np.maximum(room - extra, 0.0))
        dx = solve_step(build_step(self.manifold, point.state, self.scale, J, asked, trust_m))
        if dx is None:
            return None
        for share in _BACKTRACKS:
            state = back_on_manifold(self.manifold, self.manifold.retract(point.state, share * dx))
            if state is None:
                continue
            reached = self.point(state)
            # What the step would give if the surfaces were flat.
            expected = point.total_m - float(np.maximum(-(room + share * (J @ dx)), 0.0).sum())
            least = max(_SUFFICIENT * expected, _LEAST_GAIN * point.total_m)
            if reached.worst_m <= point.worst_m and reached.total_m <= point.total_m - least:
                return reached
        return None


def _has_stalled(points: list[Point]) -> bool:
    if len(points) <= _STALL_STEPS:
        return False
    return points[-1].total_m > (1.0 - _STALL_SHARE) * points[-1 - _STALL_STEPS].total_m
