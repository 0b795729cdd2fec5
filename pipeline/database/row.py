"""Grasps as rows of a table, and rows as grasps again."""

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...base.files.file_model import parse
from ...errors import InputError
from ..records import GraspRecord, to_json
from .columns import COLUMNS, SCHEMA_VERSION
from .head import RowHead

__all__ = ["Row", "make_row", "read_row"]


@dataclass(frozen=True)
class Row:
    """A row that is whole.

    Attributes:
        number: its number in the table.
        head: what it has in common with the other rows of its run.
        grasp: the grasp.
    """

    number: int
    head: RowHead
    grasp: GraspRecord


def make_row(number: int, head: RowHead, grasp: GraspRecord) -> dict[str, Any]:
    """The values of a row by column, as plain data."""
    kept = _without_curves(grasp)
    data = {"row": number, **head.model_dump(), **_figures(kept), "record": json.dumps(to_json(kept))}
    return {**data, "seal": _seal(data)}


def read_row(data: dict[str, Any], source: str | Path) -> Row:
    """The row that was written with these values; nothing of one that was changed is believed.

    Raises:
        InputError: a column is missing or unknown, the schema is of another version, or a value is not what
            was written.
    """
    names = [column.name for column in COLUMNS]
    for name in names:
        if name not in data:
            raise InputError(source, name, "is required")
    number = data["row"]
    where = f"row {number}"
    if data["schema_version"] != SCHEMA_VERSION:
        raise InputError(
            source, where, f"has schema version {data['schema_version']}; this reads {SCHEMA_VERSION}"
        )
    values = {name: data[name] for name in names if name != "seal"}
    if not isinstance(data["record"], str) or _seal(values) != data["seal"]:
        raise InputError(source, where, "is damaged: its values are not those that were sealed")
    head = parse(RowHead, {name: values[name] for name in RowHead.model_fields}, source)
    try:
        record = json.loads(values["record"])
    except (ValueError, RecursionError):
        raise InputError(source, where, "is damaged: its record is not JSON") from None
    grasp = parse(GraspRecord, record, f"{source}: {where}")
    # A seal can be made anew by whoever changes a row; what follows from the record can't be.
    for name, value in _figures(grasp).items():
        if values[name] != value:
            raise InputError(source, where, f"is damaged: column {name} contradicts its record")
    return Row(number, head, grasp)


def _without_curves(grasp: GraspRecord) -> GraspRecord:
    """The grasp without what only drawings need, which is half of it."""
    if grasp.hold is None:
        return grasp
    directions = [entry.model_copy(update={"curve": []}) for entry in grasp.hold.directions]
    return grasp.model_copy(update={"hold": grasp.hold.model_copy(update={"directions": directions})})


def _seal(data: dict[str, Any]) -> str:
    try:
        text = json.dumps(data, sort_keys=True, separators=(",", ":"), allow_nan=False)
    except (TypeError, ValueError):  # a value that was never written
        return ""
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def _figures(grasp: GraspRecord) -> dict[str, Any]:
    """The columns that follow from the grasp's record alone."""
    return {**_configuration(grasp), **_clearance(grasp), **_test(grasp), **_proofs(grasp)}


def _configuration(grasp: GraspRecord) -> dict[str, Any]:
    return {
        "grasp": grasp.id,
        "joints": dict(grasp.joints),
        "object_position_m": list(grasp.object.position),
        "object_quaternion": list(grasp.object.quaternion),
        "parameters": list(grasp.parameters),
        "contacts": [
            {
                "hand": contact.hand,
                "object": contact.object,
                "point_m": list(contact.point),
                "normal": list(contact.normal),
                "gap_m": contact.gap,
                "region_gap_m": contact.region_gap,
                "normal_angle_rad": contact.normal_angle,
                "opposed_within_deg": contact.opposed_within_deg,
            }
            for contact in grasp.contacts
        ],
        "certified": grasp.certified,
        "certified_radius": grasp.certified_radius,
        "residual_m": grasp.residual,
        "strengthened": grasp.strengthened,
        "quality": dict(grasp.quality),
    }


def _clearance(grasp: GraspRecord) -> dict[str, Any]:
    found = grasp.clearance
    return {
        "clear": None if found is None else grasp.is_clear,
        "clearance_status": None if found is None else found.status,
        "clearance_before_m": None if found is None else found.before,
        "clearance_m": None if found is None else found.after,
        "clearance_pair": None if found is None or found.worst_pair is None else list(found.worst_pair),
        "reachable": None if grasp.approach is None else grasp.approach.reachable,
    }


def _test(grasp: GraspRecord) -> dict[str, Any]:
    hold, squeeze = grasp.hold, None if grasp.hold is None else grasp.hold.squeeze
    directions = [] if hold is None else hold.directions
    failed = next((entry.outcome for entry in directions if not entry.held), "")
    return {
        "tested": bool(directions),
        "test": None if hold is None else hold.kind,
        "preset": None if hold is None else hold.preset,
        "held": None if hold is None else hold.held,
        "narrow": None if hold is None else hold.narrow,
        "good": grasp.is_good,
        "margin": None if hold is None else hold.margin,
        "settings_agree": None if hold is None else hold.settings_agree,
        "slip_m": None if hold is None else hold.slip,
        "turn_rad": None if hold is None else hold.rotation,
        "creep_m_s": None if hold is None else hold.creep,
        "directions": [
            {
                "gravity_m_s2": list(entry.gravity),
                "held": entry.held,
                "outcome": entry.outcome,
                "slip_m": entry.slip,
                "turn_rad": entry.rotation,
            }
            for entry in directions
        ],
        "reason": None if hold is None else hold.reason or failed,
        "squeeze_N": None if squeeze is None else max(squeeze.normal_forces, default=None),
        "load_factor": None if squeeze is None else squeeze.load_factor,
    }


def _proofs(grasp: GraspRecord) -> dict[str, Any]:
    evidence = grasp.evidence
    stable, clear = (None, None) if evidence is None else (evidence.stable, evidence.clear)
    return {
        "slack_N": None if stable is None else stable.slack,
        "proved_clear": None if evidence is None else clear is not None,
        "proved_approach": None if evidence is None else clear is not None and clear.approach,
    }
