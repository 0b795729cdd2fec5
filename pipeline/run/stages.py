"""Each stage on one grasp: the neighbour room's work in, a record with one more part out."""

from dataclasses import asdict, dataclass
from typing import TypeVar

import numpy as np

from ...mjcf import (
    DirectionResult,
    Grasp,
    HoldResult,
    HoldSettings,
    Noise,
    NotHoldable,
    grasp_quality,
    hold_margin,
    hold_probability,
    hold_test,
    kind_of_test,
    plan_squeeze,
    settings_agreement,
    strengthen,
    trial_mjcf,
)
from ...retraction import (
    Approach,
    ClearConfiguration,
    RetractionOutcome,
    RetractionSettings,
    compare_clearance,
    find_approach,
    retract,
)
from ...solver import Configuration
from ..records import GraspRecord, approach_record, records, to_solution, updated, vector3

__all__ = ["Extras", "Placed", "clear_grasp", "hold_grasp", "place_grasp"]

GraspT = TypeVar("GraspT", bound=GraspRecord)
# Turns of strengthening and retraction.
_MOST_TURNS = 3
# Samples of a slip curve that are kept: enough for a drawing.
_CURVE_SAMPLES = 41


@dataclass(frozen=True, eq=False)
class Placed:
    """A clear configuration, and how the fingers get there."""

    configuration: Configuration
    approach: Approach


def clear_grasp(
    record: GraspT, configuration: Configuration, retraction: RetractionSettings | None = None
) -> tuple[GraspT, Placed | None]:
    """Frees a grasp of penetration: its record with the clearance, and where it is then if that succeeded."""
    retraction = retraction or RetractionSettings()
    return _after_turns(record, [_Turn(False, retract(configuration, settings=retraction))], retraction)


def place_grasp(
    record: GraspT,
    configuration: Configuration,
    settings: HoldSettings,
    retraction: RetractionSettings | None = None,
) -> tuple[GraspT, Placed | None]:
    """`clear_grasp` for a grasp that is to be held as well.

    Strengthening and retraction take turns, as each may undo a little of what the other did. Both keep to the
    contact manifold, so the contacts hold throughout.
    """
    retraction = retraction or RetractionSettings()
    turns: list[_Turn] = []
    for _ in range(_MOST_TURNS):
        stronger = strengthen(configuration, settings=settings)
        if turns and stronger is configuration:
            break
        turn = _Turn(stronger is not configuration, retract(stronger, settings=retraction))
        is_clear = isinstance(turn.outcome, ClearConfiguration)
        if is_clear or not turns:  # else the last clear one stands
            turns.append(turn)
        if not is_clear:
            break
        configuration = turn.outcome.configuration
    return _after_turns(record, turns, retraction)


@dataclass(frozen=True, eq=False)
class _Turn:
    """A turn of strengthening, if it moved the grasp, and retraction."""

    strengthened: bool
    outcome: RetractionOutcome


def _after_turns(
    record: GraspT, turns: list[_Turn], retraction: RetractionSettings
) -> tuple[GraspT, Placed | None]:
    """The record after at least one turn, of which all but the last have ended clear."""
    outcomes = [turn.outcome for turn in turns]
    last = outcomes[-1]
    clear = last if isinstance(last, ClearConfiguration) else None
    # A later turn may find clear what an earlier one has retracted.
    decisive = next((outcome for outcome in outcomes if outcome.status == "retracted"), last)
    clearance = records.Clearance(
        before=decisive.before_m,
        after=last.after_m,
        status=decisive.status.value if clear else "failed",
        worst_pair=last.worst_pair,
        reason="" if clear else str(last),
        margin=retraction.margin_m,
        route=decisive.route.value if clear and isinstance(decisive, ClearConfiguration) else None,
        moved=sum(outcome.moved for outcome in outcomes if isinstance(outcome, ClearConfiguration)),
        differing=_differing(last.configuration, retraction),
    )
    # What it came to from nearby, along its contacts, is still the solver's configuration.
    restarts = sum(
        outcome.restarts
        for outcome in outcomes
        if isinstance(outcome, ClearConfiguration) and outcome.route == "anew"
    )
    placed = Placed(clear.configuration, find_approach(clear.configuration)) if clear else None
    found = updated(
        record,
        **dict(to_solution(last.configuration, record.id)),
        strengthened=record.strengthened or any(turn.strengthened for turn in turns),
        restarts=record.restarts + restarts,
        clearance=clearance,
        approach=approach_record(placed.approach, last.configuration.task.hand) if placed else None,
        hold=None,
    )
    return found, placed


def _differing(configuration: Configuration, retraction: RetractionSettings) -> list[tuple[str, str]]:
    comparison = compare_clearance(configuration.task, configuration.state, settings=retraction)
    return [(pair.a, pair.b) for pair, _ in comparison.differing]


@dataclass(frozen=True)
class Extras:
    """What a test is asked for beside its verdict; each costs more simulations.

    Attributes:
        margin: the load at which the grasp first fails.
        agreement: the verdicts with other numerical settings.
        noise: the probability of passing with noise.
        of_failed: whether grasps that failed are asked too.
    """

    margin: bool = False
    agreement: bool = False
    noise: Noise | None = None
    of_failed: bool = False


def hold_grasp(
    record: GraspT,
    configuration: Configuration,
    settings: HoldSettings,
    extras: Extras | None = None,
    known_approach: Approach | None = None,
) -> tuple[GraspT, str]:
    """Squeezes a grasp and puts it to the test: its record with the hold, and its model as MJCF.

    Args:
        record: of the grasp so far.
        configuration: what it describes.
        settings: of the test.
        extras: what to find out beside the verdict; None for nothing.
        known_approach: of the configuration, where it has been found already.
    """
    extras = extras or Extras()
    squeeze = plan_squeeze(configuration, settings=settings)
    quality = {**record.quality, **grasp_quality(configuration, settings=settings).as_record()}
    if isinstance(squeeze, NotHoldable):
        hold = records.Hold(
            preset=settings.preset,
            settings=asdict(settings),
            kind=kind_of_test(configuration.task),
            held=False,
            reason=_why_not(squeeze),
        )
        return updated(record, hold=hold, quality=quality), trial_mjcf(configuration, settings=settings)
    grasp = Grasp(configuration, squeeze, known_approach)
    result = hold_test(grasp, settings=settings)
    hold = _hold_record(result, grasp)
    if result.held or extras.of_failed:
        hold = _with_extras(hold, grasp, result, extras)
    quality |= {"directions_held": float(hold.held_count)}
    approach = approach_record(grasp.approach, configuration.task.hand)
    mjcf = trial_mjcf(
        configuration, settings=settings, targets=squeeze.targets, pregrasp=grasp.approach.pregrasp
    )
    return updated(record, approach=approach, hold=hold, quality=quality), mjcf


def _with_extras(hold: records.Hold, grasp: Grasp, result: HoldResult, extras: Extras) -> records.Hold:
    found: dict[str, object] = {}
    if extras.margin:
        found["margin"] = hold_margin(grasp, settings=result.settings)
    if extras.agreement:
        agreement = settings_agreement(grasp, result)
        found |= {"settings_agree": agreement.agree, "agreement": agreement.variants}
    if extras.noise is not None:
        robustness = hold_probability(grasp, settings=result.settings, noise=extras.noise)
        found |= {"probability": robustness.probability, "trials": extras.noise.trials}
    return records.Hold.model_validate({**dict(hold), **found})


def _why_not(squeeze: NotHoldable) -> str:
    return f"no squeeze: {squeeze.obstacle.value}"


def _hold_record(result: HoldResult, grasp: Grasp) -> records.Hold:
    squeeze, names = grasp.squeeze, grasp.configuration.task.hand.independent_names
    creep = _finite(result.creep_m_s)
    return records.Hold(
        preset=result.settings.preset,
        settings=asdict(result.settings),
        kind=result.kind,
        held=result.held,
        creep=creep,
        creep_rotation=_finite(result.creep_rad_s),
        at_rest=None if creep is None else result.is_at_rest,
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
        creep=_finite(entry.creep_m_s),
        curve=[(time, slip) for time, slip in curve if np.isfinite(slip)],
    )


def _finite(value: float) -> float | None:
    """JSON has no NaN: what a broken simulation measured is None."""
    return float(value) if np.isfinite(value) else None
