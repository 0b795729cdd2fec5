"""From an object alone to held grasps: contacts are suggested, and tried in turn until enough grasps hold.

What is tried is written as files first (a copy of the mesh, an object file, task files), so that every run
can be resumed, repeated and edited like one of a task that a person wrote.
"""

import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from time import monotonic

import yaml

from ..console import Console
from ..errors import InputError
from ..files import write_text
from ..hands import Hand, load_hand
from ..objects import ObjectModel, load_object, with_hand
from .records import RunRecord
from .run import RunSettings, run_task
from .suggest import Suggestion, suggest, task_text

__all__ = ["Attempt", "ObjectRun", "ObjectSource", "run_object", "write_object"]

# Contacts of the tasks that are tried where their number is left open, the simplest first.
_USUAL_CONTACTS = (2, 3)
# Share of the remaining time that looking for contacts may take, for each number of contacts.
_SUGGESTING = 0.25
_MOST_SUGGESTIONS = 4


@dataclass(frozen=True)
class ObjectSource:
    """What is to be grasped, and with what.

    Attributes:
        mesh: a mesh file.
        hand: name of a built-in hand, or path of a hand file.
        mass_kg: of the object; that of 500 kg/m^3 unless given.
        friction: of the object; 0.6 unless given.
        contacts: pairs of regions in a task; two, then three, unless given.
    """

    mesh: Path
    hand: str = "sa"
    mass_kg: float | None = None
    friction: float | None = None
    contacts: int | None = None


@dataclass(frozen=True)
class Attempt:
    """A task that was tried.

    Attributes:
        task: its file.
        record: of its run.
    """

    task: Path
    record: RunRecord

    @property
    def is_held(self) -> bool:
        """Whether some grasp of it held."""
        return self.record.verdict == "held"

    def __str__(self) -> str:
        grasps = self.record.grasps
        counts = (
            (len(grasps), "certified"),
            (sum(grasp.is_clear for grasp in grasps), "clear"),
            (len(self.record.good), "held"),
        )
        return f"{self.task.name}: " + ", ".join(f"{count} {word}" for count, word in counts)


@dataclass(frozen=True)
class ObjectRun:
    """What became of an object.

    Attributes:
        attempts: the tasks that were tried, in their order; the run folder holds the last of them.
        suggested: how many tasks were suggested.
        folder: where the files of the object and its tasks lie.
    """

    attempts: tuple[Attempt, ...]
    suggested: int
    folder: Path

    @property
    def is_held(self) -> bool:
        """Whether some grasp held."""
        return any(attempt.is_held for attempt in self.attempts)

    def __str__(self) -> str:
        """What was tried, a line each, and what refused it, with what to change."""
        if not self.suggested:
            return (
                "no contacts were found with force closure that the hand reaches: try --contacts, another "
                "--hand, a larger --budget, or a task of your own"
            )
        lines = [str(attempt) for attempt in self.attempts]
        if not self.is_held:
            lines.append(f"nothing held; {self._remedy()}")
        return "\n".join(lines)

    def _remedy(self) -> str:
        grasps = [grasp for attempt in self.attempts for grasp in attempt.record.grasps]
        if not grasps:
            return "no configuration was certified in time: try a larger --budget"
        if not any(grasp.is_clear for grasp in grasps):
            return "every configuration sinks into something: try --contacts, or another --hand"
        return "clear grasps slip or can't carry the load: try --contacts 3, or a smaller --mass"


def run_object(
    source: ObjectSource,
    path: Path,
    settings: RunSettings | None = None,
    *,
    save: Path | None = None,
    console: Console | None = None,
    should_stop: Callable[[], bool] = lambda: False,
) -> ObjectRun:
    """Looks for contacts on an object, and runs the tasks that they make until one of them holds.

    Args:
        source: the object and the hand.
        path: the run folder, which ends up with the last task that was tried.
        settings: of the runs; their budget is that of all together.
        save: folder for the files of object and tasks; unless given beside the run folder, with `_task` added
            to its name.
        console: where progress goes; None keeps quiet.
        should_stop: whether to end early.

    Raises:
        InputError: an object, a hand or a folder that can't be used.
    """
    settings, console = settings or RunSettings(), console or Console(quiet=True)
    deadline = monotonic() + settings.budget_s
    folder = save or path.with_name(f"{path.name}_task")
    hand = load_hand(source.hand, source="run", field="--hand")
    object_file, obj = write_object(source, folder)
    attempts: list[Attempt] = []
    suggested = 0
    for suggestion in _suggestions(source, hand, obj, settings, deadline, console, should_stop):
        suggested += 1
        remaining_s = deadline - monotonic()
        if should_stop() or remaining_s <= 0.0:
            break
        task_file = _write_task(source, suggestion, suggested, object_file)
        console.say(f"trying {suggestion.touching}")
        record = run_task(
            with_hand(str(task_file), None if _is_builtin(source.hand) else source.hand),
            path,
            replace(settings, budget_s=remaining_s),
            console=console,
            should_stop=should_stop,
        )
        attempts.append(Attempt(task_file, record))
        if attempts[-1].is_held:
            break
    return ObjectRun(tuple(attempts), suggested, folder)


def _suggestions(
    source: ObjectSource,
    hand: Hand,
    obj: ObjectModel,
    settings: RunSettings,
    deadline: float,
    console: Console,
    should_stop: Callable[[], bool],
) -> Iterator[Suggestion]:
    """Suggestions, the simplest tasks first; more contacts are looked for when fewer did not do."""
    for contacts in (source.contacts,) if source.contacts else _USUAL_CONTACTS:
        remaining_s = deadline - monotonic()
        if should_stop() or remaining_s <= 0.0:
            return
        console.say(f"looking for {contacts} contacts of {hand.name} on {obj.name}")
        try:
            yield from suggest(
                hand,
                obj,
                contacts=contacts,
                count=_MOST_SUGGESTIONS,
                seed=settings.seed,
                budget_s=_SUGGESTING * remaining_s,
                should_stop=should_stop,
            )
        except InputError:
            if source.contacts or contacts == _USUAL_CONTACTS[0]:
                raise
            return  # the hand has no more fingers


def write_object(source: ObjectSource, folder: Path) -> tuple[Path, ObjectModel]:
    """A copy of the mesh and an object file beside it; the file, and the object as it is read from there."""
    given = load_object(source.mesh, mass_kg=source.mass_kg, friction=source.friction, source="run")
    folder.mkdir(parents=True, exist_ok=True)
    mesh = folder / f"{given.name}{source.mesh.suffix.lower()}"
    if not (mesh.exists() and mesh.samefile(source.mesh)):
        shutil.copyfile(source.mesh, mesh)
    file = folder / f"{given.name}.yaml"
    described = {
        "name": f"{given.name}_mesh" if given.name in ("object", "stand", "world", "main") else given.name,
        "mesh": mesh.name,
        "mass": float(f"{given.inertia.mass:.6g}"),
        "friction": given.friction,
    }
    sources = {name: text for name, text in given.sources.items() if name != "mesh"}
    if sources:
        described["sources"] = sources
    write_text(file, yaml.safe_dump(described, sort_keys=False, allow_unicode=True))
    return file, load_object(file)


def _write_task(source: ObjectSource, suggestion: Suggestion, number: int, object_file: Path) -> Path:
    name = f"{suggestion.task.name}_{number}"
    file = object_file.with_name(f"{name}.yaml")
    hand = source.hand if _is_builtin(source.hand) else Path(source.hand).name
    write_text(file, task_text(suggestion, name, hand, object_file.name))
    return file


def _is_builtin(hand: str) -> bool:
    return not hand.endswith((".yaml", ".yml"))
