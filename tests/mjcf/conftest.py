"""Grasps known beforehand: of the scalpel between index finger and thumb, and of the guitar on a stand."""

from dataclasses import replace

import holdfast.solver
import mujoco
import numpy as np
import pytest
from holdfast.geometry.transforms import rotation_from_quaternion
from holdfast.mjcf import Grasp, Squeeze, grasp_mjcf, plan_squeeze
from holdfast.objects import load_task
from holdfast.solver import Configuration, ContactManifold, State

# Independent joints in rad, quaternion and position of the object in m, parameters of the patches: close to
# solutions without penetration.
_STARTS = {
    "firm": (
        "upholding",
        [1.42, -0.048, 0.421, 0.431, 0.228, 0.874, 0.525, 0.215, 1.071, 1.13, -0.05, 0.121, 0.534],
        [0.3752, 0.1215, 0.9081, -0.1409],
        [0.0609, 0.0589, 0.2239],
        [0.565, 0.012, 0.572, 0.866],
    ),
    "leaning": (
        "upholding",
        [1.126, -0.262, 0.445, 0.298, -0.121, 1.12, 1.162, 0.006, 0.405, 1.303, -0.202, -0.07, 0.951],
        [0.3672, 0.7746, 0.326, 0.3987],
        [0.0636, 0.0482, 0.2327],
        [0.241, 0.129, 0.676, 0.727],
    ),
    "playing": (
        "playing",
        [1.084, 0.251, 0.536, 0.309, -0.211, 1.133, 1.26, -0.108, 0.934, 0.315, 0.201, 0.178, 1.033],
        [0.0583, -0.2086, -0.5559, 0.8025],
        [1.1842, -0.1541, 0.6801],
        [0.169, 0.246, 0.322, 0.227, 0.678, 0.012, 0.66, 0.979],
    ),
    "tuning": (
        "tuning",
        [1.397, -0.118, 0.01, 0.415, 0.0, 0.0, 0.07, 0.0, 0.0, 0.07, 0.262, 0.729, 0.291],
        [0.5457, 0.3025, -0.7695, -0.1362],
        [0.5317, 0.7474, -0.8367],
        [0.47, 0.141, 0.475, 0.95],
    ),
}


def solve(name: str) -> Configuration:
    """The grasp of that name: `firm` and `leaning` of the scalpel, `playing` and `tuning` of the guitar."""
    task_name, *numbers = _STARTS[name]
    task = load_task(task_name)
    q, quaternion, position, params = (np.array(values) for values in numbers)
    manifold = ContactManifold(task)
    R = rotation_from_quaternion(quaternion / np.linalg.norm(quaternion))
    state = manifold.project(State(q, R, position, params))
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


@pytest.fixture(scope="session", params=["firm", "leaning"])
def grasp(request: pytest.FixtureRequest, firm: Grasp, leaning: Grasp) -> Grasp:
    return {"firm": firm, "leaning": leaning}[request.param]


@pytest.fixture(scope="session")
def playing() -> Configuration:
    """A press: three fingers on the strings of the guitar."""
    return solve("playing")


@pytest.fixture(scope="session")
def tuning() -> Configuration:
    """A turn: two fingers on a key of the guitar."""
    return solve("tuning")


@pytest.fixture(scope="session", params=["playing", "tuning"])
def configuration(
    request: pytest.FixtureRequest, playing: Configuration, tuning: Configuration
) -> Configuration:
    """A grasp of an object on a stand."""
    return {"playing": playing, "tuning": tuning}[request.param]


@pytest.fixture(scope="session")
def configurations() -> tuple[Configuration, ...]:
    """Configurations as the solver finds them, most of them weak."""
    return holdfast.solver.solve(load_task("upholding"), candidates=6, seed=1).configurations


def limp(grasp: Grasp) -> Grasp:
    """The grasp with a hand that does not squeeze."""
    q = np.array(grasp.configuration.state.q)
    path = np.tile(q, (len(grasp.squeeze.path), 1))
    return replace(grasp, squeeze=replace(grasp.squeeze, targets=q, path=path))


def in_mujoco(text: str) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """A model of MJCF text, and its data."""
    model = mujoco.MjModel.from_xml_string(text)
    return model, mujoco.MjData(model)


def posed(configuration: Configuration) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """MuJoCo's model and data with hand and object as the configuration has them, the object floating."""
    model, data = in_mujoco(grasp_mjcf(configuration))
    mujoco.mj_resetDataKeyframe(model, data, model.key("grasp").id)
    mujoco.mj_forward(model, data)
    return model, data


def is_drawn(picture: np.ndarray) -> np.ndarray:
    """Pixels that are not the light background."""
    return picture.min(axis=-1) < 215


def servo_efforts(
    configuration: Configuration, targets: np.ndarray, at: np.ndarray | None = None
) -> np.ndarray:
    """Efforts (n_independent,) that MuJoCo's servos give with their targets at `targets`.

    The hand is in the grasp, or with its independent joints `at` (n_independent,).
    """
    model, data = in_mujoco(grasp_mjcf(configuration, targets=targets))
    mujoco.mj_resetDataKeyframe(model, data, model.key("squeeze").id)
    if at is not None:
        joints = configuration.task.hand.expand(at)
        data.qpos[: len(joints)] = joints
    mujoco.mj_forward(model, data)
    return np.array(data.actuator_force)
