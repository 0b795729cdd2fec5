"""Presets say what they should, and a file with a slip is refused."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from holdfast.errors import InputError, UnknownName
from holdfast.mjcf import (
    Grasp,
    HoldSettings,
    Squeeze,
    directions,
    hold_test,
    plan_squeeze,
    preset_names,
    preset_settings,
)
from holdfast.mjcf.carried import carried_object
from holdfast.mjcf.presets import PresetSpec, preset_specs, read_presets
from holdfast.objects import LiftTest, Task, load_task


@pytest.fixture(scope="module")
def task() -> Task:
    return load_task("upholding")


def test_the_names() -> None:
    assert preset_names() == ("holdfast", "dexgraspbench", "dexonomy", "dexgraspnet", "multidex", "graspqp")


def test_our_own_preset_is_spelt_out_in_full_and_is_the_default(task: Task) -> None:
    spec = preset_specs()["holdfast"]
    assert spec.model_fields_set == set(PresetSpec.model_fields) - {"force"}
    assert preset_settings("holdfast", task, directions_name="six") == HoldSettings()


@pytest.mark.parametrize(
    ("name", "mass", "newtons", "seconds", "slip_m", "degrees", "touch"),
    [
        ("dexgraspbench", 0.1, 1.0, 2.0, 0.05, 15.0, "none"),
        ("dexonomy", 0.1, 0.98, 2.0, 0.05, 15.0, "none"),
        ("dexgraspnet", None, None, 100 / 60, 1.0, None, "any"),
        ("multidex", None, None, 50 / 60, 0.02, None, "none"),
        ("graspqp", None, 3.0, 0.5, 0.03, None, "none"),
    ],
)
def test_presets_follow_their_protocols(
    task: Task,
    name: str,
    mass: float | None,
    newtons: float | None,
    seconds: float,
    slip_m: float,
    degrees: float | None,
    touch: str,
) -> None:
    settings = preset_settings(name, task)
    obj = carried_object(task, settings)
    assert obj.inertia.mass == pytest.approx(mass or task.object.inertia.mass)
    if newtons is not None:
        assert obj.inertia.mass * settings.gravity == pytest.approx(newtons)
    assert settings.hold_s == pytest.approx(seconds)
    assert settings.slip_limit_m == slip_m
    limit = settings.rotation_limit_rad
    assert (limit is None) if degrees is None else limit == pytest.approx(np.deg2rad(degrees))
    assert settings.must_touch == touch
    assert len(settings.directions) == 6


@pytest.mark.parametrize("name", ["dexgraspbench", "dexgraspnet", "graspqp"])
def test_presets_run(firm: Grasp, name: str) -> None:
    settings = preset_settings(name, firm.configuration.task)
    squeeze = plan_squeeze(firm.configuration, settings)
    assert isinstance(squeeze, Squeeze)
    result = hold_test(Grasp(firm.configuration, squeeze), settings)
    assert result.settings.preset == name
    assert np.isfinite(result.slip_m)


def test_directions_by_name(task: Task) -> None:
    assert len(directions("six", task)) == 6
    sphere = np.array(directions("sphere", task))
    assert sphere.shape == (26, 3)
    assert np.linalg.norm(sphere, axis=1) == pytest.approx(np.ones(26))
    assert len({tuple(np.round(d, 6)) for d in sphere}) == 26
    down = replace(task, test=LiftTest(directions=((0.0, 0.0, -1.0),)))
    assert directions("task", down) == ((0.0, 0.0, -1.0),)
    assert preset_settings("holdfast", down).directions == ((0.0, 0.0, -1.0),)
    assert len(preset_settings("holdfast", down, directions_name="sphere").directions) == 26


def test_unknown_names(task: Task) -> None:
    with pytest.raises(UnknownName, match="did you mean 'multidex'"):
        preset_settings("multidox", task)
    with pytest.raises(UnknownName, match="set of directions"):
        directions("seven", task)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("mine: {gravty: 1.0}", "mine.gravty: unknown field; did you mean 'gravity'?"),
        ("mine: {gravity: -1.0}", "mine.gravity: input should be greater than 0"),
        ("mine: {gravity: 9.81, force: 3.0}", "gravity and force exclude each other"),
        ("mine: {must_touch: some}", "mine.must_touch"),
        ("mine: 3", "mine: must be a mapping"),
    ],
)
def test_a_slip_in_a_file_is_named(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "presets.yaml"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        read_presets(path)
    assert message in str(caught.value)


def test_presets_of_a_file(tmp_path: Path, task: Task) -> None:
    path = tmp_path / "presets.yaml"
    path.write_text("gentle: {gravity: 1.62, hold: 0.5}")
    settings = preset_settings("gentle", task, specs=read_presets(path))
    assert settings == replace(HoldSettings(), preset="gentle", gravity=1.62, hold_s=0.5)


def test_limits_on_the_grasp_itself_decide(firm: Grasp) -> None:
    settings = HoldSettings(directions=((0.0, 0.0, 1.0),), hold_s=0.2)
    result = hold_test(firm, settings)
    assert result.held
    for sunk in (replace(result, penetration_m=0.002), replace(result, gap_m=0.003)):
        assert sunk.held
        strict = replace(settings, penetration_limit_m=0.001, gap_limit_m=0.002)
        assert not replace(sunk, settings=strict).held


def test_which_contacts_must_touch_is_a_setting(firm: Grasp) -> None:
    """Fingers that open let go; only a test that asks for no contact and no place calls that held."""
    task = firm.configuration.task
    opened = np.clip(0.0, *task.hand.limits.T)
    slack = replace(firm, squeeze=replace(firm.squeeze, targets=opened))
    far = HoldSettings(
        directions=((0.0, 0.0, 1.0),), hold_s=0.1, slip_limit_m=1.0, rotation_limit_rad=None, gravity=0.01
    )
    for touch, held in (("all", False), ("any", False), ("none", True)):
        assert hold_test(slack, replace(far, must_touch=touch)).held is held
