"""Built-in tasks, and tasks by path."""

from contextlib import suppress
from functools import cache
from importlib.resources import files
from pathlib import Path

from ..arguments import check_name_or_path
from ..errors import UnknownName
from ..hands import Hand, load_hand
from .carrying import first_that_carries, object_load
from .contact import as_contacts
from .families import family_grasps, is_family
from .object_library import load_object
from .task import Task
from .task_file import read_task
from .task_reference import split_reference

__all__ = ["builtin_tasks", "load_task"]

_FAMILY_HAND = "sa"


def _folder() -> Path:
    return Path(str(files(__package__))) / "data" / "tasks"


def builtin_tasks() -> tuple[str, ...]:
    """Names of the built-in tasks, sorted."""
    return tuple(
        sorted(str(path.relative_to(_folder()).with_suffix("")) for path in _folder().rglob("*.yaml"))
    )


@cache
def _builtin(path: Path) -> Task:
    return read_task(path)


def load_task(name_or_path: str | Path) -> Task:
    """Loads a built-in task by name (`upholding` or `scalpel/upholding`), or a task file by path.

    `family:mug:17` is the task to hold the object of that name.
    `@` and a hand behind it, such as `upholding@shadow` or `pinch.yaml@my_hand.yaml`, put that hand in place
    of the task's own.

    Raises:
        InputError: no such task or hand, a file that can't be used, or a hand without the task's regions.
    """
    allowed = "must be the name of a built-in task, or the path of a task file"
    text, hand = split_reference(check_name_or_path(name_or_path, "task", "", allowed))
    if is_family(text):
        return _family_task(text, load_hand(hand or _FAMILY_HAND))
    if text.endswith((".yaml", ".yml")):
        path = Path(text)
    else:
        path = _builtin_path(text)
        if hand is None:
            return _builtin(path)
    return read_task(path, hand=None if hand is None else load_hand(hand))


def _family_task(name: str, hand: Hand) -> Task:
    """The task to hold a member of a family as its family suggests, or by more where that can't carry it."""
    obj = load_object(name, source="task")
    usual, *stronger = family_grasps(name, source="task")
    grasps = [as_contacts(usual, hand, obj, source="task")]
    for pairs in stronger:
        with suppress(UnknownName):  # a hand without these regions
            grasps.append(as_contacts(pairs, hand, obj, source="task"))
    contacts = grasps[first_that_carries(hand, object_load(obj), grasps)]
    return Task(name=obj.name, hand=hand, object=obj, contacts=contacts, description=obj.description)


def _builtin_path(text: str) -> Path:
    if text in builtin_tasks():
        return _folder() / f"{text}.yaml"
    object_name, _, task_name = text.partition("/")
    path = _folder() / f"{task_name}.yaml"
    if task_name in builtin_tasks() and _builtin(path).object.name == object_name:
        return path
    raise UnknownName(
        "task",
        "",
        "task",
        text,
        builtin_tasks(),
        otherwise="family:FAMILY:SEED, or the path of a task file (.yaml)",
    )
