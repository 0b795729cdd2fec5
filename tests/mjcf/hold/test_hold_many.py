"""Lifts side by side: what another engine has moved is judged as a lift is, and MuJoCo Warp agrees."""

import importlib.util

import numpy as np
import pytest
from holdfast.errors import InputError, MissingBackend
from holdfast.mjcf import Grasp, Lift, hold_many, hold_test, preset_settings

from ..conftest import limp, squeezed

has_warp = importlib.util.find_spec("mujoco_warp") is not None


def test_a_motion_from_elsewhere_is_judged_as_a_lift_is(firm: Grasp) -> None:
    """MuJoCo's own motion, handed over: the same verdict and the same numbers to the bit."""
    settings = preset_settings("no_noslip", firm.configuration.task)
    here, there = Lift(firm, settings), Lift(firm, settings)
    here.squeeze()
    data = here.simulation.data
    there.squeezed_elsewhere(data.qpos.copy(), data.qvel.copy())
    for direction in settings.directions[:2]:
        ours = here.hold(direction)
        theirs = there.held_elsewhere(direction, ours.qpos, data.qvel.copy())
        assert (theirs.outcome, theirs.touching) == (ours.outcome, ours.touching)
        assert (theirs.slip_m, theirs.rotation_rad) == (ours.slip_m, ours.rotation_rad)
        assert np.array_equal(theirs.times_s, ours.times_s)
        # Moved by more than the limit it is not held, and what is no number broke down.
        far = ours.qpos.copy()
        far[-1, -5] += 2.0 * settings.slip_limit_m
        assert not there.held_elsewhere(direction, far, data.qvel.copy()).held
        far[-1] = np.nan
        assert there.held_elsewhere(direction, far, data.qvel.copy()).outcome.name == "UNSTABLE"


def test_what_is_no_lift_is_refused() -> None:
    with pytest.raises(InputError, match="is no lift"):
        hold_many([squeezed("tuning")])
    with pytest.raises(InputError, match=r"grasps\.0: must be a Grasp"):
        hold_many(["upholding"])  # type: ignore[list-item]


@pytest.mark.skipif(has_warp, reason="MuJoCo Warp is installed")
def test_without_its_packages_it_names_the_extra(firm: Grasp) -> None:
    with pytest.raises(MissingBackend, match=r"pip install 'holdfast\[gpu\]'"):
        hold_many([firm])


@pytest.mark.slow
@pytest.mark.skipif(not has_warp, reason="MuJoCo Warp is not installed: pip install 'holdfast[gpu]'")
@pytest.mark.filterwarnings("ignore")  # of its packages
def test_warp_on_a_processor_says_what_mujoco_says(firm: Grasp, leaning: Grasp) -> None:
    """Grasps of two tasks that hold, and one that lets go, each with pads of its own."""
    settings = preset_settings("no_noslip", firm.configuration.task)
    grasps = [firm, leaning, limp(firm)]
    ours = [hold_test(grasp, settings=settings) for grasp in grasps]
    theirs = hold_many(grasps, settings=settings, device="cpu")
    assert {result.held for result in ours} == {True, False}
    for a, b in zip(ours, theirs, strict=True):
        assert b.held == a.held
        assert [d.outcome for d in b.directions] == [d.outcome for d in a.directions]
        assert abs(b.squeeze_slip_m - a.squeeze_slip_m) < 1e-4
        for x, y in zip(a.directions, b.directions, strict=True):
            # What lets go falls freely, and ends where it is looked for.
            assert not x.held or abs(x.slip_m - y.slip_m) < 1e-4
    with pytest.raises(InputError, match="'moon', and there is cpu"):
        hold_many(grasps, settings=settings, device="moon")
