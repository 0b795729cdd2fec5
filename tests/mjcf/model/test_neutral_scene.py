"""The plain numbers that another engine gets describe the bodies that MuJoCo has."""

import runpy
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from holdfast.geometry import axis_rotation
from holdfast.hands import load_hand
from holdfast.mjcf import HoldSettings, hand_mjcf
from holdfast.objects import load_task

from ..conftest import in_mujoco, posed, solve

SCENE = runpy.run_path(str(Path(__file__).parents[3] / "benchmarks" / "parts" / "neutral_scene.py"))


def poses(scene: dict[str, Any], joints: np.ndarray) -> list[np.ndarray]:
    """Poses (4, 4) of the links from the scene's numbers alone: each axis acts at the origin of its link."""
    found: list[np.ndarray] = []
    values = iter(joints)
    for link in scene["links"]:
        T = np.eye(4) if link["parent"] < 0 else found[link["parent"]] @ np.array(link["T_parent"])
        for axis in link["axes"]:
            step, direction, value = np.eye(4), np.array(axis["direction"]), next(values)
            if axis["kind"] == "revolute":
                step[:3, :3] = axis_rotation(direction, value)
            else:
                step[:3, 3] = value * direction
            T = T @ step
        found.append(T)
    return found


@pytest.mark.parametrize("name", ["sa", "dlr2", "shadow", "robonaut"])
def test_links_have_mujocos_frames_and_masses(name: str) -> None:
    hand = load_hand(name)
    scene = SCENE["_hand"](hand)
    model, data = in_mujoco(hand_mjcf(hand))
    E, offset = np.array(scene["coupling_matrix"]), np.array(scene["coupling_offset"])
    rng = np.random.default_rng(1)
    joints = E @ rng.uniform(-0.3, 0.9, E.shape[1]) + offset
    axes = [axis["name"] for link in scene["links"] for axis in link["axes"]]
    for axis, value in zip(axes, joints, strict=True):
        data.qpos[model.jnt_qposadr[model.joint(axis).id]] = value
    mujoco.mj_forward(model, data)
    for link, T in zip(scene["links"], poses(scene, joints), strict=True):
        body = model.body(link["name"]).id
        assert T[:3, 3] == pytest.approx(data.xpos[body], abs=1e-9)
        assert T[:3, :3] == pytest.approx(data.xmat[body].reshape(3, 3), abs=1e-9)
        check_mass(link["mass"], T, model, data, body)


def test_the_object_has_mujocos_mass_and_the_mass_that_settings_give_it() -> None:
    configuration = solve("firm")
    model, data = posed(configuration)
    body = model.body("object").id
    task = load_task("upholding")
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = data.xmat[body].reshape(3, 3), data.xpos[body]
    check_mass(SCENE["_object"](task, HoldSettings())["object"]["mass"], T, model, data, body)
    heavy = SCENE["_object"](task, HoldSettings(object_mass_kg=0.5))["object"]["mass"]
    assert heavy["mass"] == pytest.approx(0.5)


def check_mass(
    mass: dict[str, Any], T: np.ndarray, model: mujoco.MjModel, data: mujoco.MjData, body: int
) -> None:
    """Mass, centre and central inertia of a body at a pose against MuJoCo's."""
    R, inertial = T[:3, :3], data.ximat[body].reshape(3, 3)
    assert mass["mass"] == pytest.approx(model.body_mass[body])
    assert R @ np.array(mass["centre"]) + T[:3, 3] == pytest.approx(data.xipos[body], abs=1e-8)
    ours = R @ np.array(mass["inertia"]) @ R.T
    theirs = inertial @ np.diag(model.body_inertia[body]) @ inertial.T
    assert ours == pytest.approx(theirs, rel=1e-6, abs=1e-12)


def test_timing_is_that_of_the_settings() -> None:
    task, settings = load_task("tuning"), HoldSettings(turn_s=1.5, hold_s=0.7)
    times = SCENE["_test"](task, settings)["times"]
    assert (times["turn"], times["hold"]) == (1.5, 0.7)
