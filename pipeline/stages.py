"""Each stage on one grasp: the neighbour room's work in, a record with one more part out."""

from dataclasses import asdict
from typing import TypeVar

import numpy as np

from ..hands import Hand
from ..mjcf import (
    DirectionResult,
    Grasp,
    HoldResult,
    HoldSettings,
    NotHoldable,
    Squeeze,
    grasp_mjcf,
    hold_test,
    plan_squeeze,
)
from ..retraction import ClearConfiguration, RetractionOutcome, retract
from ..solver import Configuration
from . import records
from .grasps import to_solution, updated, vector3
from .records import GraspRecord
from .strengthen import strengthen

__all__ = ["clear_grasp", "hold_grasp", "place_grasp"]

GraspT = TypeVar("GraspT", bound=GraspRecord)
# Turns of strengthening and retraction.
_MOST_TURNS = 3
# Samples of a slip curve that are kept: enough for a drawing.
_CURVE_SAMPLES = 41


def clear_grasp(record: GraspT, configuration: Configuration) -> tuple[GraspT, ClearConfiguration | None]:
    """Frees a grasp of penetration: its record with the clearance, and the evidence where that succeeded."""
    outcome = retract(configuration)
    return _with_clearance(record, outcome, outcome.before_m)


def place_grasp(
    record: GraspT, configuration: Configuration, settings: HoldSettings
) -> tuple[GraspT, ClearConfiguration | None]:
    """`clear_grasp` for a grasp that is to be held as well.

    Strengthening and retraction take turns, as each may undo a little of what the other did. Both move along
    the contact manifold, so the contacts hold throughout.
    """
    before_m: float | None = None
    clear: ClearConfiguration | None = None
    outcome: RetractionOutcome | None = None
    for _ in range(_MOST_TURNS):
        stronger = strengthen(configuration, settings)
        if outcome is not None and stronger is configuration:
            break
        outcome = retract(stronger)
        before_m = outcome.before_m if before_m is None else before_m
        if not isinstance(outcome, ClearConfiguration):
            break
        clear, configuration = outcome, outcome.configuration
    assert outcome is not None and before_m is not None  # there was a first turn
    return _with_clearance(record, clear or outcome, before_m)


def _with_clearance(
    record: GraspT, outcome: RetractionOutcome, before_m: float
) -> tuple[GraspT, ClearConfiguration | None]:
    clear = outcome if isinstance(outcome, ClearConfiguration) else None
    clearance = records.Clearance(
        before=before_m,
        after=outcome.after_m,
        # A later turn may find clear what an earlier one has retracted.
        status="retracted" if clear and before_m != outcome.after_m else outcome.status,
        worst_pair=outcome.worst_pair,
        reason="" if clear else str(outcome),
    )
    solution = to_solution(outcome.configuration, record.id)
    return updated(record, **dict(solution), clearance=clearance, hold=None), clear


def hold_grasp(record: GraspT, configuration: Configuration, settings: HoldSettings) -> tuple[GraspT, str]:
    """Squeezes a grasp and holds it against gravity: its record with the hold, and its model as MJCF."""
    squeeze = plan_squeeze(configuration, settings)
    if isinstance(squeeze, NotHoldable):
        hold = records.Hold(
            preset=settings.preset, settings=asdict(settings), held=False, reason=_why_not(squeeze)
        )
        return updated(record, hold=hold), grasp_mjcf(configuration, settings)
    result = hold_test(Grasp(configuration, squeeze), settings)
    hold = _hold_record(result, squeeze, configuration.task.hand)
    quality = {**record.quality, "directions_held": float(hold.held_count)}
    mjcf = grasp_mjcf(configuration, settings, squeeze.targets)
    return updated(record, hold=hold, quality=quality), mjcf


def _why_not(squeeze: NotHoldable) -> str:
    return f"no squeeze: {squeeze.obstacle.value}"


def _hold_record(result: HoldResult, squeeze: Squeeze, hand: Hand) -> records.Hold:
    names = hand.independent_names
    return records.Hold(
        preset=result.settings.preset,
        settings=asdict(result.settings),
        held=result.held,
        directions=[_direction_record(entry, result.settings) for entry in result.directions],
        squeeze=records.Squeeze(
            targets=dict(zip(names, squeeze.targets.tolist(), strict=True)),
            efforts=dict(zip(names, squeeze.efforts.tolist(), strict=True)),
            normal_forces=squeeze.preload[:, 0].tolist(),
            load_factor=squeeze.load_factor,
            slip=_finite(result.squeeze_slip_m),
            rotation=_finite(result.squeeze_rotation_rad),
        ),
    )


def _direction_record(entry: DirectionResult, settings: HoldSettings) -> records.Direction:
    kept = np.unique(np.linspace(0, len(entry.times_s) - 1, _CURVE_SAMPLES).round().astype(int))
    curve = [(float(entry.times_s[k]), float(entry.slip_curve_m[k])) for k in kept]
    return records.Direction(
        gravity=vector3(settings.gravity * np.array(entry.gravity)),
        held=entry.held,
        outcome=entry.outcome.value,
        slip=_finite(entry.slip_m),
        rotation=_finite(entry.rotation_rad),
        curve=[(time, slip) for time, slip in curve if np.isfinite(slip)],
    )


def _finite(value: float) -> float | None:
    """JSON has no NaN: what a broken simulation measured is None."""
    return float(value) if np.isfinite(value) else None
