"""The verdict on a grasp file."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..reading import Rejected
from .clear import check_clear
from .exists import check_existence
from .form import Form, Written, field
from .places import contacts_of, frames_of, turn_of_quaternion
from .seal import check_seal
from .spans import Spans
from .stable import check_stable

__all__ = ["GraspCheck", "check_grasp"]


@dataclass(frozen=True)
class GraspCheck:
    """What came of checking what a grasp file says was proved.

    Attributes:
        accepted: whether all of it was shown, and there is something.
        slack_N: what every contact may lose before it slips; None where the file does not say that the load
            is balanced, or that was not shown.
        clear: whether nothing sinks in deeper than it may; None where the file does not say so.
        approach: the same on the way from the pregrasp.
        reason: why something was not shown; empty where all was.
    """

    accepted: bool
    slack_N: float | None = None
    clear: bool | None = None
    approach: bool | None = None
    reason: str = ""


def check_grasp(record: dict[str, Any], form: dict[str, Any], *, sealed: bool = True) -> GraspCheck:
    """Checks what a grasp file says was proved: that its contacts truly hold nearby, balance, and clearance.

    Args:
        record: the file as it is parsed; nothing in it is taken on trust but what the statements are about,
            the settings of the hold test and the contacts' arms of spin.
        form: the task as plain data, of `holdfast.evidence.grasp_form`, which the caller vouches for.
        sealed: whether the file's checksum must be right, too; it proves nothing, but shows any change.
    """
    slack: float | None = None
    clear: bool | None = None
    approach: bool | None = None
    try:
        with np.errstate(all="ignore"):
            task = Form.read(form)
            evidence = field(record, "evidence", dict)
            if evidence.get("stable") is None and evidence.get("clear") is None:
                raise Rejected("the file does not say that anything was proved")
            if sealed:
                check_seal(record)
            written = Written.read(task, record)
            check_existence(task, written)
            R, p = _object(written)
            if evidence.get("stable") is not None:
                frames = frames_of(task, _joints(written))
                params = Spans.around(written.params, written.radii[3])
                contacts = contacts_of(task, frames, R, p, params)
                slack = check_stable(task, record, frames, (R, p), params, contacts)
            if evidence.get("clear") is not None:
                clear, approach = False, False
                approach = check_clear(task, written, record, R, p)
                clear = True
    except Rejected as reason:
        return GraspCheck(False, slack, clear, approach, str(reason))
    return GraspCheck(True, slack, clear, approach)


def _joints(written: Written) -> list[Spans]:
    q = Spans.around(written.q, written.radii[0])
    return [q[k] for k in range(len(written.q))]


def _object(written: Written) -> tuple[Spans, Spans]:
    """Rotation and position over all places that the solution may have."""
    R, radius = turn_of_quaternion(Spans.of(written.quaternion)), written.radii[1]
    wide = Spans(np.full((3, 3), -radius), np.full((3, 3), radius))
    return R + wide, Spans.around(written.position, written.radii[2])
