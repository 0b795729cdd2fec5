"""Built-in tasks, and tasks by path."""

from functools import cache
from importlib.resources import files
from pathlib import Path

from ..errors import UnknownName
from .task import Task
from .task_file import read_task

__all__ = ["builtin_tasks", "load_task"]


def _folder() -> Path:
    return Path(str(files(__package__))) / "data" / "tasks"


def builtin_tasks() -> tuple[str, ...]:
    """Names of the built-in tasks, sorted."""
    return tuple(
        sorted(str(path.relative_to(_folder()).with_suffix("")) for path in _folder().rglob("*.yaml"))
    )


@cache
def _builtin(name: str) -> Task:
    return read_task(_folder() / f"{name}.yaml")


def load_task(name_or_path: str | Path) -> Task:
    """Loads a built-in task by name (`upholding` or `scalpel/upholding`), or a task file by path.

    Raises:
        InputError: no such task, or a file that can't be used.
    """
    text = str(name_or_path)
    if text.endswith((".yaml", ".yml")):
        return read_task(Path(text))
    if text in builtin_tasks():
        return _builtin(text)
    object_name, _, task_name = text.partition("/")
    if task_name in builtin_tasks() and _builtin(task_name).object.name == object_name:
        return _builtin(task_name)
    raise UnknownName("task", "", "task", text, builtin_tasks())
