"""Configurations of a run made grasps and put to the test, and what follows once all have their verdicts."""

import time
from collections.abc import Callable

from ...errors import InputError
from ...grasping import Refusal, Trial
from ...mjcf import HoldSettings
from ...objects import Task
from ...solver import Configuration
from ..records import (
    GraspFile,
    GraspRecord,
    RunRecord,
    file_head,
    read_grasp,
    to_approach,
    to_state,
)
from ..report import Drawn, describe, describe_extras
from .attempts import Attempt
from .choosing import tests_in_order, with_tested
from .extras import FindExtras, HandedOn, strains_of
from .ranking import in_order, with_grasp
from .recorded_grasp import to_grasp
from .stages import (
    lost_grasp,
    with_clearing,
    with_evidence,
    with_extras,
    with_limit,
    with_quality,
    with_trial,
    without_squeeze,
)
from .under_way import RunUnderWay, save, save_in_time, timed

__all__ = ["find_extras", "make_and_hold"]

_MAKING = "strengthening, retracting and holding"


def make_and_hold(run: RunUnderWay, record: RunRecord, *, at_end: Callable[[], bool]) -> RunRecord:
    """Makes a grasp of what has not been tried yet and puts it to the test, best first after each.

    Where enough of them hold, the others are left as the solver has found them.

    Args:
        run: whose grasps they are.
        record: of the run.
        at_end: does a piece of other work once a process has none; False where none is left.
    """
    if record.has_enough:
        return record
    task, folder = run.task, run.folder
    started = time.monotonic()
    record, tests = tests_in_order(run, in_order(record))
    pending, jobs = [grasp for grasp, _ in tests], [job for _, job in tests]
    count = run.console.count(_MAKING, len(jobs))
    was_stopped = count.watching(run.should_stop)
    attempts = run.crew.results(
        jobs,
        is_over=lambda: run.remaining_s <= 0.0,
        should_stop=lambda: was_stopped() or run.gives_up(record),
        at_end=at_end,
    )
    # Where the run ends early there are fewer attempts than grasps.
    for found, attempt in zip(pending, attempts, strict=False):
        grasp = _after_attempt(found, attempt, task, run.hold)
        folder.save_grasp(_grasp_file(run, grasp), attempt.mjcf)
        run.console.say(f"  {describe(grasp)}")
        count.step()
        record = with_tested(with_grasp(record, grasp), grasp.id)
        _remember(run, grasp, attempt, record.grasps)
        record = save_in_time(run, timed(record, "grasps", time.monotonic() - started))
        started = time.monotonic()
        if record.has_enough:
            break
    if record.choosing is not None and record.choosing.order:
        run.console.say(f"  {record.choosing.words}")
    return save(run, record) if pending else record


def find_extras(run: RunUnderWay, record: RunRecord, *, meanwhile: Callable[[], bool]) -> RunRecord:
    """Measures of the grasps, and margin and agreement of those that held, once every one has its verdict.

    Args:
        run: whose grasps they are.
        record: of the run, its grasps in their order.
        meanwhile: does a piece of other work while this process waits for others; False where none is left.
    """
    pending = [grasp for grasp in record.grasps if grasp.lacks_extras]
    jobs = [_extras_job(run, grasp) for grasp in pending]
    started = time.monotonic()
    count = run.console.count("measuring margins, forces and other settings", len(jobs))
    results = run.crew.results(
        jobs,
        is_over=lambda: run.remaining_s <= 0.0,
        should_stop=count.watching(run.should_stop),
        meanwhile=meanwhile,
    )
    for tested, found in zip(pending, results, strict=False):
        grasp = with_evidence(with_quality(tested, found.quality), found.evidence)
        if found.extras is not None:
            grasp = with_extras(grasp, found.extras)
            run.console.say(f"  {describe_extras(grasp)}")
        count.step()
        run.folder.save_grasp(_grasp_file(run, _with_kept_motion(run, grasp)))
        record = save_in_time(run, timed(with_grasp(record, grasp), "extras", time.monotonic() - started))
        started = time.monotonic()
    return save(run, record) if pending else record


def _extras_job(run: RunUnderWay, grasp: GraspRecord) -> FindExtras:
    """The job for a grasp that has its verdict, the same whether the run goes on or is resumed."""
    source = run.folder.record_path
    approach = None if grasp.approach is None else to_approach(grasp.approach, run.task.hand, source)
    return FindExtras(
        Configuration(run.task, to_state(grasp, run.task, source), grasp.residual, None),
        approach,
        to_grasp(grasp, run.task, run.hold, source),
        grasp.is_held,
        None if grasp.hold is None else strains_of(grasp.hold, run.hold),
        run.handed.pop(grasp.id, HandedOn()),
    )


def _grasp_file(run: RunUnderWay, grasp: GraspRecord) -> GraspFile:
    head = file_head(run.task, run.reference, run.folder.grasp_path(grasp.id))
    return GraspFile.model_validate({**dict(grasp), **head})


def _with_kept_motion(run: RunUnderWay, grasp: GraspRecord) -> GraspRecord:
    """The grasp with the motion that its own file has, where the record has it no more."""
    if grasp.hold is None or grasp.has_motion:
        return grasp
    try:
        return grasp.with_motion_of(read_grasp(run.folder.grasp_path(grasp.id)))
    except InputError:  # of a run that did not keep it, or a file that is gone
        return grasp


def _after_attempt(grasp: GraspRecord, attempt: Attempt, task: Task, hold: HoldSettings) -> GraspRecord:
    """The record of a grasp with what became of it."""
    match attempt.outcome:
        case Trial() as trial:
            clearing = trial.grasp.clearing
            grasp = with_trial(grasp if clearing is None else with_clearing(grasp, clearing), trial)
            return with_limit(grasp, attempt.limit)
        case Refusal() as refusal:
            if refusal.clearing is not None:
                grasp = with_clearing(grasp, refusal.clearing)
            if not grasp.is_clear:
                return grasp
            return with_limit(without_squeeze(grasp, refusal, hold), attempt.limit)
        case None:
            return lost_grasp(grasp, task, hold)


def _remember(run: RunUnderWay, grasp: GraspRecord, attempt: Attempt, grasps: list[GraspRecord]) -> None:
    """Keeps what pictures of the grasp show; recorded motion, which takes room, for the best grasp alone."""
    match attempt.outcome:
        case Trial() as trial:
            run.drawn[grasp.id] = Drawn(trial.grasp.configuration, trial)
            if trial.held and not run.settings.quick:
                run.handed[grasp.id] = HandedOn.by(trial.result)
        case Refusal() as refusal:
            run.drawn[grasp.id] = Drawn(refusal.configuration)
        case None:
            return
    best = next(other.id for other in grasps if other.is_done)
    for name, drawn in run.drawn.items():
        if name != best and drawn.trial is not None:
            run.drawn[name] = Drawn(drawn.configuration)
