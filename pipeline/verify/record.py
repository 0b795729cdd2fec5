"""A verification for programs: plain data, as `--json` writes it."""

from collections.abc import Mapping
from math import isfinite
from typing import Any

from ... import __version__
from ...geometry import quaternion_from_rotation
from ...hands import Hand
from .judge import Judged
from .nearby import Nearby
from .trials import PresetTrial
from .verify import ReadPool, Verification, Verified

__all__ = ["as_record"]


def as_record(verification: Verification) -> dict[str, Any]:
    """All that was found; lengths in m, angles in rad, poses of the object in the palm's frame."""
    score = verification.label_auc()
    return {
        "holdfast": __version__,
        "hand": verification.hand.name,
        "object": verification.sized.base.name,
        "object_loaded_at": verification.sized.loaded_at.tolist(),
        "readings": [_reading(read) for read in verification.pools],
        "summary": {
            "grasps": len(verification.grasps),
            "sound": verification.sound,
            "certified_nearby": verification.fixed,
            "labels": {
                preset: {"agree": agree, "of": of} for preset, (agree, of) in verification.agreement().items()
            },
            "label_auc": score,
        },
        "grasps": [_grasp(verification.hand, grasp) for grasp in verification.grasps],
    }


def _reading(read: ReadPool) -> dict[str, Any]:
    reading = read.reading
    return {
        "files": list(dict.fromkeys(str(origin.path) for origin, _ in read.pool.origin)),
        "format": read.pool.file.format,
        "variant": read.pool.file.variant,
        "answers": dict(reading.answers),
        "found_by_geometry": dict(reading.found),
        "against_the_file": list(reading.against),
        "left_open": {name: list(answers) for name, answers in reading.left_open.items()},
        "near_the_object": reading.share,
        "fits": reading.fits,
        "unknown_joints": list(read.interpreter.unknown),
        "missing_joints": list(read.interpreter.filled),
        "squeezes": read.squeezes is not None,
        "objects_moved": reading.moved_m,
    }


def _grasp(hand: Hand, grasp: Verified) -> dict[str, Any]:
    judged = grasp.judged
    return {
        "file": str(grasp.file.path),
        "name": grasp.name,
        "label": grasp.label,
        "labels": dict(grasp.file.grasps[grasp.index].labels),
        "sound": judged.is_sound,
        "faults": [{"kind": fault.kind, "text": fault.text} for fault in judged.faults],
        **_given(hand, judged),
        "presets": _trials(judged.trials),
        "nearby": None if judged.nearby is None else _nearby(judged.nearby, judged.nearby_trials),
    }


def _given(hand: Hand, judged: Judged) -> dict[str, Any]:
    given = judged.measured
    return {
        "joints": dict(zip(hand.joint_names, given.joints.tolist(), strict=True)),
        "object": _pose(given.T_palm_object[:3, :3], given.T_palm_object[:3, 3]),
        "contacts": [
            {
                "link": hand.links[touch.link].name,
                "finger": touch.finger,
                "distance": touch.distance_m,
                "point": touch.point.tolist(),
                "normal": touch.normal.tolist(),
            }
            for touch in given.touches
        ],
        "penetration": [{"pair": [pair.a, pair.b], "depth": pair.depth_m} for pair in given.sunk],
        "off": dict(judged.off_m),
        "beyond_limits": dict(given.beyond_limits),
        "carries": judged.carried,
        "would_carry": judged.closed,
        "friction_needed": judged.friction_needed if isfinite(judged.friction_needed) else None,
    }


def _trials(trials: Mapping[str, PresetTrial]) -> dict[str, Any]:
    return {
        name: {"held": trial.held, "reason": trial.reason, "squeezed_by": trial.squeezed_by}
        for name, trial in trials.items()
    }


def _nearby(nearby: Nearby, trials: Mapping[str, PresetTrial]) -> dict[str, Any]:
    out: dict[str, Any] = {"verdict": nearby.verdict.value, "reason": nearby.reason}
    if nearby.grasp is not None:
        configuration = nearby.grasp.configuration
        certificate = configuration.certificate
        out |= {
            "joints": configuration.joints,
            "object": _pose(configuration.state.R_palm_object, configuration.state.p_palm_object),
            "contacts": [contact.hand.name for contact in configuration.task.contacts],
            "dropped": list(nearby.dropped),
            "certified_radius": None if certificate is None else certificate.radius,
            "presets": _trials(trials),
        }
    return out


def _pose(R: Any, p: Any) -> dict[str, list[float]]:
    return {"position": p.tolist(), "quaternion": quaternion_from_rotation(R).tolist()}
