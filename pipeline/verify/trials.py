"""Verdicts of a grasp in the presets of the hold test, each with its reason."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from ...base.numeric.arrays import Array
from ...grasping import ReadyGrasp
from ...mjcf import (
    Grasp,
    HoldResult,
    HoldSettings,
    NotHoldable,
    Squeeze,
    hold_test,
    plan_squeeze,
    preset_settings,
    press_along_normals,
)
from ...solver import Configuration

__all__ = ["PresetTrial", "holds_in", "try_presets"]

# What each finger is expected to press with where no plan says.
_UNPLANNED_N = 10.0


@dataclass(frozen=True)
class PresetTrial:
    """A verdict.

    Attributes:
        held: whether the test was passed.
        reason: why not, in words; empty where it was.
        squeezed_by: whose squeeze it was: `plan` for ours, `file`, or empty where nothing was squeezed.
    """

    held: bool
    reason: str = ""
    squeezed_by: Literal["", "plan", "file"] = ""

    def __str__(self) -> str:
        return "held" if self.held else f"not held: {self.reason}"


def try_presets(
    configuration: Configuration,
    names: Sequence[str],
    *,
    targets: Array | None = None,
    should_stop: Callable[[], bool] = lambda: False,
) -> dict[str, PresetTrial]:
    """The verdicts by preset; squeezes are planned for each, with its load and its friction, unless given.

    Args:
        configuration: the grasp; it need not be clear nor touch exactly.
        names: of presets.
        targets: (n_independent,) where the file sends the servos to squeeze; None where it doesn't say.
        should_stop: asked between tests; what is missing then was not tried.
    """
    found = {}
    for name in names:
        if should_stop():
            break
        settings = preset_settings(name, configuration.task)
        squeeze = plan_squeeze(configuration, settings=settings)
        if targets is not None:
            # Of ours there remains what the pads are expected to bear, which sets how they resist spin.
            ours = _press(configuration, settings) if isinstance(squeeze, NotHoldable) else squeeze
            squeeze = replace(ours, targets=targets)
        if isinstance(squeeze, NotHoldable):
            found[name] = PresetTrial(False, str(squeeze))
            continue
        result = hold_test(Grasp(configuration, squeeze), settings=settings, until_failed=True)
        by: Literal["plan", "file"] = "plan" if targets is None else "file"
        found[name] = PresetTrial(result.held, "" if result.held else _reason(result), by)
    return found


def _press(configuration: Configuration, settings: HoldSettings) -> Squeeze:
    """A squeeze where no forces balance by plan: what the file's own presses with may move the object."""
    return press_along_normals(configuration, _UNPLANNED_N, settings=settings)


def holds_in(made: ReadyGrasp, preset: str) -> bool:
    """Whether a grasp passes the test of a preset."""
    return try_presets(made.configuration, (preset,))[preset].held


def _reason(result: HoldResult) -> str:
    """The first reason why a test is not passed."""
    settings = result.settings
    if settings.penetration_limit_m is not None and result.penetration_m > settings.penetration_limit_m:
        allowed = f"{1e3 * settings.penetration_limit_m:.2g} mm"
        return f"sinks in {1e3 * result.penetration_m:.2g} mm, allowed {allowed}"
    if settings.gap_limit_m is not None and result.gap_m > settings.gap_limit_m:
        return f"a gap of {1e3 * result.gap_m:.2g} mm, allowed {1e3 * settings.gap_limit_m:.2g} mm"
    if not result.kept_place:
        return "the squeeze moves the object too far"
    return next(direction.outcome.value for direction in result.directions if not direction.held)
