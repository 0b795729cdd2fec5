"""A row tried again: its proof of existence, its clearance, what was proved beside, and its hold test."""

from collections.abc import Iterator
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from ...base.machine.backend import configure
from ...base.text.significant import significant
from ...check_proof import check_grasp
from ...errors import InputError, UnknownName
from ...evidence import grasp_form
from ...mjcf import HoldResult, HoldSettings, hold_test
from ...objects import Task, load_task
from ...retraction import RetractionSettings, compute_clearance
from ..records import Direction, GraspRecord, Hold, existing_source, fingerprint, to_configuration, to_json
from ..records import to_state as recorded_state
from ..run import to_grasp
from .row import Row

__all__ = ["Finding", "Replay", "replay_row"]

# The same versions give the same bits; another version of a library may round in another way.
_SAME_M = 1e-6
_SAME_SLIP_M, _SAME_RAD = 1e-5, 1e-4


@dataclass(frozen=True)
class Finding:
    """One thing that was looked at again.

    Attributes:
        what: it is.
        written: what the row says.
        now: what was found.
        agrees: whether these are the same.
    """

    what: str
    written: str
    now: str
    agrees: bool


@dataclass(frozen=True)
class Replay:
    """What came of a row that was tried again.

    Attributes:
        row: the row.
        findings: in the order of the stages; where the task is another now, nothing behind that.
    """

    row: Row
    findings: tuple[Finding, ...]

    @property
    def agrees(self) -> bool:
        """Whether all is as the row says."""
        return all(finding.agrees for finding in self.findings)


def replay_row(row: Row, table: Path, task: str | None = None) -> Replay:
    """Tries a row again.

    Args:
        row: of a table.
        table: the file that it stands in, from whose folder its task is named.
        task: what loads its task, in place of what the row names.

    Raises:
        InputError: its task can't be loaded, or the row is none of it.
    """
    configure()
    loaded = load_task(task or existing_source(row.head.task_source, table))
    findings = tuple(_models(row, loaded))
    if all(finding.agrees for finding in findings):
        source = f"{table}: row {row.number}"
        findings += tuple(_stages(row.grasp, loaded, source))
    return Replay(row, findings)


def _models(row: Row, task: Task) -> Iterator[Finding]:
    """Whether hand, object and task are those that the row was made with."""
    head = row.head
    pairs = (
        ("hand", head.hand_hash, task.hand),
        ("object", head.object_hash, task.object),
        ("task", head.task_hash, task),
    )
    for what, written, model in pairs:
        if written:  # runs of earlier versions have no hashes of hand and object
            now = fingerprint(model)
            yield Finding(f"{what} {model.name}", written, now, written == now)


def _stages(grasp: GraspRecord, task: Task, source: str) -> Iterator[Finding]:
    state = recorded_state(grasp, task, source)
    configuration = to_configuration(grasp, task, source)
    yield _truth("certified", grasp.certified, configuration.certified)
    if grasp.clearance is not None:
        settings = RetractionSettings(margin_m=grasp.clearance.margin)
        found = compute_clearance(task, state, settings=settings)
        yield _truth("clear", grasp.is_clear, found.is_clear)
        if grasp.is_clear:
            written, now = grasp.clearance.after, found.least_m
            yield Finding("clearance/mm", _mm(written), _mm(now), abs(written - now) <= _SAME_M)
    if grasp.evidence is not None and (grasp.evidence.stable or grasp.evidence.clear):
        check = check_grasp(to_json(grasp), grasp_form(task))
        yield Finding("proofs", "accepted", check.reason or "accepted", check.accepted)
    if grasp.hold is not None and grasp.hold.directions:
        yield from _test(grasp, grasp.hold, task, source)


def _test(grasp: GraspRecord, hold: Hold, task: Task, source: str) -> Iterator[Finding]:
    settings = _settings(hold.settings, source)
    simulated = to_grasp(grasp, task, settings, source)
    if simulated is None:
        raise InputError(source, "hold.squeeze", "is not whole: the test can't be repeated")
    result = hold_test(simulated)
    yield _truth("held", hold.held, result.held)
    yield from _directions(hold.directions, result)


def _directions(written: list[Direction], result: HoldResult) -> Iterator[Finding]:
    if len(written) != len(result.directions):
        yield Finding("directions", str(len(written)), str(len(result.directions)), False)
        return
    for k, (before, now) in enumerate(zip(written, result.directions, strict=True), start=1):
        said = f"{before.outcome}, {_mm(before.slip)} mm"
        agrees = before.outcome == now.outcome.value
        if before.held and now.held and before.slip is not None and before.rotation is not None:
            agrees &= abs(before.slip - now.slip_m) <= _SAME_SLIP_M
            agrees &= abs(before.rotation - now.rotation_rad) <= _SAME_RAD
        yield Finding(f"direction {k}", said, f"{now.outcome.value}, {_mm(now.slip_m)} mm", agrees)


def _settings(written: dict[str, Any], source: str) -> HoldSettings:
    """The settings of a test as its record has them.

    Raises:
        InputError: one that the hold test does not have, or that is none.
    """
    known = tuple(entry.name for entry in fields(HoldSettings))
    for name in written:
        if name not in known:
            raise UnknownName(source, "hold.settings", "setting of the hold test", name, known)
    values: dict[str, Any] = {name: _as_tuple(value) for name, value in written.items()}
    return HoldSettings(**values)


def _as_tuple(value: Any) -> Any:
    return tuple(_as_tuple(entry) for entry in value) if isinstance(value, (list, tuple)) else value


def _truth(what: str, written: bool, now: bool) -> Finding:
    return Finding(what, "yes" if written else "no", "yes" if now else "no", written == now)


def _mm(metres: float | None) -> str:
    return "-" if metres is None else significant(1e3 * metres, 6)
