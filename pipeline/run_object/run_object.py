"""From an object alone to held grasps: contacts are suggested, and tried in turn until enough grasps hold.

What is tried is written as files first (a copy of the mesh, an object file, task files), so that every run
can be resumed, repeated and edited like one of a task that a person wrote.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from itertools import cycle
from pathlib import Path

from ...console import Console
from ...output_file import check_folder_target
from ...plain_text import counted
from ...work_clock import WorkClock
from ..run import RunSettings, free_folder, run_task
from ..suggest import Search, Suggestion, searches
from .outcome import Attempt, ObjectRun
from .request import GraspRequest, ObjectFiles

__all__ = ["run_object"]

# Share of the time that is left for a turn of looking for contacts.
_SUGGESTING = 0.25
# Share of the time that is left which one task may take.
_RUNNING = 0.6


def run_object(
    request: GraspRequest,
    path: Path,
    settings: RunSettings | None = None,
    *,
    save: Path | None = None,
    force: bool = False,
    console: Console | None = None,
    should_stop: Callable[[], bool] = lambda: False,
) -> ObjectRun:
    """Looks for contacts on an object, and runs the tasks that they make until enough grasps hold.

    Args:
        request: the object and the hand.
        path: the run folder. Where a task holds, but not often enough, the next one goes into a folder beside
            it, with `_2` or the next free number added to its name.
        settings: of the runs; their budget is that of all together, and so is the number of grasps wanted.
        save: folder for the files of object and tasks; unless given beside the run folder, with `_task` added
            to its name.
        force: replace the runs that lie in these folders, whatever they are, and files that were edited.
        console: where progress goes; None keeps quiet.
        should_stop: whether to end early.

    Raises:
        InputError: an object, a hand or a folder that can't be used.
    """
    save = save or path.with_name(f"{path.name}_task")
    for target in (path, save):
        check_folder_target(target)
    settings, console = settings or RunSettings(), console or Console(quiet=True)
    clock = _Clock(settings.budget_s, should_stop)
    wanted = max(1, settings.grasps_wanted)
    hand = request.load_hand()
    obj = request.load()
    console.say(f"{obj.name}: {counted(len(obj.pieces), 'convex piece')}, after {clock.spent.seconds:.0f} s")
    looking = searches(hand, obj, request.contacts, settings.seed)
    files = ObjectFiles(request, save, force=force)
    attempts: list[Attempt] = []
    folder, folders = path, 1
    for number, suggestion in enumerate(_suggestions(looking, clock, console), start=1):
        held = sum(len(attempt.record.good) for attempt in attempts)
        if clock.is_over:
            break
        # The folder of a task that did not hold is for the next one.
        is_new = not attempts or attempts[-1].is_held
        if is_new and attempts:
            folders += 1
            folder = path.with_name(f"{path.name}_{folders}") if force else free_folder(path)
        task_file, reference = files.write_task(suggestion, number)
        console.say(f"trying {suggestion.touching}")
        record = run_task(
            reference,
            folder,
            _for_next(settings, _RUNNING * clock.remaining_s, held),
            force=force or not is_new,
            console=console,
            should_stop=should_stop,
        )
        attempts.append(Attempt(task_file, record, folder))
        console.say(f"  {attempts[-1]}")
        if sum(len(attempt.record.good) for attempt in attempts) >= wanted:
            break  # before another suggestion is looked for
    return ObjectRun(tuple(attempts), tuple(search.tried for search in looking), files.folder, wanted)


def _for_next(settings: RunSettings, budget_s: float, held: int) -> RunSettings:
    """The settings of a task that is tried once some grasps of others hold."""
    if settings.enough is not None:
        return replace(settings, budget_s=budget_s, enough=settings.enough - held)  # some are wanted still
    return replace(settings, budget_s=budget_s, wanted=max(0, settings.grasps_wanted - held))


@dataclass(frozen=True)
class _Clock:
    """When to end.

    Attributes:
        budget_s: of the whole command, its reading and cutting of the mesh included.
        should_stop: whether someone asks to end early.
        spent: what has been spent of it.
    """

    budget_s: float
    should_stop: Callable[[], bool]
    spent: WorkClock = field(default_factory=WorkClock)

    @property
    def remaining_s(self) -> float:
        """Time left."""
        return self.budget_s - self.spent.seconds

    @property
    def is_over(self) -> bool:
        """Whether nothing new should be begun."""
        return self.remaining_s <= 0.0 or self.should_stop()


def _suggestions(looking: list[Search], clock: _Clock, console: Console) -> Iterator[Suggestion]:
    """Suggestions, the simplest tasks first, then in turns with more contacts, until time is over."""
    for search in cycle(looking):
        if clock.is_over:
            return
        console.say(f"looking for {search.tried.contacts} contacts")
        yield from search.more(
            1,
            budget_s=min(clock.remaining_s, max(2.0, _SUGGESTING * clock.remaining_s)),
            should_stop=clock.should_stop,
            on_progress=lambda tried, kept: console.pass_by(f"  {tried} tried, {kept} reached"),
        )
