"""Public hands whose joints follow others by decimals: imported, solved and held with those ratios."""

import os
import shutil
from pathlib import Path

import mujoco
import numpy as np
import pytest
from holdfast.grasping import make_grasp, try_hold
from holdfast.hands import Hand, load_hand
from holdfast.mjcf.model import hand_mjcf
from holdfast.objects import load_task
from holdfast.solver import solve

from .conftest import EXAMPLES, REPOSITORY

# Of each hand: the folder to copy, where in it the model stands, servos, and caps of index and thumb.
HANDS = {
    "ability": (
        "ability",
        "URDF/ability_hand_right_large.urdf",
        "{effort: 0.6, stiffness: 5.0, damping: 0.1, armature: 0.0005}",
        "{link: index_L2, cap: {centre: [0.03201, -0.02174, 0], radius: 0.00869, axis: [0.95, 0.3, 0],"
        " half_angle_deg: 30}}",
        "{link: thumb_L2, cap: {centre: [0.05414, 0.0084, 0.00305], radius: 0.02003, axis: [0, 1, 0],"
        " half_angle_deg: 18}}",
    ),
    "svh": (
        "svh/robots/hands/schunk_hand",
        "schunk_svh_hand_right.urdf",
        "{effort: 0.8, stiffness: 6.0, damping: 0.1, armature: 0.0005}",
        "{link: right_hand_t, cap: {centre: [0.0147, 0, 0], radius: 0.00744, axis: [0.9, 0.4, 0],"
        " half_angle_deg: 35}}",
        "{link: right_hand_c, cap: {centre: [0.0197, 0.0004, 0], radius: 0.0079, axis: [0.8, 0.6, 0],"
        " half_angle_deg: 50}}",
    ),
}
RATIOS = {
    "ability": {"index_q2": 1.05851325, "middle_q2": 1.05851325},
    "svh": {"right_hand_j3": 1.01511, "right_hand_j4": 1.44889, "right_hand_j14": 1.045},
}


@pytest.fixture(scope="module", params=HANDS)
def hand_file(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder, model, actuator, index, thumb = HANDS[request.param]
    models = Path(os.environ.get("HOLDFAST_SHARED") or REPOSITORY.parent / "shared") / "models"
    if not (models / folder).is_dir():
        pytest.skip(f"the model of the {request.param} hand is not here; HOLDFAST_SHARED names the folder")
    target = tmp_path_factory.mktemp("coupled") / request.param
    shutil.copytree(models / folder, target)
    path = (target / model).parent / f"{request.param}.yaml"
    path.write_text(
        f"name: {request.param}\nimport: {(target / model).name}\nactuator: {actuator}\n"
        f"regions:\n  index/tip: {index}\n  thumb/tip: {thumb}\n"
    )
    return path


def hand_of(path: Path) -> Hand:
    return load_hand(path)


def test_the_ratios_are_those_of_the_model_to_the_last_bit(hand_file):
    hand = hand_of(hand_file)
    for name, ratio in RATIOS[hand_file.stem].items():
        row = hand.coupling_matrix[hand.joint_names.index(name)]
        assert row[np.flatnonzero(row)].tolist() == [ratio]


def test_it_solves_and_coupled_joints_are_where_they_follow(hand_file):
    task = load_task(f"{EXAMPLES / 'pinch.yaml'}@{hand_file}")
    found = solve(task, candidates=4, seed=1, budget_s=60)
    assert len(found) == 4 and all(configuration.certified for configuration in found)
    hand = task.hand
    for configuration in found:
        assert configuration.residual_m < 1e-9
        q = configuration.joint_vector
        for axis, value in zip(hand.axes, q, strict=True):
            if axis.coupling is not None:
                master = q[hand.joint_names.index(axis.coupling.master)]
                assert value == pytest.approx(axis.coupling.ratio * master + axis.coupling.offset, abs=1e-12)


def test_the_simulation_couples_by_the_same_ratios(hand_file):
    hand = hand_of(hand_file)
    model = mujoco.MjModel.from_xml_string(hand_mjcf(hand))
    for axis in hand.axes:
        if axis.coupling is not None:
            equality = model.equality(axis.name)
            assert equality.data[:5] == pytest.approx(
                [axis.coupling.offset, axis.coupling.ratio, 0, 0, 0], rel=1e-12
            )


@pytest.mark.slow
def test_a_grasp_is_freed_and_held(hand_file):
    task = load_task(f"{EXAMPLES / 'pinch.yaml'}@{hand_file}")
    found = solve(task, candidates=6, seed=1, budget_s=120)
    grasps = (make_grasp(configuration) for configuration in found)
    assert any(grasp and try_hold(grasp).held for grasp in grasps)
