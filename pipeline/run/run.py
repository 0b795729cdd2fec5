"""The whole chain: load, solve, make grasps, hold, report."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from ... import __version__
from ...backend import configure
from ...console import Console
from ...grasping import Refusal, Starts, Trial, solve_for_starts
from ...mjcf import HoldSettings
from ...objects import Task, load_task
from ...solver import Configuration, pad_misfits
from ...solver.contacts import DistinctStates, spread
from ...work_clock import WorkClock
from ..records import (
    GraspFile,
    GraspRecord,
    Round,
    RunFolder,
    RunRecord,
    Solve,
    builtin_reference,
    file_head,
    fingerprint,
    relative_source,
    to_approach,
    to_state,
)
from ..report import Drawn, describe, describe_extras, draw_grasps, write_report
from .attempts import Attempt, TryState
from .begin import begin, own_folder
from .carrying import find_carrying
from .crew import Crew, CrewSetup
from .extras import FindExtras, strains_of
from .ranking import number, rank
from .recorded_grasp import to_grasp
from .restore import missing_pages, restore_grasps
from .settings import RunSettings
from .stages import (
    lost_grasp,
    new_grasp,
    with_clearing,
    with_evidence,
    with_extras,
    with_limit,
    with_quality,
    with_trial,
    without_squeeze,
)
from .statics import refuted_by_statics

__all__ = ["choose_folder", "run_task"]

# The solver is asked again, with other seeds, while too few of its configurations survive.
_MOST_ROUNDS = 4
# Configurations nearer to each other than this, by the solver's distance, make the same grasp.
_SAME = 0.02


def _never() -> bool:
    return False


@dataclass(frozen=True, eq=False)
class _Run:
    """What a run is made with.

    Attributes:
        task: the task.
        reference: name or path by which it can be loaded again; empty where it was built in Python.
        folder: the run folder.
        settings: what is asked for.
        console: where progress goes.
        should_stop: whether to end early.
        clock: started with the run.
        hold: settings of the hold test.
        crew: does what can be shared.
        drawn: what pictures show, by id, of the grasps that were made since this process took the run up.
    """

    task: Task
    reference: str
    folder: RunFolder
    settings: RunSettings
    console: Console
    should_stop: Callable[[], bool]
    clock: WorkClock
    hold: HoldSettings
    crew: Crew
    drawn: dict[str, Drawn] = field(default_factory=dict)

    @property
    def remaining_s(self) -> float:
        """Time left in the budget."""
        return self.settings.budget_s - self.clock.seconds

    @property
    def is_over(self) -> bool:
        """Whether nothing new should be begun."""
        return self.should_stop() or self.remaining_s <= 0.0


def run_task(
    task: Task | str | Path,
    path: Path,
    settings: RunSettings | None = None,
    *,
    resume: bool = False,
    force: bool = False,
    console: Console | None = None,
    should_stop: Callable[[], bool] = _never,
) -> RunRecord:
    """Runs every stage on a task and writes a run folder.

    Every grasp is written as soon as it is finished. `should_stop` is looked at between steps; where it says
    so, the run ends early, its record not `complete`, with a report of what there is.

    Args:
        task: a task, the name of a built-in one, or the path of a task file. Files of a run whose task was
            built in Python name no task: commands that take them up need it by `--task`.
        path: the run folder.
        settings: what is asked for; None takes the defaults, as the command line does.
        resume: continue what an earlier run with the same task and settings left in the folder.
        force: replace the run that lies there, also one with another task, seed or settings.
        console: where progress goes; None keeps quiet.
        should_stop: whether to end early.

    Returns:
        What `run.json` says.

    Raises:
        InputError: a task or a folder that can't be used.
    """
    configure()  # chooses the renderer, before a stage imports MuJoCo
    settings = settings or RunSettings()
    loaded = task if isinstance(task, Task) else load_task(task)
    hold = settings.hold_settings(loaded)
    run = _Run(
        task=loaded,
        reference=builtin_reference(task) if isinstance(task, Task) else str(task),
        folder=RunFolder(path),
        settings=settings,
        console=console or Console(quiet=True),
        should_stop=should_stop,
        clock=WorkClock(),
        hold=hold,
        crew=Crew(CrewSetup(loaded, hold, settings.retraction), settings.workers),
    )
    with run.folder.writing(), run.crew:
        record = _begin(run, resume=resume, force=force)
        lacks_pages = resume and _restore(run, record)
        if record.complete:
            return _finish(run, record) if lacks_pages else record
        record = _make_and_hold(run, record)
        while _wants_more(run, record):
            record = _ask_solver(run, record)
            record = _make_and_hold(run, record)
        return _finish(run, record if settings.quick else _find_extras(run, record))


def choose_folder(task: Task, base: Path, settings: RunSettings) -> Path:
    """The run folder where the user names none: `base`, or with a number where another run lies there."""
    return own_folder(base, _fresh(task, "", base, settings))


def _fresh(task: Task, reference: str, record_path: Path, settings: RunSettings) -> RunRecord:
    """The record of a run that has done nothing yet."""
    return RunRecord(
        holdfast=__version__,
        task=task.name,
        task_source=relative_source(reference, record_path),
        task_fingerprint=fingerprint(task),
        hand=task.hand.name,
        object=task.object.name,
        seed=settings.seed,
        settings=settings.as_record(task),
    )


def _begin(run: _Run, *, resume: bool, force: bool) -> RunRecord:
    """The record to start from: empty, or what an earlier run left."""
    fresh = _fresh(run.task, run.reference, run.folder.record_path, run.settings)
    record = begin(fresh, run.folder, resume=resume, force=force)
    if record.quick and not run.settings.quick:  # more is asked for now
        record = record.model_copy(update={"quick": False, "complete": False})
    if record is not fresh:
        done = sum(grasp.is_done for grasp in record.grasps)
        run.console.say(f"resuming: {done} of {len(record.grasps)} grasps are done")
    return _with_carrying(run, record) if record.solve is None else record


def _with_carrying(run: _Run, record: RunRecord) -> RunRecord:
    """The record with what the contacts can carry, which is said where it is too little."""
    found = find_carrying(run.task, run.hold)
    if found is not None and found.limit is not None:
        run.console.say(found.text)
    return _save(run, record.model_copy(update={"carrying": found}))


def _restore(run: _Run, record: RunRecord) -> bool:
    """Makes again what is missing of finished grasps; whether a whole run lacks pictures or its report."""
    made = restore_grasps(run.task, record, run.folder, run.hold, run.reference)
    pages = missing_pages(record, run.folder) if record.complete else []
    if made or pages:
        run.console.say(f"making anew what is missing: {', '.join(path.name for path in [*made, *pages])}")
    return bool(pages)


def _wants_more(run: _Run, record: RunRecord) -> bool:
    """Whether the solver should be asked (again)."""
    if run.is_over:
        return False
    if record.solve is None:
        return True
    rounds = record.solve.rounds
    lacks = len(record.good) < run.settings.wanted or (run.settings.wanted > 0 and not record.firm)
    return lacks and len(rounds) < _MOST_ROUNDS and rounds[-1].found > 0


def _ask_solver(run: _Run, record: RunRecord) -> RunRecord:
    """A round of the solver: the record with what is new in it."""
    settings, console = run.settings, run.console
    rounds = record.solve.rounds if record.solve else []
    # Rounds far apart, so that runs with neighbouring seeds do not share any.
    seed = settings.seed + 1_000_000 * len(rounds)
    console.say(f"solving {record.task}" + (f", round {len(rounds) + 1}" if rounds else ""))
    started = time.monotonic()
    starts = _look(run, seed, is_first=not rounds)
    result = starts.result
    grasps, tried = _with_new(run, record.grasps, starts.configurations)
    entry = Round(
        seed=seed,
        verdict=result.verdict.value,
        seconds=result.seconds,
        boxes=result.boxes,
        lps=result.lps,
        solved=len(result),
        found=len(tried),
        whole=not run.should_stop(),
        spread=spread(tried),
        reason="friction" if result.lacks_friction else None,
    )
    console.say(
        f"  {entry.verdict}: {entry.solved} solved, {entry.found} of them to be tried; {entry.boxes} boxes, "
        f"{entry.lps} LPs, {entry.seconds:.1f} s"
    )
    for misfit in pad_misfits(run.task) if entry.verdict == "infeasible" and not entry.reason else ():
        console.say(f"  {misfit}")
    record = _timed(record, "solve", time.monotonic() - started)
    return _save(
        run,
        record.model_copy(update={"solve": Solve.of([*rounds, entry], settings.sigma), "grasps": grasps}),
    )


def _look(run: _Run, seed: int, *, is_first: bool) -> Starts:
    """Configurations to begin at; at first, whether the regions can hold the load at all."""
    settings, console = run.settings, run.console
    if is_first:
        refuted = refuted_by_statics(run.task, settings, run.hold, should_stop=run.should_stop)
        if refuted is not None:
            console.say(f"  {refuted.statics}")
            return Starts(refuted, ())
    return solve_for_starts(
        run.task,
        count=settings.candidates,
        choice=settings.choice,
        settings=run.hold,
        seed=seed,
        sigma=settings.sigma,
        budget_s=max(1.0, run.remaining_s),
        on_progress=lambda p: console.pass_by(
            f"  {p.found} found, {p.boxes} boxes done, {p.open} open, {p.seconds:.0f} s"
        ),
        should_stop=run.should_stop,
    )


def _with_new(
    run: _Run, grasps: list[GraspRecord], starts: Sequence[Configuration]
) -> tuple[list[GraspRecord], list[Configuration]]:
    """The grasps, and behind them the first of the configurations that are none of them; and these."""
    found = list(grasps)
    tried: list[Configuration] = []
    known = DistinctStates(_SAME)
    for grasp in grasps:
        known.keep(to_state(grasp, run.task, run.folder.record_path))
    for configuration in starts:
        if len(tried) < run.settings.candidates and known.add(configuration.state):
            found.append(new_grasp(configuration, f"g{len(found) + 1:02d}"))
            tried.append(configuration)
    return found, tried


def _make_and_hold(run: _Run, record: RunRecord) -> RunRecord:
    """Makes a grasp of what has not been tried yet and puts it to the test, best first after each."""
    task, folder = run.task, run.folder
    pending = sorted((grasp for grasp in record.grasps if not grasp.is_done), key=number)
    jobs = [TryState(to_state(grasp, task, folder.record_path)) for grasp in pending]
    started = time.monotonic()
    attempts = run.crew.results(jobs, is_over=lambda: run.remaining_s <= 0.0, should_stop=run.should_stop)
    # Where the run ends early there are fewer attempts than grasps.
    for found, attempt in zip(pending, attempts, strict=False):
        grasp = _after_attempt(found, attempt, task, run.hold)
        folder.save_grasp(_grasp_file(run, grasp), attempt.mjcf)
        run.console.say(f"  {describe(grasp)}")
        record = _with_grasp(record, grasp)
        _remember(run, grasp, attempt, record.grasps)
        record = _save(run, _timed(record, "grasps", time.monotonic() - started))
        started = time.monotonic()
    return record


def _find_extras(run: _Run, record: RunRecord) -> RunRecord:
    """Measures of the grasps, and margin and agreement of those that held, once every one has its verdict."""
    pending = [grasp for grasp in record.grasps if grasp.lacks_extras]
    jobs = [_extras_job(run, grasp) for grasp in pending]
    started = time.monotonic()
    results = run.crew.results(jobs, is_over=lambda: run.remaining_s <= 0.0, should_stop=run.should_stop)
    for tested, found in zip(pending, results, strict=False):
        grasp = with_evidence(with_quality(tested, found.quality), found.evidence)
        if found.extras is not None:
            grasp = with_extras(grasp, found.extras)
            run.console.say(f"  {describe_extras(grasp)}")
        run.folder.save_grasp(_grasp_file(run, grasp))
        record = _save(run, _timed(_with_grasp(record, grasp), "extras", time.monotonic() - started))
        started = time.monotonic()
    return record


def _extras_job(run: _Run, grasp: GraspRecord) -> FindExtras:
    """The job for a grasp that has its verdict, the same whether the run goes on or is resumed."""
    source = run.folder.record_path
    approach = None if grasp.approach is None else to_approach(grasp.approach, run.task.hand, source)
    return FindExtras(
        Configuration(run.task, to_state(grasp, run.task, source), grasp.residual, None),
        approach,
        to_grasp(grasp, run.task, run.hold, source),
        grasp.is_held,
        None if grasp.hold is None else strains_of(grasp.hold, run.hold),
    )


def _grasp_file(run: _Run, grasp: GraspRecord) -> GraspFile:
    head = file_head(run.task, run.reference, run.folder.grasp_path(grasp.id))
    return GraspFile.model_validate({**dict(grasp), **head})


def _with_grasp(record: RunRecord, grasp: GraspRecord) -> RunRecord:
    """The record with a grasp in place of that of the same name, the best first."""
    grasps = sorted((grasp if other.id == grasp.id else other for other in record.grasps), key=rank)
    return record.model_copy(update={"grasps": grasps})


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


def _remember(run: _Run, grasp: GraspRecord, attempt: Attempt, grasps: list[GraspRecord]) -> None:
    """Keeps what pictures of the grasp show; recorded motion, which takes room, for the best grasp alone."""
    match attempt.outcome:
        case Trial() as trial:
            run.drawn[grasp.id] = Drawn(trial.grasp.configuration, trial)
        case Refusal() as refusal:
            run.drawn[grasp.id] = Drawn(refusal.configuration)
        case None:
            return
    best = next(other.id for other in grasps if other.is_done)
    for name, drawn in run.drawn.items():
        if name != best and drawn.trial is not None:
            run.drawn[name] = Drawn(drawn.configuration)


def _finish(run: _Run, record: RunRecord) -> RunRecord:
    """Pictures and the report; the run is complete unless it was stopped."""
    quick = run.settings.quick
    if not quick and not run.should_stop():
        started = time.monotonic()
        run.console.say("drawing")
        draw_grasps(run.task, record, run.folder, run.hold, run.drawn, should_stop=run.should_stop)
        record = _timed(record, "pictures", time.monotonic() - started)
    whole = record.solve is not None and all(grasp.is_done for grasp in record.grasps)
    whole = whole and (quick or not any(grasp.lacks_extras for grasp in record.grasps))
    record = record.model_copy(update={"quick": quick, "complete": whole and not run.should_stop()})
    _say_what_is_left(run, record)
    write_report(run.task, record, run.folder)
    return _save(run, record)


def _say_what_is_left(run: _Run, record: RunRecord) -> None:
    untried = [grasp.id for grasp in record.grasps if not grasp.is_done]
    if untried:
        run.console.say(f"not tried, as the run ended before: {', '.join(untried)}")
    why = "quick" if record.quick else "the run ended before"
    lacking = [grasp for grasp in record.grasps if grasp.lacks_extras]
    unmeasured = [grasp.id for grasp in lacking if grasp.is_held]
    if unmeasured:
        run.console.say(f"without margin and other settings ({why}): {', '.join(unmeasured)}")
    if len(lacking) > len(unmeasured):
        others = ", ".join(grasp.id for grasp in lacking if not grasp.is_held)
        run.console.say(f"without analytic measures ({why}): {others}")


def _verdict(record: RunRecord) -> Literal["held", "not held", "infeasible", "undecided"]:
    if record.good:
        return "held"
    if record.solve is None or record.solve.verdict == "undecided":
        return "undecided"
    if record.solve.verdict == "infeasible":
        return "infeasible"
    return "not held" if all(grasp.is_done for grasp in record.grasps) else "undecided"


def _save(run: _Run, record: RunRecord) -> RunRecord:
    narrow = bool(record.good) and not record.firm
    record = record.model_copy(update={"verdict": _verdict(record), "narrow": narrow})
    run.folder.save(record)
    return record


def _timed(record: RunRecord, stage: str, seconds: float) -> RunRecord:
    spent = {**record.seconds, stage: record.seconds.get(stage, 0.0) + seconds}
    return record.model_copy(update={"seconds": spent})
