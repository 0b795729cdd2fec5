"""How far a clear configuration may move before bodies come too near each other."""

import numpy as np

from ..base.numeric.arrays import Array
from ..solver import ContactManifold, State
from .descent import Point
from .jacobian import distance_jacobian
from .pairs import collision_model
from .settings import RetractionSettings

__all__ = ["ClearRoom"]

# Refining a state to its certificate moves it by less.
_ROUNDING_M = 1e-7
# Surfaces curve away from their tangents: a step is asked to leave so much of the room, or to make it.
_LEFT_M = 2e-5


class ClearRoom:
    """The room that pairs of bodies have on the contact manifold of a task, as `retract` counts it.

    Args:
        manifold: the contacts.
        settings: how clear is clear.
    """

    def __init__(self, manifold: ContactManifold, settings: RetractionSettings):
        self._manifold = manifold
        self._model = collision_model(manifold.task)
        required = np.where(self._model.intended, settings.required_m(True), settings.required_m(False))
        self._targets = required - self._model.stands_out_m + _ROUNDING_M
        # Where a step ends, it is first asked whether that is clear, then for the rows of the next.
        self._last: Point | None = None

    def is_clear(self, state: State) -> bool:
        """Whether no pair is nearer than it may be."""
        return self._point(state).worst_m <= 0.0

    def rows(self, state: State, reach_m: float) -> tuple[Array, Array]:
        """How a tangent vector changes the distance of pairs that are near, and how much it may.

        Args:
            state: where hand and object are.
            reach_m: pairs with less room than this are near.

        Returns:
            J (k, n_tangent) in m per unit, and the least change (k,) in m that a step dx may make, J dx.
        """
        near, gaps = self._point(state).near(reach_m)
        J = distance_jacobian(self._manifold, self._model, state, gaps)
        return J, np.minimum(_LEFT_M, _LEFT_M - (gaps.distance_m - self._targets[near]))

    def _point(self, state: State) -> Point:
        """The state with how deep its bodies sink in; the last one is kept."""
        if self._last is None or self._last.state is not state:
            self._last = Point(self._model, self._targets, state)
        return self._last
