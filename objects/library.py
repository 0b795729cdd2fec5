"""Built-in objects and tasks, and the user's own by path."""

from functools import cache
from importlib.resources import files
from pathlib import Path

from ..errors import UnknownName
from .object_file import read_object
from .object_model import ObjectModel
from .task import Task
from .task_file import read_task

__all__ = ["builtin_objects", "builtin_tasks", "load_object", "load_task"]


def _folder() -> Path:
    return Path(str(files(__package__))) / "data"


def builtin_objects() -> tuple[str, ...]:
    """Names of the built-in objects, sorted."""
    return tuple(sorted(path.stem for path in _folder().glob("*.yaml")))


def builtin_tasks() -> tuple[str, ...]:
    """Names of the built-in tasks, sorted."""
    folder = _folder() / "tasks"
    return tuple(sorted(str(path.relative_to(folder).with_suffix("")) for path in folder.rglob("*.yaml")))


@cache
def _builtin_object(name: str) -> ObjectModel:
    return read_object(_folder() / f"{name}.yaml")


@cache
def _builtin_task(name: str) -> Task:
    return read_task(_folder() / "tasks" / f"{name}.yaml")


def load_object(name_or_path: str | Path) -> ObjectModel:
    """Loads a built-in object by name, or an object file by path (.yaml, .yml).

    Raises:
        InputError: no such object, or a file that can't be used.
    """
    text = str(name_or_path)
    if text.endswith((".yaml", ".yml")):
        return read_object(Path(text))
    if text not in builtin_objects():
        raise UnknownName("object", "", "object", text, builtin_objects())
    return _builtin_object(text)


def load_task(name_or_path: str | Path) -> Task:
    """Loads a built-in task by name (`upholding` or `scalpel/upholding`), or a task file by path.

    Raises:
        InputError: no such task, or a file that can't be used.
    """
    text = str(name_or_path)
    if text.endswith((".yaml", ".yml")):
        return read_task(Path(text))
    if text in builtin_tasks():
        return _builtin_task(text)
    object_name, _, task_name = text.partition("/")
    if task_name in builtin_tasks() and _builtin_task(task_name).object.name == object_name:
        return _builtin_task(task_name)
    raise UnknownName("task", "", "task", text, builtin_tasks())
