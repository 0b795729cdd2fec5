"""Grasps of the scalpel between index finger and thumb, known beforehand."""

import numpy as np
import pytest
from holdfast.geometry.transforms import rotation_from_quaternion
from holdfast.mjcf import Grasp, Squeeze, plan_squeeze
from holdfast.objects import load_task
from holdfast.solver import Configuration, ContactManifold, State

# Independent joints in rad, quaternion and position of the object in m, parameters of the patches: close to
# solutions without penetration.
_STARTS = {
    "firm": (
        [1.42, -0.048, 0.421, 0.431, 0.228, 0.874, 0.525, 0.215, 1.071, 1.13, -0.05, 0.121, 0.534],
        [0.3752, 0.1215, 0.9081, -0.1409],
        [0.0609, 0.0589, 0.2239],
        [0.565, 0.012, 0.572, 0.866],
    ),
    "leaning": (
        [1.126, -0.262, 0.445, 0.298, -0.121, 1.12, 1.162, 0.006, 0.405, 1.303, -0.202, -0.07, 0.951],
        [0.3672, 0.7746, 0.326, 0.3987],
        [0.0636, 0.0482, 0.2327],
        [0.241, 0.129, 0.676, 0.727],
    ),
}


def solve(name: str) -> Configuration:
    task = load_task("upholding")
    q, quaternion, position, params = (np.array(values) for values in _STARTS[name])
    manifold = ContactManifold(task)
    state = manifold.project(State(q, rotation_from_quaternion(quaternion), position, params))
    assert state is not None and manifold.is_feasible(state)
    return Configuration(task, state, float(np.abs(manifold.residual(state)).max()), None)


def squeezed(name: str) -> Grasp:
    configuration = solve(name)
    squeeze = plan_squeeze(configuration)
    assert isinstance(squeeze, Squeeze)
    return Grasp(configuration, squeeze)


@pytest.fixture(scope="session")
def firm() -> Grasp:
    """A pinch well inside its friction cones."""
    return squeezed("firm")


@pytest.fixture(scope="session")
def leaning() -> Grasp:
    """A pinch near the edge of its friction cones."""
    return squeezed("leaning")


@pytest.fixture(scope="session", params=sorted(_STARTS))
def grasp(request: pytest.FixtureRequest, firm: Grasp, leaning: Grasp) -> Grasp:
    return {"firm": firm, "leaning": leaning}[request.param]
