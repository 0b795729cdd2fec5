"""Each stage on one grasp: the neighbour room's work in, a record with one more part out."""

from dataclasses import asdict, dataclass
from typing import Generic, TypeVar

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
from ..retraction import ClearConfiguration, retract
from ..solver import Configuration
from . import records
from .grasps import to_solution, updated, vector3
from .records import GraspRecord

__all__ = ["Held", "clear_grasp", "hold_grasp"]

GraspT = TypeVar("GraspT", bound=GraspRecord)
# Samples of a slip curve that are kept: enough for a drawing.
_CURVE_SAMPLES = 41


def clear_grasp(record: GraspT, configuration: Configuration) -> tuple[GraspT, ClearConfiguration | None]:
    """Frees a grasp of penetration: its record with the clearance, and the evidence where that succeeded."""
    outcome = retract(configuration)
    clearance = records.Clearance(
        before=outcome.before_m,
        after=outcome.after_m,
        status=outcome.status if isinstance(outcome, ClearConfiguration) else "failed",
        worst_pair=outcome.worst_pair,
    )
    if not isinstance(outcome, ClearConfiguration):
        return updated(record, clearance=clearance, hold=None), None
    solution = to_solution(outcome.configuration, record.id)
    return updated(record, **dict(solution), clearance=clearance, hold=None), outcome


@dataclass(frozen=True, eq=False)
class Held(Generic[GraspT]):
    """What the hold test leaves.

    Attributes:
        record: the grasp's record with the hold.
        mjcf: the model, with the grasp as its keyframe.
        grasp: the grasp with its squeeze; None where no squeeze was found.
        result: the simulation; None where no squeeze was found.
    """

    record: GraspT
    mjcf: str
    grasp: Grasp | None
    result: HoldResult | None


def hold_grasp(record: GraspT, configuration: Configuration, settings: HoldSettings) -> Held[GraspT]:
    """Squeezes a grasp and holds it against gravity."""
    squeeze = plan_squeeze(configuration, settings)
    if isinstance(squeeze, NotHoldable):
        hold = records.Hold(
            preset=settings.preset, settings=asdict(settings), held=False, reason=_why_not(squeeze)
        )
        return Held(updated(record, hold=hold), grasp_mjcf(configuration, settings), None, None)
    grasp = Grasp(configuration, squeeze)
    result = hold_test(grasp, settings)
    hold = _hold_record(result, squeeze, configuration.task.hand)
    quality = {**record.quality, "directions_held": float(hold.held_count)}
    mjcf = grasp_mjcf(configuration, settings, squeeze.targets)
    return Held(updated(record, hold=hold, quality=quality), mjcf, grasp, result)


def _why_not(squeeze: NotHoldable) -> str:
    lacking = "friction" if squeeze.limit == "friction" else "the strength of the joints"
    share = 100.0 * max(0.0, squeeze.load_factor)
    return f"no squeeze balances more than {share:.0f} % of the weight, for want of {lacking}"


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
