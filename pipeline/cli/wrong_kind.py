"""What is said where an argument is a file of another kind than the command takes: what it is, what to do."""

import argparse
from collections.abc import Iterator
from pathlib import Path

from ...errors import InputError, UnknownName
from .file_kinds import KIND_WORDS, kind_of

__all__ = ["kinds_taken", "of_another_kind", "wrong_kind"]

# What arguments take, by what help calls them, and by command where that says too little.
_BY_NAME = {
    "TASK": ("task",),
    "HAND": ("hand", "model"),
    "OBJECT": ("object", "mesh"),
    "MESH": ("mesh", "object"),
    "GRASP": ("grasp",),
    "RUN": ("run",),
    "RUN|GRASP": ("run", "grasp"),
}
_BY_COMMAND = {
    ("run", "task"): ("task", "mesh", "object"),
    ("solve", "task"): ("task", "mesh", "object"),
    ("tasks", "name"): ("task",),
    ("hands", "name"): ("hand", "model"),
    ("hands new", "model"): ("model", "hand"),
    ("objects", "name"): ("object", "mesh"),
    ("show", "name"): ("object", "mesh", "hand", "model", "task", "grasp"),
    ("edit", "name"): ("mesh", "object", "task"),
    ("system", "file"): ("system",),
    ("check-proof", "file"): ("proof", "grasp"),
}
# What can be done with each kind; of a file, its path and its folder are filled in.
_ADVICE = {
    "task": "`holdfast run {path}` finds grasps for it",
    "object": "`holdfast suggest {path}` proposes tasks for it",
    "mesh": "`holdfast run {path}` looks for contacts on it",
    "hand": "`holdfast hands {path}` shows its joints and regions",
    "model": "`holdfast hands {path}` reads it as a hand",
    "grasp": "`holdfast hold {path}` tests it and `holdfast show {path}` draws it",
    "run": "`holdfast report {path}` writes its report anew",
    "record": "`holdfast report {folder}` writes the report of its run anew",
    "result": "`holdfast solve TASK --out DIR` writes grasp files",
    "system": "`holdfast system {path}` solves it",
    "proof": "`holdfast check-proof {path}` replays it",
    "report": "open it in a browser",
    "picture": "open it with what shows pictures",
}


def kinds_taken(command: str, action: argparse.Action) -> tuple[str, ...]:
    """The kinds of files and names that an argument or option takes; () where it takes none, or any."""
    found = _BY_COMMAND.get((command, action.dest))
    # Of what is not read, as `--out FILE`, no kind is known.
    return found if found is not None else _BY_NAME.get(str(action.metavar), ())


def wrong_kind(
    parser: argparse.ArgumentParser, arguments: argparse.Namespace, error: InputError
) -> str | None:
    """Of the first argument that is of a kind which its command does not take: what it is, and what to do.

    Args:
        parser: of the command.
        arguments: what it was given.
        error: what it came to; a file whose name was taken for that of something built in is told as a file.
    """
    for action, value in _given(parser, arguments):
        taken = kinds_taken(arguments.command, action)
        words = of_another_kind(value, taken)
        if words is not None:
            return f"{value}: {words}"
        is_sought = isinstance(error, UnknownName) and error.name == value
        if taken and is_sought and Path(value).exists():
            return f"{value}: is not {_wanted(taken)}, nor anything else that is known"
    return None


def of_another_kind(value: str, taken: tuple[str, ...]) -> str | None:
    """What a file or name is that is of none of the kinds taken, and what to do; None where it is of one."""
    found = kind_of(value) if taken else None
    if found is None or found in taken:
        return None
    advice = _advice(found, value, taken)
    return f"is {KIND_WORDS[found]}, not {_wanted(taken)}" + (f"; {advice}" if advice else "")


def _wanted(taken: tuple[str, ...]) -> str:
    *first, last = (KIND_WORDS[kind] for kind in taken)
    return f"{', '.join(first)} or {last}" if first else last


def _given(
    parser: argparse.ArgumentParser, arguments: argparse.Namespace
) -> Iterator[tuple[argparse.Action, str]]:
    for action in parser._actions:
        value = getattr(arguments, action.dest, None)
        for word in value if isinstance(value, list) else [value]:
            if isinstance(word, str):
                yield action, word


def _advice(found: str, value: str, taken: tuple[str, ...]) -> str:
    path = Path(value)
    folder = path if found == "run" else path.parent
    if "grasp" in taken and found in ("run", "record"):
        grasps = sorted(folder.glob("grasps/*.json"))
        return (
            f"name one of its grasps, such as {grasps[0]}"
            if grasps
            else "no grasp files lie in grasps/ beside it"
        )
    if "grasp" in taken and found in ("task", "mesh"):
        return f"`holdfast run {value}` makes grasps of it"
    if "run" in taken and found == "record":
        return f"name its folder: {folder}"
    if "run" in taken and found in ("grasp", "report") and (run := _run_around(path)):
        return f"name the folder of its run: {run}"
    return _ADVICE.get(found, "").format(path=value, folder=folder)


def _run_around(path: Path) -> Path | None:
    return next((folder for folder in list(path.parents)[:2] if (folder / "run.json").is_file()), None)
