"""From an object alone to held grasps: contacts are suggested, and tried in turn until enough grasps hold.

What is tried is written as files first (task files; of a mesh a copy and an object file), so that every run
can be resumed, repeated and edited like one of a task that a person wrote; and `search.json` beside them says
what the search has come to, so that it can be gone on with, too.
"""

from collections.abc import Callable
from pathlib import Path

from ... import __version__
from ...base.files.output_file import check_folder_target
from ...base.text.console import Console
from ...base.text.plain_text import counted
from ...errors import InputError
from ...hands import Hand
from ...objects import ObjectModel
from ..records import fingerprint
from ..run import RunSettings
from ..suggest import searches
from .outcome import ObjectRun
from .request import GraspRequest, ObjectFiles
from .runs import Clock, Runs
from .search_file import SearchRecord, read_search
from .sets import Sets

__all__ = ["run_object"]

# Share of the budget that is kept for the search, however long the mesh has taken: without a search all of
# that time would be for nothing.
_SEARCHING = 0.5
# Time for cutting the mesh, however much the hand has taken.
_LEAST_CUTTING_S = 5.0


def run_object(
    request: GraspRequest,
    path: Path,
    settings: RunSettings | None = None,
    *,
    save: Path | None = None,
    resume: bool = False,
    force: bool = False,
    console: Console | None = None,
    should_stop: Callable[[], bool] = lambda: False,
) -> ObjectRun:
    """Looks for contacts on an object, and runs the tasks that they make until enough grasps hold.

    A task of which the first few grasps all fail is left for other contacts.

    Args:
        request: the object and the hand.
        path: the run folder. Where a task holds, but not often enough, the next one goes into a folder beside
            it, with `_2` or the next free number added to its name.
        settings: of the runs; their budget is that of all together, and so is the number of grasps wanted.
        save: folder for the files of object and tasks; unless given beside the run folder, with `_task` added
            to its name.
        resume: go on with what an earlier run of the same object, hand and settings has left in `save`.
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
    clock = Clock(settings.budget_s, should_stop)
    with clock.during("hand"):
        hand = request.load_hand()
    with clock.during("mesh"):
        if request.is_mesh:
            console.pass_by(f"{Path(request.object).name}: read, mended and cut into convex pieces")
        left_s = clock.remaining_s - _SEARCHING * clock.budget_s
        obj = request.load(cut_within_s=max(_LEAST_CUTTING_S, left_s))
    console.say(f"{obj.name}: {counted(len(obj.pieces), 'convex piece')}, after {clock.spent.seconds:.0f} s")
    if "pieces" in obj.sources:
        console.say(f"  {obj.sources['pieces']}")
    if clock.leave_at_least(_SEARCHING):
        console.say(f"  that is much of --budget; {clock.remaining_s:.0f} s are kept for the search")
    record = _begin(request, hand, obj, settings)
    if resume:
        record = _earlier(save, record, force=force)
    with clock.during("search"):
        looking = searches(hand, obj, request.contacts, settings.seed)
    sets = Sets(looking, ObjectFiles(request, save, given=obj, force=force), record)
    runs = Runs(sets, path, settings, clock, console, resume, force)
    for chosen in sets.replay():
        runs.take_up(chosen)
    while not clock.is_over and not runs.outcome.is_enough:
        with clock.during("search"):
            found = sets.find(
                runs.next_folder, budget_s=clock.remaining_s, should_stop=should_stop, console=console
            )
        if found is not None and not clock.is_over:
            chosen, suggestion = found
            console.say(f"trying {suggestion.touching}")
            runs.run(chosen)
    return runs.outcome


def _begin(request: GraspRequest, hand: Hand, obj: ObjectModel, settings: RunSettings) -> SearchRecord:
    """The record of a search that has done nothing yet."""
    asked = {"hand": fingerprint(hand), "object": fingerprint(obj), "contacts": request.contacts}
    return SearchRecord(holdfast=__version__, asked={**asked, **settings.as_record_of_any()})


def _earlier(folder: Path, fresh: SearchRecord, *, force: bool) -> SearchRecord:
    """What an earlier process has left, or the fresh record where that is another search and may go."""
    try:
        return read_search(folder, fresh)
    except InputError:
        if force:
            return fresh
        raise
