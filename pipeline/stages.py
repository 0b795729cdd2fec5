"""Each stage on one grasp: the neighbour room's work in, a record with one more part out."""

from dataclasses import asdict, dataclass
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
    strengthen,
)
from ..retraction import ClearConfiguration, RetractionOutcome, retract
from ..solver import Configuration
from . import records
from .grasps import to_solution, updated, vector3
from .records import GraspRecord

__all__ = ["clear_grasp", "hold_grasp", "place_grasp"]

GraspT = TypeVar("GraspT", bound=GraspRecord)
# Turns of strengthening and retraction.
_MOST_TURNS = 3
# Samples of a slip curve that are kept: enough for a drawing.
_CURVE_SAMPLES = 41


def clear_grasp(record: GraspT, configuration: Configuration) -> tuple[GraspT, ClearConfiguration | None]:
    """Frees a grasp of penetration: its record with the clearance, and the evidence where that succeeded."""
    return _after_turns(record, [_Turn(False, retract(configuration))])


def place_grasp(
    record: GraspT, configuration: Configuration, settings: HoldSettings
) -> tuple[GraspT, ClearConfiguration | None]:
    """`clear_grasp` for a grasp that is to be held as well.

    Strengthening and retraction take turns, as each may undo a little of what the other did. Both keep to the
    contact manifold, so the contacts hold throughout.
    """
    turns: list[_Turn] = []
    for _ in range(_MOST_TURNS):
        stronger = strengthen(configuration, settings)
        if turns and stronger is configuration:
            break
        turn = _Turn(stronger is not configuration, retract(stronger))
        is_clear = isinstance(turn.outcome, ClearConfiguration)
        if is_clear or not turns:  # else the last clear one stands
            turns.append(turn)
        if not is_clear:
            break
        configuration = turn.outcome.configuration
    return _after_turns(record, turns)


@dataclass(frozen=True, eq=False)
class _Turn:
    """A turn of strengthening, if it moved the grasp, and retraction."""

    strengthened: bool
    outcome: RetractionOutcome


def _after_turns(record: GraspT, turns: list[_Turn]) -> tuple[GraspT, ClearConfiguration | None]:
    """The record after at least one turn, of which all but the last have ended clear."""
    outcomes = [turn.outcome for turn in turns]
    last = outcomes[-1]
    clear = last if isinstance(last, ClearConfiguration) else None
    # A later turn may find clear what an earlier one has retracted.
    decisive = next((outcome for outcome in outcomes if outcome.status == "retracted"), last)
    clearance = records.Clearance(
        before=decisive.before_m,
        after=last.after_m,
        status=decisive.status if clear else "failed",
        worst_pair=last.worst_pair,
        reason="" if clear else str(last),
    )
    restarts = sum(outcome.restarts for outcome in outcomes if isinstance(outcome, ClearConfiguration))
    found = updated(
        record,
        **dict(to_solution(last.configuration, record.id)),
        strengthened=record.strengthened or any(turn.strengthened for turn in turns),
        restarts=record.restarts + restarts,
        clearance=clearance,
        hold=None,
    )
    return found, clear


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
