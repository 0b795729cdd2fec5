"""A batch from names to a folder of runs with a page and a table; one failure never stops the others."""

import os
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, CancelledError, Future, wait
from dataclasses import dataclass, field, replace
from pathlib import Path

from ...base.text.console import Console
from ...errors import InputError
from ...workers import Pool, TimeOver, open_pool
from ..database import Collected, has_parquet, write_table
from ..run import RunSettings
from ..run_object import GraspRequest
from .batch_folder import BatchFolder, Settings
from .index import write_index
from .item import Item
from .outcome import Outcome
from .progress import Progress
from .work import BatchSetup

__all__ = ["BatchResult", "run_batch"]

# Items that are handed out ahead, by worker, so that none waits for its next one.
_AHEAD = 2
# Settings of runs by which a batch is recognised.
_DECISIVE = ("candidates", "choice", "seed", "sigma", "margin_m", "preset", "quick")
# How often whoever waits looks whether to go on.
_GLANCE_S = 0.2


@dataclass
class BatchResult:
    """What came of a batch.

    Attributes:
        items: what was to be run.
        outcomes: what became of each item that is finished, by its name.
        damaged: files that were set aside as damaged, in words.
        table: the table of all grasps; None where the batch was stopped before.
    """

    items: Sequence[Item]
    outcomes: dict[str, Outcome] = field(default_factory=dict)
    damaged: list[str] = field(default_factory=list)
    table: Path | None = None

    @property
    def is_whole(self) -> bool:
        """Whether every item is done."""
        return all(
            item.name in self.outcomes and self.outcomes[item.name].state == "done" for item in self.items
        )

    @property
    def good(self) -> int:
        """Grasps that are certified, clear and held."""
        return sum(outcome.good for outcome in self.outcomes.values())

    @property
    def left(self) -> int:
        """Grasps that were not tested, as enough of their task hold."""
        return sum(run.left for outcome in self.outcomes.values() for run in outcome.runs)


def run_batch(
    items: Sequence[Item],
    path: Path,
    settings: RunSettings,
    *,
    request: GraspRequest | None = None,
    workers: int = 1,
    limit_s: float | None = None,
    resume: bool = False,
    console: Console | None = None,
    should_stop: Callable[[], bool] = lambda: False,
) -> BatchResult:
    """Runs items, each in a process of its own, and makes a page and a table of what came out.

    What comes out does not depend on the number of workers, nor on how often it was killed and resumed, where
    no budget cuts in.

    Args:
        items: what to run.
        path: the batch's folder; a cluster's workers must reach it by the same path.
        settings: of each run.
        request: what is asked of meshes; its own path counts for nothing.
        workers: items that are run at a time; a cluster has its own number.
        limit_s: how long an item may take; then its process is ended, and its outcome says so. None for three
            times the budget and a minute.
        resume: go on with the batch that lies there; what has failed is tried again.
        console: where progress goes; None keeps quiet.
        should_stop: whether to end early; what is finished is kept.

    Raises:
        InputError: a folder that can't be used or written, or that holds another batch.
    """
    path = Path(os.path.abspath(path))
    folder, console = BatchFolder(path), console or Console(quiet=True)
    settings = replace(settings, workers=1)
    request = request or GraspRequest("")
    limit_s = 3.0 * settings.budget_s + 60.0 if limit_s is None else limit_s
    result = BatchResult(items)
    with folder.writing():
        folder.begin(list(items), _plain(settings, request), resume=resume)
        for item in items:
            known, damaged = folder.whole_outcome(item)
            result.damaged += damaged
            if known is not None:
                result.outcomes[item.name] = known
        for words in result.damaged:
            console.say(words)
        progress = Progress(len(items), before=len(result.outcomes))
        if resume:
            console.say(f"resuming: {progress.before} of {len(items)} are done")
        pending = [item for item in items if item.name not in result.outcomes]
        if pending:
            setup = BatchSetup(path, settings, request)
            with open_pool(setup, min(workers, len(pending)), limit_s=limit_s) as pool:
                for item, outcome in _outcomes(pool, pending, workers, should_stop):
                    folder.save(item, outcome)
                    result.outcomes[item.name] = outcome
                    progress.add(outcome)
                    console.say(f"{_line(outcome)}; {progress}")
        _finish(result, folder, console)
        return result


def _outcomes(
    pool: Pool[Item, Outcome], items: Sequence[Item], workers: int, should_stop: Callable[[], bool]
) -> Iterator[tuple[Item, Outcome]]:
    """What became of each item, as soon as it is known."""
    waiting = deque(items)
    begun: dict[Future[Outcome], Item] = {}
    while (waiting or begun) and not should_stop():
        while waiting and len(begun) < _AHEAD * workers:
            item = waiting.popleft()
            begun[pool.submit(item)] = item
        done, _ = wait(begun, timeout=_GLANCE_S, return_when=FIRST_COMPLETED)
        # In the order in which they were begun, where several have ended.
        for future in [future for future in begun if future in done]:
            item = begun.pop(future)
            yield item, _outcome(future, item)


def _outcome(future: "Future[Outcome]", item: Item) -> Outcome:
    try:
        return future.result()
    except TimeOver as over:
        return Outcome(
            reference=item.reference, name=item.name, state="too long", reason=str(over), seconds=over.limit_s
        )
    except CancelledError:
        return Outcome(reference=item.reference, name=item.name, state="lost", reason="was called off")


def _finish(result: BatchResult, folder: BatchFolder, console: Console) -> None:
    """The page and the table, of what there is."""
    write_index(folder, result.items, result.outcomes)
    runs = [
        folder.path / run.folder
        for item in result.items
        if item.name in result.outcomes
        for run in result.outcomes[item.name].runs
    ]
    table = folder.path / ("grasps.parquet" if has_parquet() else "grasps.jsonl")
    collected = Collected(runs, table)
    write_table(collected, table)
    for words in collected.refused:
        console.say(f"left out of the table: {words}")
    result.table = table


def _line(outcome: Outcome) -> str:
    if outcome.state != "done":
        return f"{outcome.name}: {outcome.state}: {outcome.reason}"
    solved = sum(run.solved for run in outcome.runs)
    left = sum(run.left for run in outcome.runs)
    spared = f", {left} left untested" if left else ""
    counted = f"{outcome.good} of {solved} grasps good{spared}"
    return f"{outcome.name}: {outcome.verdict}, {counted}, {outcome.seconds:.1f} s"


def _plain(settings: RunSettings, request: GraspRequest) -> Settings:
    """What the results depend on, by name; a batch may be resumed with another budget."""
    named: Settings = {name: getattr(settings, name) for name in _DECISIVE}
    if settings.hold:
        raise InputError("batch", "hold", "single settings of the hold test are for runs of one task")
    asked = ("hand", "mass_kg", "friction", "scale", "units", "contacts")
    named["wanted"] = settings.grasps_wanted
    if settings.enough is not None:
        named["enough"] = settings.enough
    if settings.chooser is not None:
        named["chooser"] = settings.chooser.digest
    return named | {f"mesh.{name}": getattr(request, name) for name in asked}
