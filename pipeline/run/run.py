"""The whole chain: load, solve, make grasps, hold, report."""

import time
from collections.abc import Callable
from pathlib import Path

from ... import __version__
from ...base.files.output_file import write_text
from ...base.machine.backend import configure
from ...base.machine.work_clock import WorkClock
from ...base.text.console import Console
from ...objects import Task, load_task
from ..records import (
    RunFolder,
    RunRecord,
    builtin_reference,
    fingerprint,
    relative_source,
)
from ..report import Drawing, EarlierSet, readme, write_earlier, write_report
from .begin import begin, own_folder
from .carrying import find_carrying, with_others
from .crew import Crew, CrewSetup
from .explaining import explained
from .made import made_here
from .ranking import in_order
from .restore import missing_pages, restore_grasps
from .rounds import ask_solver, wants_more
from .settings import RunSettings
from .trying import find_extras, make_and_hold
from .under_way import RunUnderWay, save, timed

__all__ = ["choose_folder", "run_task"]


def _never() -> bool:
    return False


def run_task(
    task: Task | str | Path,
    path: Path,
    settings: RunSettings | None = None,
    *,
    resume: bool = False,
    force: bool = False,
    earlier: tuple[EarlierSet, ...] = (),
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
        earlier: other contacts that were run before and did not hold, for the report.
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
    if settings.chooser is not None:
        settings.chooser.check(loaded)
    run = RunUnderWay(
        task=loaded,
        reference=builtin_reference(task) if isinstance(task, Task) else str(task),
        folder=RunFolder(path),
        settings=settings,
        console=console or Console(quiet=True),
        should_stop=should_stop,
        clock=WorkClock(),
        hold=hold,
        crew=Crew(CrewSetup(loaded, hold, settings.retraction), settings.workers),
        earlier=earlier,
    )
    with run.folder.writing(), run.crew:
        record = _begin(run, resume=resume, force=force)
        lacks_pages = resume and _restore(run, record)
        if record.complete:
            return _remake_pages(run, record) if lacks_pages else record
        with _drawing(run) as drawing:
            at_end = _nothing if settings.quick else drawing.get_ready
            record = make_and_hold(run, record, at_end=at_end)
            while wants_more(run, record):
                record = ask_solver(run, record)
                record = make_and_hold(run, record, at_end=at_end)
            if settings.quick or run.gives_up(record):
                if not settings.quick and not run.should_stop():
                    drawing.first(record)
                return _finish(run, record)
            record = in_order(record)
            drawing.begin(record)
            return _finish(run, find_extras(run, record, meanwhile=drawing.step), drawing)


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
        hand_fingerprint=fingerprint(task.hand),
        object_fingerprint=fingerprint(task.object),
        seed=settings.seed,
        settings=settings.as_record(task),
        made=made_here(settings),
    )


def _begin(run: RunUnderWay, *, resume: bool, force: bool) -> RunRecord:
    """The record to start from: empty, or what an earlier run left."""
    fresh = _fresh(run.task, run.reference, run.folder.record_path, run.settings)
    record = begin(fresh, run.folder, resume=resume, force=force)
    is_resumed = record is not fresh
    if record.quick and not run.settings.quick:  # more is asked for now
        record = record.model_copy(update={"quick": False, "complete": False})
    record = _with_enough(record, run.settings)
    if is_resumed:
        done = sum(grasp.is_done for grasp in record.grasps)
        run.console.say(f"resuming: {done} of {len(record.grasps)} grasps are done")
    return _with_carrying(run, record) if record.solve is None else record


def _with_enough(record: RunRecord, settings: RunSettings) -> RunRecord:
    """The record with how many grasps are enough now: a run that was whole may have some to test again."""
    is_whole = record.complete and (settings.enough is not None or not record.left_untested)
    return record if is_whole else record.model_copy(update={"enough": settings.enough, "complete": False})


def _with_carrying(run: RunUnderWay, record: RunRecord) -> RunRecord:
    """The record with what the contacts can carry, which is said where it is too little."""
    found = find_carrying(run.task, run.hold)
    if found is not None and found.limit is not None:
        run.console.say(found.text)
    return save(run, record.model_copy(update={"carrying": found}))


def _with_others(run: RunUnderWay, record: RunRecord) -> RunRecord:
    """The record with other contacts, where these seemed to carry the load and no grasp's plan does."""
    found = record.carrying
    if found is None or found.limit is not None or record.limit is None:
        return record
    return record.model_copy(update={"carrying": with_others(run.task, run.hold, found)})


def _restore(run: RunUnderWay, record: RunRecord) -> bool:
    """Makes again what is missing of finished grasps; whether a whole run lacks pictures or its report."""
    made = restore_grasps(run.task, record, run.folder, run.hold, run.reference)
    pages = missing_pages(record, run.folder) if record.complete else []
    if made or pages:
        run.console.say(f"making anew what is missing: {', '.join(path.name for path in [*made, *pages])}")
    return bool(pages)


def _nothing() -> bool:
    return False


def _drawing(run: RunUnderWay) -> Drawing:
    return Drawing(
        run.task,
        run.folder,
        run.hold,
        run.drawn,
        console=run.console,
        should_stop=run.should_stop,
    )


def _remake_pages(run: RunUnderWay, record: RunRecord) -> RunRecord:
    """Pictures and report of a run that is whole."""
    if record.quick:
        return _finish(run, record)
    with _drawing(run) as drawing:
        drawing.begin(record)
        return _finish(run, record, drawing)


def _finish(run: RunUnderWay, record: RunRecord, drawing: Drawing | None = None) -> RunRecord:
    """Pictures and the report; the run is complete unless it was stopped, or given up.

    Args:
        run: that comes to its end.
        record: of the run.
        drawing: its pictures; None for verdicts alone.
    """
    if drawing is not None and not run.should_stop():
        started = time.monotonic()
        if record.verdict == "infeasible":
            record = explained(run, record)
            record = timed(record, "explain", time.monotonic() - started)
        started = time.monotonic()
        drawing.finish()
        record = timed(record, "pictures", time.monotonic() - started)
    quick = drawing is None
    whole = record.solve is not None
    whole = whole and (record.has_enough or all(grasp.is_done for grasp in record.grasps))
    whole = whole and (quick or not any(grasp.lacks_extras for grasp in record.grasps))
    record = _with_others(run, record)
    record = record.model_copy(update={"quick": quick, "complete": whole and not run.should_stop()})
    _say_what_is_left(run, record)
    if run.earlier:
        write_earlier(run.folder.media, run.earlier)
    write_report(run.task, record, run.folder)
    write_text(run.folder.readme_path, readme(run.task, record))
    return save(run, record)


def _say_what_is_left(run: RunUnderWay, record: RunRecord) -> None:
    untried = [grasp.id for grasp in record.grasps if not grasp.is_done]
    if untried:
        reason = "enough hold" if record.has_enough else "the run ended before"
        run.console.say(f"not tried, as {reason}: {', '.join(untried)}")
    why = "quick" if run.settings.quick else "the run ended before"
    lacking = [grasp for grasp in record.grasps if grasp.lacks_extras]
    unmeasured = [grasp.id for grasp in lacking if grasp.is_held]
    if unmeasured:
        run.console.say(f"without margin and other settings ({why}): {', '.join(unmeasured)}")
    if len(lacking) > len(unmeasured):
        others = ", ".join(grasp.id for grasp in lacking if not grasp.is_held)
        run.console.say(f"without analytic measures ({why}): {others}")
