"""Climbs get along kinks: where one slope alone leads nowhere, several lead to the top."""

import numpy as np
from holdfast.base.numeric.arrays import Array
from holdfast.mjcf import Grasp
from holdfast.mjcf.squeeze.climbing.climb import climb
from holdfast.mjcf.squeeze.climbing.grasp_measure import Strength
from holdfast.mjcf.squeeze.linear_program import Optimum
from holdfast.solver import ContactManifold, State


class Ridge:
    """Minus a weighted sum of distances of the object from a place, in mm: its top is a kink of all three."""

    def __init__(self, manifold: ContactManifold, top: Array):
        self.manifold, self.top = manifold, top
        self.weights = 1e3 * np.array([30.0, 4.0, 1.0])

    def at(self, state: State) -> Strength:
        value = -float(self.weights @ np.abs(state.p_palm_object - self.top))
        nothing = np.zeros(1)
        known = Optimum(nothing, value, nothing, nothing, None)  # type: ignore[arg-type]
        return Strength(state, None, value, None, True, known)  # type: ignore[arg-type]

    def gradient(self, at: Strength) -> Array:
        slope = np.zeros(self.manifold.n_tangent)
        n = self.manifold.n_q
        slope[n : n + 3] = -self.weights * np.sign(at.state.p_palm_object - self.top)
        return slope


def test_the_top_of_a_ridge_is_reached(firm: Grasp) -> None:
    manifold = ContactManifold(firm.configuration.task)
    state = firm.configuration.state
    ridge = Ridge(manifold, state.p_palm_object + np.array([0.0005, -0.003, 0.004]))
    way = climb(manifold, ridge, state, lambda here: here.value > -0.1, None)
    values = [ridge.at(there).value for there in (state, *way)]
    assert values == sorted(values)
    assert values[0] < -30.0 and values[-1] > -1.0
    for there in way:
        assert manifold.is_feasible(there) and np.abs(manifold.residual(there)).max() < 1e-9


def test_what_is_enough_is_left_as_it_is(firm: Grasp) -> None:
    manifold = ContactManifold(firm.configuration.task)
    state = firm.configuration.state
    ridge = Ridge(manifold, state.p_palm_object)
    assert climb(manifold, ridge, state, lambda here: here.value >= 0.0, None) == []
