"""The whole chain: load, solve, retract, squeeze, hold, report."""

import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np

from ... import __version__
from ...errors import InputError
from ...mjcf import HoldSettings, preset_settings
from ...objects import Task, load_task
from ...retraction import RetractionSettings
from ...solver import solve
from ..backend import configure
from ..output import Console
from ..records import (
    GraspFile,
    GraspRecord,
    Round,
    RunFolder,
    RunRecord,
    Setting,
    Solution,
    Solve,
    file_head,
    fingerprint,
    relative_source,
    to_solution,
)
from ..report import describe, draw_grasps, write_report
from .grasp_workers import GraspJob, try_grasps

__all__ = ["RunSettings", "run_task"]

# The solver is asked again, with other seeds, while too few of its configurations survive.
_MOST_ROUNDS = 4
# Joints (rad) and positions (in units of 50 mm) that are all this close make the same grasp.
_SAME = 0.02


def _never() -> bool:
    return False


@dataclass(frozen=True)
class RunSettings:
    """What a run is asked for.

    Attributes:
        candidates: configurations asked of the solver in a round.
        seed: random seed.
        sigma: width at which the solver no longer splits boxes, in its own unit of length.
        budget_s: wall-clock time after which nothing new is begun.
        wanted: grasps that should be certified, clear and held before the solver is no longer asked.
        margin_m: distance asked for between bodies that should not touch.
        hold: settings of the physical test.
        workers: processes that retract and hold; the result does not depend on them.
    """

    candidates: int = 16
    seed: int = 0
    sigma: float = 0.1
    budget_s: float = 120.0
    wanted: int = 5
    margin_m: float = 0.0
    hold: HoldSettings = field(default_factory=HoldSettings)
    workers: int = 1

    def as_record(self) -> dict[str, Setting]:
        """All that the result depends on but the seed, by name."""
        own: dict[str, Setting] = {
            "candidates": self.candidates,
            "sigma": self.sigma,
            "wanted": self.wanted,
            "margin": self.margin_m,
        }
        return own | {f"hold.{name}": value for name, value in asdict(self.hold).items()}


@dataclass(frozen=True, eq=False)
class _Context:
    """What a run is made with."""

    reference: str
    task: Task
    folder: RunFolder
    settings: RunSettings
    console: Console
    should_stop: Callable[[], bool]
    deadline: float

    @property
    def remaining_s(self) -> float:
        """Time left in the budget."""
        return self.deadline - time.monotonic()

    @property
    def is_over(self) -> bool:
        """Whether nothing new should be begun."""
        return self.should_stop() or self.remaining_s <= 0.0


def run_task(
    reference: str,
    path: Path,
    settings: RunSettings | None = None,
    *,
    resume: bool = False,
    console: Console | None = None,
    should_stop: Callable[[], bool] = _never,
) -> RunRecord:
    """Runs every stage on a task and writes a run folder.

    Every grasp is written as soon as it is finished. `should_stop` is looked at between steps; where it says
    so, the run ends early, its record not `complete`, with a report of what there is.

    Args:
        reference: built-in name of a task, or path of a task file.
        path: the run folder.
        settings: what is asked for; None takes the defaults.
        resume: continue what an earlier run with the same task and settings left in the folder.
        console: where progress goes; None keeps quiet.
        should_stop: whether to end early.

    Returns:
        What `run.json` says.

    Raises:
        InputError: a task or a folder that can't be used.
    """
    configure()  # chooses the renderer, before a stage imports MuJoCo
    task = load_task(reference)
    settings = settings or RunSettings(hold=preset_settings("holdfast", task))
    context = _Context(
        reference,
        task,
        RunFolder(path),
        settings,
        console or Console(quiet=True),
        should_stop,
        time.monotonic() + settings.budget_s,
    )
    with context.folder.writing():
        record = _begin(context, resume)
        if record.complete:
            return record
        record = _try_grasps(context, record)
        while _wants_more(context, record):
            record = _ask_solver(context, record)
            record = _try_grasps(context, record)
        return _finish(context, record)


def _begin(context: _Context, resume: bool) -> RunRecord:
    """The record to start from: empty, or what an earlier run left."""
    folder, task = context.folder, context.task
    fresh = RunRecord(
        holdfast=__version__,
        task=task.name,
        task_source=relative_source(context.reference, folder.record_path),
        task_fingerprint=fingerprint(task),
        hand=task.hand.name,
        object=task.object.name,
        seed=context.settings.seed,
        settings=context.settings.as_record(),
    )
    if not resume or not folder.record_path.exists():
        folder.start(fresh)
        return fresh
    earlier = _without_broken_round(folder.load())
    _check_same(fresh, earlier, folder.record_path)
    done = sum(grasp.is_done for grasp in earlier.grasps)
    context.console.say(f"resuming: {done} of {len(earlier.grasps)} grasps are done")
    return earlier


def _check_same(fresh: RunRecord, earlier: RunRecord, source: Path) -> None:
    for name in ("task", "task_fingerprint", "seed"):
        if getattr(fresh, name) != getattr(earlier, name):
            raise InputError(
                source,
                name,
                f"is {getattr(earlier, name)!r}, but this run's is {getattr(fresh, name)!r}: can't resume",
            )
    for name, value in fresh.settings.items():
        if earlier.settings.get(name) != value:
            raise InputError(
                source,
                f"settings.{name}",
                f"is {earlier.settings.get(name)!r}, but this run's is {value!r}: can't resume",
            )


def _without_broken_round(record: RunRecord) -> RunRecord:
    """The record without a round that was stopped midway: a resumed run does it again, in full."""
    if record.solve is None or record.solve.rounds[-1].whole:
        return record
    rounds = record.solve.rounds[:-1]
    kept = sum(entry.found for entry in rounds)
    grasps = [grasp for grasp in record.grasps if _number(grasp) <= kept]
    solve_record = Solve.of(rounds, record.solve.sigma) if rounds else None
    return record.model_copy(update={"solve": solve_record, "grasps": grasps})


def _number(grasp: Solution) -> int:
    return int(grasp.id.removeprefix("g"))


def _wants_more(context: _Context, record: RunRecord) -> bool:
    """Whether the solver should be asked (again)."""
    if context.is_over:
        return False
    if record.solve is None:
        return True
    rounds = record.solve.rounds
    return len(record.good) < context.settings.wanted and len(rounds) < _MOST_ROUNDS and rounds[-1].found > 0


def _ask_solver(context: _Context, record: RunRecord) -> RunRecord:
    """A round of the solver: the record with what is new in it."""
    settings = context.settings
    rounds = record.solve.rounds if record.solve else []
    # Rounds far apart, so that runs with neighbouring seeds do not share any.
    seed = settings.seed + 1_000_000 * len(rounds)
    context.console.say(f"solving {record.task}" + (f", round {len(rounds) + 1}" if rounds else ""))
    result = solve(
        context.task,
        candidates=settings.candidates,
        seed=seed,
        sigma=settings.sigma,
        budget_s=max(1.0, context.remaining_s),
        on_progress=lambda p: context.console.pass_by(
            f"  {p.found} found, {p.boxes} boxes done, {p.open} open, {p.seconds:.0f} s"
        ),
        should_stop=context.should_stop,
    )
    grasps = list(record.grasps)
    first = len(grasps) + 1
    for configuration in result.configurations:
        solution = to_solution(configuration, f"g{len(grasps) + 1:02d}")
        if not any(_is_same(solution, other) for other in grasps):
            grasps.append(GraspRecord.model_validate(solution.model_dump()))
    found = len(grasps) + 1 - first
    entry = Round(
        seed=seed,
        verdict=result.verdict.value,
        seconds=result.seconds,
        boxes=result.boxes,
        lps=result.lps,
        found=found,
        whole=not context.should_stop(),
        spread=result.spread,
    )
    context.console.say(
        f"  {entry.verdict}: {found} new configurations, {entry.boxes} boxes, {entry.lps} LPs, "
        f"{entry.seconds:.1f} s"
    )
    record = _timed(record, "solve", result.seconds)
    return _save(
        context,
        record.model_copy(update={"solve": Solve.of([*rounds, entry], settings.sigma), "grasps": grasps}),
    )


def _is_same(a: Solution, b: Solution) -> bool:
    joints = [abs(a.joints[name] - b.joints[name]) for name in a.joints]
    moved = 20.0 * np.abs(np.subtract(a.object.position, b.object.position))
    return max(*joints, *moved) < _SAME


def _try_grasps(context: _Context, record: RunRecord) -> RunRecord:
    """Retracts, squeezes and holds what has not been yet, best first after each."""
    settings = context.settings
    pending = sorted((grasp for grasp in record.grasps if not grasp.is_done), key=_number)
    retraction = RetractionSettings(margin_m=settings.margin_m)
    job = GraspJob(context.reference, context.folder.record_path, settings.hold, retraction)
    started = time.monotonic()
    for tried in try_grasps(
        pending, job, context.task, workers=settings.workers, should_stop=lambda: context.is_over
    ):
        grasp = tried.record
        head = file_head(context.task, context.reference, context.folder.grasp_path(grasp.id))
        context.folder.save_grasp(GraspFile.model_validate({**dict(grasp), **head}), tried.mjcf)
        context.console.say(f"  {describe(grasp)}")
        grasps = sorted((grasp if other.id == grasp.id else other for other in record.grasps), key=rank)
        record = _timed(record, "grasps", time.monotonic() - started)
        record = _save(context, record.model_copy(update={"grasps": grasps}))
        started = time.monotonic()
    return record


def rank(grasp: GraspRecord) -> tuple[bool, bool, bool, int, float, float, int]:
    """Sorts the best first: good, held, reachable, then by directions held, slip and clearance."""
    held = grasp.hold.held_count if grasp.hold else 0
    slip = grasp.hold.slip if grasp.hold and grasp.hold.slip is not None else float("inf")
    clearance = grasp.clearance.after if grasp.clearance else float("-inf")
    passed = not grasp.is_good, not grasp.is_held, grasp.is_unreachable
    return *passed, -held, slip, -clearance, _number(grasp)


def _finish(context: _Context, record: RunRecord) -> RunRecord:
    """Pictures and the report; the run is complete unless it was stopped."""
    if not context.should_stop():
        started = time.monotonic()
        context.console.say("drawing")
        draw_grasps(context.task, record, context.folder, context.settings.hold)
        record = _timed(record, "pictures", time.monotonic() - started)
    whole = record.solve is not None and all(grasp.is_done for grasp in record.grasps)
    record = record.model_copy(update={"complete": whole and not context.should_stop()})
    write_report(context.task, record, context.folder)
    return _save(context, record)


def _verdict(record: RunRecord) -> Literal["held", "not held", "infeasible", "undecided"]:
    if record.good:
        return "held"
    if record.solve is None or record.solve.verdict == "undecided":
        return "undecided"
    if record.solve.verdict == "infeasible":
        return "infeasible"
    return "not held" if all(grasp.is_done for grasp in record.grasps) else "undecided"


def _save(context: _Context, record: RunRecord) -> RunRecord:
    record = record.model_copy(update={"verdict": _verdict(record)})
    context.folder.save(record)
    return record


def _timed(record: RunRecord, stage: str, seconds: float) -> RunRecord:
    spent = {**record.seconds, stage: record.seconds.get(stage, 0.0) + seconds}
    return record.model_copy(update={"seconds": spent})
