"""Other places to start from."""

import numpy as np
from holdfast.retraction.qp import coordinate_scale
from holdfast.retraction.restarts import contact_joints, rest_free_joints, walk


def test_joints_without_a_contact_are_free(manifold, colliding):
    names = manifold.task.hand.independent_names
    free = {name for name, bound in zip(names, contact_joints(manifold), strict=True) if not bound}
    assert free == {
        f"{finger}_{joint}" for finger in ("ring", "middle") for joint in ("abduction", "flexion", "pip")
    }
    rested = rest_free_joints(manifold, colliding[0].state)
    assert np.abs(manifold.residual(rested)).max() <= 1e-9
    assert rested.q[names.index("ring_flexion")] == 0.0


def test_walk_keeps_contacts_and_its_length(colliding, manifold):
    scale = coordinate_scale(manifold)
    rng = np.random.default_rng(5)
    walked = 0
    for configuration in colliding[:5]:
        state = configuration.state
        end = walk(manifold, state, scale, 0.03, rng)
        if end is None:
            continue
        walked += 1
        assert np.abs(manifold.residual(end)).max() <= 1e-9
        assert manifold.is_feasible(end)
        joints = np.abs(end.q - state.q) * scale[: manifold.n_q]
        assert joints.max() < 0.06
        assert np.linalg.norm(end.p_palm_object - state.p_palm_object) < 0.1
    assert walked >= 3
