"""Input files as checked values, result files, and where what can be made again is kept."""

import errno
import json
import os
from pathlib import Path
from typing import Any, TypeVar

import platformdirs
from pydantic import BaseModel, ConfigDict, Tag, ValidationError

from .errors import InputError, suggest
from .input_file import read_text
from .output_file import write_bytes, write_json, write_text, writing_file
from .yaml_file import read_yaml

__all__ = [
    "FileModel",
    "cache_folder",
    "folders_open_to",
    "parse",
    "read_json",
    "read_json_value",
    "read_yaml",
    "real_path",
    "resolve_beside",
    "write_bytes",
    "write_json",
    "write_text",
    "writing_file",
]

# A run of thousands of grasps stays far below; a larger JSON file is not ours.
_LARGEST_JSON_BYTES = 128 * 1024 * 1024
# A value takes some 100 bytes once it is read, however short it is written.
_MOST_JSON_VALUES = 6_000_000

ROOT_VARIABLE = "HOLDFAST_ROOT"
"""Environment variable with a folder below which files may name each other."""


class FileModel(BaseModel):
    """Base of the models that describe files: unknown fields are errors, numbers are finite."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False, frozen=True)


ModelT = TypeVar("ModelT", bound=FileModel)


def parse(model: type[ModelT], data: dict[str, Any], source: str | Path) -> ModelT:
    """Validates `data` against a file model.

    Raises:
        InputError: with the first field at fault, and the nearest known name for a misspelt one.
    """
    try:
        return model.model_validate(data)
    except ValidationError as error:
        found = error.errors(include_url=False)
    # A misspelt field also counts as a missing one: the spelling is what helps.
    first = next((entry for entry in found if entry["type"] == "extra_forbidden"), found[0])
    field = _field(first["loc"])
    if first["type"] == "extra_forbidden":
        known = _fields_at(model, first["loc"][:-1])
        raise InputError(source, field, f"unknown field{suggest(str(first['loc'][-1]), known)}")
    raise InputError(source, field, _plain(first))


def _field(loc: tuple[str | int, ...]) -> str:
    """Dotted path, without what pydantic adds to it: tags of unions (`<tag>`) and the mark of a key."""
    return ".".join(str(part) for part in loc if part != "[key]" and not _is_tag(part))


def _is_tag(part: str | int) -> bool:
    return isinstance(part, str) and part.startswith("<") and part.endswith(">")


def _plain(entry: Any) -> str:
    """Pydantic's message in the manner of ours, with the value where it is short."""
    message = str(entry["msg"]).removeprefix("Value error, ")
    if entry["type"] == "missing":
        return "is required"
    if entry["type"] in ("too_short", "too_long") and "actual_length" in (context := entry.get("ctx", {})):
        bound = ("least", "min_length") if entry["type"] == "too_short" else ("most", "max_length")
        return f"needs at {bound[0]} {context[bound[1]]}, not {context['actual_length']}"
    value = entry.get("input")
    is_scalar = value is None or isinstance(value, (str, int, float))
    shown = f", not {value!r}" if is_scalar and len(repr(value)) <= 60 else ""
    return message[0].lower() + message[1:] + shown


def _fields_at(model: type[BaseModel], loc: tuple[Any, ...]) -> list[str]:
    """Field names of the nested model at `loc`, found through the annotations."""
    current: Any = model
    for part in loc:
        if _is_tag(part):
            current = _tagged(current, part) or current
        elif isinstance(part, str):
            current = _inner_model(current)
            if isinstance(current, type) and issubclass(current, BaseModel) and part in current.model_fields:
                current = current.model_fields[part].annotation
    current = _inner_model(current)
    if isinstance(current, type) and issubclass(current, BaseModel):
        return [field.alias or name for name, field in current.model_fields.items()]
    return []


def _tagged(annotation: Any, tag: str) -> Any:
    """The member of a union that bears a tag, None where there is none."""
    if any(isinstance(entry, Tag) and entry.tag == tag for entry in getattr(annotation, "__metadata__", ())):
        return annotation
    found = (_tagged(argument, tag) for argument in getattr(annotation, "__args__", ()))
    return next((member for member in found if member is not None), None)


def _inner_model(annotation: Any) -> Any:
    """The first file model inside a container annotation, or the annotation itself."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    for argument in getattr(annotation, "__args__", ()):
        inner = _inner_model(argument)
        if isinstance(inner, type) and issubclass(inner, BaseModel):
            return inner
    return annotation


def real_path(path: Path) -> Path:
    """The absolute path without links; of links that go round in a circle, as far as that goes.

    `Path.resolve` raises a RuntimeError there in some versions of Python; whoever opens the file is told.
    """
    return Path(os.path.realpath(path))


def resolve_beside(source: Path, relative: str, field: str, *, beside: Path | None = None) -> Path:
    """Path named inside the file `source`, which must stay where that file may look.

    Args:
        source: the file that a person gave.
        relative: the path that it names, or that a file which it names does.
        field: where it is named, for error messages.
        beside: the file from whose folder the path counts, where that is not `source`.

    Raises:
        InputError: for an absolute path, or one that leads elsewhere, be it by `..` or by a link.
    """
    try:
        target = real_path(real_path(beside or source).parent / relative)
        if target.is_symlink():
            raise OSError(errno.ELOOP, os.strerror(errno.ELOOP))
        folders = folders_open_to(source)
    except (OSError, ValueError):  # a circle of links, a null character
        raise InputError(source, field, f"{relative!r} is not the path of a file") from None
    if Path(relative).is_absolute() or not any(target.is_relative_to(folder) for folder in folders):
        raise InputError(
            source,
            field,
            f"{relative!r} must be a path below the folder of this file, or below the current folder or "
            f"{ROOT_VARIABLE} if this file is below it too",
        )
    return target


def folders_open_to(source: Path) -> list[Path]:
    """The folders below which the files named in `source` may lie.

    They are its own folder, and of the current folder and the one that $HOLDFAST_ROOT names those that it
    lies below. So a file that came from elsewhere reaches nothing of the user's; nor does one below a current
    folder that holds everything, such as the home folder.

    Raises:
        InputError: $HOLDFAST_ROOT names no folder.
    """
    own = real_path(source).parent
    try:
        current = real_path(Path.cwd())
        wider = [] if _holds_everything(current) else [current]
    except FileNotFoundError:  # it was removed
        wider = []
    if named := os.environ.get(ROOT_VARIABLE):
        if not Path(named).is_dir():
            raise InputError(ROOT_VARIABLE, "", f"there is no folder {named!r}")
        wider.append(real_path(Path(named)))
    return [own, *(folder for folder in wider if own.is_relative_to(folder))]


def _holds_everything(folder: Path) -> bool:
    """Whether a folder is the home folder, or one above it, or that of the whole file system."""
    try:
        home = real_path(Path.home())
    except RuntimeError:  # the user has none
        return folder == folder.parent
    return folder == folder.parent or home.is_relative_to(folder)


def read_json(path: Path) -> dict[str, Any]:
    """Reads a JSON file that holds an object.

    Raises:
        InputError: no such file, too large, not UTF-8, not JSON (NaN is not), a key twice, or not an object.
    """
    data = read_json_value(path)
    if not isinstance(data, dict):
        raise InputError(path, "", "must be a JSON object")
    return data


def read_json_value(path: Path, *, not_numbers: bool = False) -> Any:
    """Reads a JSON file, whatever value it holds.

    Args:
        path: the file.
        not_numbers: whether NaN and Infinity are read, as Python writes them, for a reader that refuses them
            where they matter.

    Raises:
        InputError: no such file, too large, not UTF-8, not JSON, or a key twice.
    """
    text = read_text(path, _LARGEST_JSON_BYTES)
    if sum(map(text.count, "[{,")) > _MOST_JSON_VALUES:
        raise InputError(path, "", f"holds more than {_MOST_JSON_VALUES} values")
    if not text.strip():
        raise InputError(path, "", "is empty, and no JSON")
    constant = float if not_numbers else _refuse
    try:
        return json.loads(text, object_pairs_hook=_unique, parse_constant=constant)
    except json.JSONDecodeError as error:
        raise InputError(path, f"line {error.lineno}", f"not valid JSON: {error.msg}") from None
    except RecursionError:
        raise InputError(path, "", "nested too deeply") from None
    except ValueError as error:  # from the two hooks, and integers of thousands of digits
        raise InputError(path, "", f"not valid JSON: {error}") from None


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    data: dict[str, Any] = {}
    for key, value in pairs:
        if key in data:
            raise ValueError(f"{key!r} stands twice")
        data[key] = value
    return data


def _refuse(constant: str) -> Any:
    raise ValueError(f"{constant} is not a number that JSON has")


def cache_folder() -> Path:
    """Folder for what can be computed again: $HOLDFAST_CACHE, or the user's cache folder."""
    return Path(os.environ.get("HOLDFAST_CACHE") or platformdirs.user_cache_dir("holdfast"))
