"""Making a data set: parts that are written one by one, and what is put together of them in the end."""

import json
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import CancelledError, Future
from concurrent.futures import TimeoutError as FutureTimeout
from dataclasses import dataclass
from datetime import UTC, date, datetime
from pathlib import Path
from time import monotonic

import numpy as np

from ...base.files.json_file import read_json
from ...base.files.output_file import make_folder, remove_parts, write_json, write_text
from ...base.machine.backend import configure
from ...base.machine.cancellation import Cancelled, cancellable
from ...base.text.console import Console
from ...base.text.plain_text import counted
from ...errors import InputError
from ...workers import WorkerPool
from .collect import check_packages, collect
from .part import Part, read_part
from .plan import DatasetPlan, SituationPlan
from .work import MadePart, PartSetup

__all__ = ["DatasetResult", "make_dataset", "parts_of"]

_PLAN_FILE = "plan.json"
_PARTS = "parts"
_GLANCE_S = 0.1
_AHEAD = 2


@dataclass(frozen=True)
class DatasetResult:
    """What has become of a data set.

    Attributes:
        complete: whether every part is there.
        situations: parts that are there.
        candidates: candidates in them.
        labels: outcomes of these.
        held: share of outcomes that were held, by load.
        made: parts that this call has made.
        cpu_s: what they took.
    """

    complete: bool
    situations: int
    candidates: int
    labels: int
    held: dict[float, float]
    made: int
    cpu_s: float

    def __str__(self) -> str:
        shares = ", ".join(f"{share:.0%} at load {load:g}" for load, share in self.held.items())
        text = f"{counted(self.situations, 'situation')}, {counted(self.candidates, 'candidate')}, "
        text += counted(self.labels, "outcome")
        text += f"; held: {shares}" if shares else ""
        return text if self.complete else f"not complete: {text}; run the command again to go on"


def make_dataset(
    plan: DatasetPlan,
    folder: Path,
    *,
    workers: int = 1,
    licence: str = "Apache-2.0",
    command: str = "",
    minari: str = "",
    console: Console | None = None,
    should_stop: Callable[[], bool] = lambda: False,
) -> DatasetResult:
    """Makes a data set, or goes on with one that was begun; what comes out is the same.

    Args:
        plan: what it is to hold.
        folder: where it is written. Parts that lie there, of a plan with the same recipe, are taken.
        workers: processes; with 1, this one does it all.
        licence: of the data, for its card.
        command: by which it was made, for its card.
        minari: name under which it is put among Minari's data sets as well; empty for not at all.
        console: where progress goes; None keeps quiet.
        should_stop: whether to end early; what was finished stays.

    Raises:
        InputError: something of the plan that can't be used, or a folder that holds another data set.
        MissingBackend: a package that is needed is not installed.
    """
    check_packages(minari)
    configure()  # before a hand's model imports MuJoCo, which settles on its renderer then
    plan.check()
    console = console or Console(quiet=True)
    _begin(plan, folder)
    jobs = _jobs(plan, folder)
    missing = [job for job in jobs if not _path(folder, job).exists()]
    if len(missing) < len(jobs):
        console.say(f"going on: {len(jobs) - len(missing)} of {len(jobs)} situations are there")
    cpu_s, done, started = 0.0, 0, monotonic()
    for job, made in zip(missing, _made(missing, plan, workers, should_stop), strict=False):
        _write_part(_path(folder, job), made.part)
        cpu_s, done = cpu_s + made.cpu_s, done + 1
        left_s = (monotonic() - started) / done * (len(missing) - done)
        console.say(f"  {_line(job, made.part)}; {_left(len(jobs) - len(missing) + done, len(jobs), left_s)}")
    complete = done == len(missing)
    parts = parts_of(plan, folder)
    if complete:
        collect(
            parts,
            plan,
            folder,
            licence=licence,
            command=command,
            published=_last_made(_path(folder, job) for job in jobs),
            minari=minari,
            console=console,
        )
    return _result(parts, plan, complete, done, cpu_s)


def parts_of(plan: DatasetPlan, folder: Path) -> list[Part]:
    """The parts of a plan's objects and hands that are there, in its order.

    Raises:
        InputError: one that can't be read.
    """
    paths = (_path(folder, job) for job in plan.pairs())
    return [read_part(path) for path in paths if path.exists()]


def _jobs(plan: DatasetPlan, folder: Path) -> list[SituationPlan]:
    """What the data set is to hold: what is asked for, and what lies there of the same objects and hands."""
    asked = set(plan.situations())
    return [job for job in plan.pairs() if job in asked or _path(folder, job).exists()]


def _begin(plan: DatasetPlan, folder: Path) -> None:
    make_folder(folder / _PARTS)
    path = folder / _PLAN_FILE
    if path.exists():
        recipe = read_json(path)
        for name, value in plan.recipe.items():
            if recipe.get(name) != value:
                raise InputError(
                    folder, "", f"holds a data set with other {name}: {recipe.get(name)}, not {value}"
                )
    else:
        if any((folder / _PARTS).iterdir()):
            raise InputError(folder, "", f"holds parts, but no {_PLAN_FILE} that says what they are of")
        write_json(path, plan.recipe)


def _path(folder: Path, job: SituationPlan) -> Path:
    return folder / _PARTS / f"{job.key}.json"


def _last_made(paths: Iterable[Path]) -> date:
    """When the last part was made: writing all anew from the same parts changes nothing."""
    return datetime.fromtimestamp(max(path.stat().st_mtime for path in paths), UTC).date()


def _write_part(path: Path, part: Part) -> None:
    remove_parts(path)
    write_text(path, json.dumps(part.model_dump(mode="json"), separators=(",", ":"), allow_nan=False) + "\n")


def _made(
    jobs: Sequence[SituationPlan], plan: DatasetPlan, workers: int, should_stop: Callable[[], bool]
) -> Iterator[MadePart]:
    """The parts in the order of the jobs; fewer where someone asks to stop."""
    setup = PartSetup(plan)
    if workers == 1 or len(jobs) < 2:
        worker = setup.new_worker()
        for job in jobs:
            try:
                if should_stop():
                    return
                with cancellable(should_stop):
                    made = worker.work(job)
            except Cancelled:
                return
            yield made
        return
    with WorkerPool(setup, min(workers, len(jobs))) as pool:
        waiting: deque[Future[MadePart]] = deque()
        for job in jobs:
            waiting.append(pool.submit(job))
            if len(waiting) >= _AHEAD * workers:
                first = _first(waiting, should_stop)
                if first is None:
                    return
                yield first
        while waiting:
            first = _first(waiting, should_stop)
            if first is None:
                return
            yield first


def _first(waiting: "deque[Future[MadePart]]", should_stop: Callable[[], bool]) -> MadePart | None:
    first = waiting.popleft()
    while not should_stop():
        try:
            return first.result(timeout=_GLANCE_S)
        except FutureTimeout:
            continue
        except CancelledError:
            return None
    return None


def _line(job: SituationPlan, part: Part) -> str:
    what = f"{job.object} with {part.told.hand if part.told else Path(job.hand).stem}"
    if len(part.candidates) < 2:
        why = ", ".join(f"{count} {reason}" for reason, count in part.refused.items()) or "one candidate"
        return f"{what}: nothing to choose ({why})"
    held = np.array([[[one.held for one in draw] for draw in row] for row in part.outcomes])
    shares = ", ".join(f"{share:.0%}" for share in held.mean(axis=(0, 1)))
    return f"{what}: {counted(len(part.candidates), 'candidate')}, held {shares}"


def _left(done: int, count: int, seconds: float) -> str:
    if done == count:
        return f"{done} of {count}"
    return f"{done} of {count}, some {max(1, round(seconds / 60.0))} min left"


def _result(
    parts: Sequence[Part], plan: DatasetPlan, complete: bool, made: int, cpu_s: float
) -> DatasetResult:
    outcomes = [draw for part in parts for row in part.outcomes for draw in row]
    shares = np.array([[one.held for one in draw] for draw in outcomes]).reshape(-1, len(plan.loads))
    held = dict(zip(plan.loads, shares.mean(axis=0).tolist(), strict=True)) if len(shares) else {}
    return DatasetResult(
        complete=complete,
        situations=sum(len(part.candidates) > 1 for part in parts),
        candidates=sum(len(part.candidates) for part in parts),
        labels=shares.size,
        held=held,
        made=made,
        cpu_s=cpu_s,
    )
