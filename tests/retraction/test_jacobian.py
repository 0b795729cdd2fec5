"""Derivatives of distances against finite differences."""

import numpy as np
from holdfast.retraction.distance import measure
from holdfast.retraction.jacobian import distance_jacobian
from holdfast.retraction.pairs import collision_model
from holdfast.solver import State


def test_jacobian_by_finite_differences(task, manifold, configurations):
    model = collision_model(task)
    rng = np.random.default_rng(0)
    for configuration in configurations[:3]:
        state = configuration.state
        # Away from its limits, where a step would be clipped.
        n = manifold.n_q
        q = np.clip(state.q, manifold.lower[:n] + 1e-3, manifold.upper[:n] - 1e-3)
        state = State(q, state.R_palm_object, state.p_palm_object, state.params)
        gaps = measure(model.place(state), model.piece_pairs)
        J = distance_jacobian(manifold, model, state, gaps)
        for _ in range(4):
            dx = rng.normal(size=manifold.n_tangent)
            dx *= 1e-6 / np.linalg.norm(dx)
            ahead, behind = (
                measure(model.place(manifold.retract(state, step)), model.piece_pairs).distance_m
                for step in (dx, -dx)
            )
            # Where the nearest features change, the distance has a kink and no derivative.
            smooth = np.abs(ahead - 2.0 * gaps.distance_m + behind) < 2e-10
            assert smooth.mean() > 0.95
            np.testing.assert_allclose((J @ dx)[smooth], 0.5 * (ahead - behind)[smooth], atol=2e-10)
