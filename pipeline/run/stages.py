"""What each stage has made of a grasp, put into its record."""

from dataclasses import asdict
from typing import TypeVar

import numpy as np

from ...base.numeric.arrays import Array
from ...evidence import Evidence
from ...grasping import Clearing, Extras, Refusal, Trial
from ...mjcf import DirectionResult, HoldSettings, LoadLimit, Quality, kind_of_test
from ...mjcf import LessSpin as TriedLessSpin
from ...objects import Task
from ...solver import Configuration
from ..records import (
    Clearance,
    Direction,
    FingerFirst,
    GraspRecord,
    Hold,
    LessSpin,
    Limit,
    Squeeze,
    approach_record,
    evidence_record,
    seal_of,
    thinned,
    to_solution,
    updated,
    vector3,
)

__all__ = [
    "lost_grasp",
    "new_grasp",
    "with_clearing",
    "with_evidence",
    "with_extras",
    "with_limit",
    "with_quality",
    "with_trial",
    "without_squeeze",
]

GraspT = TypeVar("GraspT", bound=GraspRecord)
# Samples of a slip curve that are kept: enough for a drawing.
_CURVE_SAMPLES = 41


def new_grasp(configuration: Configuration, identifier: str) -> GraspRecord:
    """The record of a grasp as the solver has found it."""
    return GraspRecord.model_validate(to_solution(configuration, identifier).model_dump())


def with_clearing(record: GraspT, clearing: Clearing) -> GraspT:
    """The record after retraction; an earlier test no longer counts."""
    clearance = Clearance.model_validate(
        {
            "before": clearing.before_m,
            "after": clearing.after_m,
            "status": clearing.status.value,
            "worst_pair": clearing.worst_pair,
            "reason": "" if clearing.failure is None else str(clearing.failure),
            "margin": clearing.margin_m,
            "route": None if clearing.route is None else str(clearing.route),
            "moved": clearing.moved,
            "differing": list(clearing.differing_pairs),
            "carried_before": None if clearing.strengths is None else _finite(clearing.strengths[0]),
            "carried_after": None if clearing.strengths is None else _finite(clearing.strengths[1]),
        }
    )
    configuration, approach = clearing.configuration, clearing.approach
    return updated(
        record,
        **dict(to_solution(configuration, record.id)),
        strengthened=record.strengthened or clearing.strengthened,
        restarts=record.restarts + clearing.restarts,
        clearance=clearance,
        approach=None if approach is None else approach_record(approach, configuration.task.hand),
        hold=None,
        evidence=None,
    )


def without_squeeze(record: GraspT, refusal: Refusal, settings: HoldSettings) -> GraspT:
    """The record of a grasp that could not be tested, as no squeeze was found."""
    hold = _untested(refusal.configuration.task, settings, str(refusal))
    return updated(record, hold=hold)


def with_trial(record: GraspT, trial: Trial) -> GraspT:
    """The record after the physical test."""
    grasp, hold = trial.grasp, _hold_record(trial)
    tested = updated(
        record,
        approach=approach_record(grasp.approach, grasp.configuration.task.hand),
        hold=hold,
        evidence=None,
        quality={**record.quality, "directions_held": float(hold.held_count)},
    )
    return with_extras(tested, trial.extras)


def with_quality(record: GraspT, quality: Quality | None) -> GraspT:
    """The record with the analytic measures of its configuration; None adds nothing."""
    figures = {} if quality is None else quality.as_record()
    return updated(record, quality={**record.quality, **figures})


def with_evidence(record: GraspT, found: Evidence | None) -> GraspT:
    """The record with what was proved of it beside the verdict; None adds nothing."""
    if found is None:
        return record
    proved = updated(record, evidence=evidence_record(found))
    assert proved.evidence is not None
    return updated(proved, evidence=proved.evidence.model_copy(update={"seal": seal_of(proved)}))


def with_limit(record: GraspT, limit: LoadLimit | None) -> GraspT:
    """The record with what keeps the grasp from carrying its load by plan; None adds nothing."""
    if limit is None or record.hold is None:
        return record
    found = Limit(
        load_factor=limit.load_factor,
        wanted=limit.wanted,
        servos=list(limit.servos),
        efforts=limit.efforts,
        friction=limit.enough_friction,
        words=str(limit),
    )
    return updated(record, hold=record.hold.model_copy(update={"limit": found}))


def with_extras(record: GraspT, extras: Extras) -> GraspT:
    """The record of a tested grasp with what else was found about the verdict."""
    assert record.hold is not None
    squeeze = record.hold.squeeze
    agreement, robustness = extras.agreement, extras.robustness
    gravity = record.hold.settings["gravity"]
    tried = () if agreement is None else agreement.directions
    found = {
        "margin": extras.margin,
        "settings_agree": None if agreement is None else agreement.agree,
        "agreement": {} if agreement is None else agreement.variants,
        "agreement_directions": [vector3(gravity * np.array(direction)) for direction in tried],
        "probability": None if robustness is None else robustness.probability,
        "squeeze": None if squeeze is None else squeeze.model_copy(update={"least": extras.least_squeeze}),
        "trials": 0 if robustness is None else robustness.noise.trials,
    }
    return updated(record, hold=record.hold.model_copy(update=found))


def lost_grasp(record: GraspT, task: Task, settings: HoldSettings) -> GraspT:
    """The record of a grasp that ended every process that worked on it."""
    return updated(record, hold=_untested(task, settings, "every process that worked on it broke down"))


def _untested(task: Task, settings: HoldSettings, reason: str) -> Hold:
    return Hold(
        preset=settings.preset,
        settings=asdict(settings),
        kind=kind_of_test(task),
        held=False,
        reason=reason,
    )


def _hold_record(trial: Trial) -> Hold:
    result, squeeze = trial.result, trial.grasp.squeeze
    names = trial.grasp.configuration.task.hand.independent_names
    creep = _finite(result.creep_m_s)
    return Hold(
        preset=result.settings.preset,
        settings=asdict(result.settings),
        kind=result.kind,
        held=result.held,
        narrow=trial.is_narrow if trial.is_firmness_known else None,
        near_miss=None if result.held else result.is_near_miss,
        strain=trial.strain,
        fingers=[
            FingerFirst(
                finger=entry.finger,
                slip=_finite(entry.slip_m),
                rotation=_finite(entry.rotation_rad),
                kept=entry.kept,
            )
            for entry in trial.fingers
        ],
        less_spin=_less_spin_record(trial.less_spin, result.settings),
        creep=creep,
        creep_rotation=_finite(result.creep_rad_s),
        at_rest=None if creep is None else result.is_at_rest,
        directions=[_direction_record(entry, result.settings) for entry in result.directions],
        squeeze=Squeeze(
            targets=dict(zip(names, squeeze.targets.tolist(), strict=True)),
            efforts=dict(zip(names, squeeze.efforts.tolist(), strict=True)),
            normal_forces=squeeze.preload[:, 0].tolist(),
            contact_forces=squeeze.preload.tolist(),
            path=[dict(zip(names, place.tolist(), strict=True)) for place in squeeze.path],
            load_factor=squeeze.load_factor,
            rule=squeeze.rule,
            slip=_finite(result.squeeze_slip_m),
            rotation=_finite(result.squeeze_rotation_rad),
            spin_arms=squeeze.spin_arms_m.tolist(),
            yields=squeeze.yields_m.tolist(),
            centres=squeeze.centres_m.tolist(),
            simulated_forces=result.squeezed_normals_N.tolist() if result.is_finite else [],
            rated_force=trial.grasp.configuration.task.hand.rated_force_N,
        ),
    )


def _less_spin_record(entry: TriedLessSpin | None, settings: HoldSettings) -> LessSpin | None:
    if entry is None:
        return None
    return LessSpin(
        share=entry.share,
        gravity=vector3(settings.gravity * np.array(entry.gravity)),
        slip=_finite(entry.slip_m),
        rotation=_finite(entry.rotation_rad),
        held=entry.held,
    )


def _direction_record(entry: DirectionResult, settings: HoldSettings) -> Direction:
    return Direction(
        gravity=vector3(settings.gravity * np.array(entry.gravity)),
        held=entry.held,
        outcome=entry.outcome.value,
        slip=_finite(entry.slip_m),
        rotation=_finite(entry.rotation_rad),
        creep=_finite(entry.creep_m_s),
        curve=_curve(entry.times_s, entry.slip_curve_m),
        rotation_curve=_curve(entry.times_s, entry.rotation_curve_rad),
        motion=thinned(entry.times_s, entry.qpos),
    )


def _curve(times_s: Array, values: Array) -> list[tuple[float, float]]:
    kept = np.unique(np.linspace(0, len(times_s) - 1, _CURVE_SAMPLES).round().astype(int))
    return [(float(times_s[k]), float(values[k])) for k in kept if np.isfinite(values[k])]


def _finite(value: float) -> float | None:
    """JSON has no NaN: what a broken simulation measured is None."""
    return float(value) if np.isfinite(value) else None
