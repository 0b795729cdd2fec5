"""Reading untrusted input files and writing whole ones."""

import json
import os
import secrets
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

from .errors import InputError, suggest
from .yaml_file import read_yaml

__all__ = ["FileModel", "parse", "read_yaml", "resolve_beside", "write_json", "write_text"]


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
    parts = [str(part) for part in loc if part != "[key]"]
    return ".".join(part for part in parts if not (part.startswith("<") and part.endswith(">")))


def _plain(entry: Any) -> str:
    """Pydantic's message in the manner of ours, with the value where it is short."""
    message = str(entry["msg"]).removeprefix("Value error, ")
    if entry["type"] == "missing":
        return "is required"
    value = entry.get("input")
    is_scalar = value is None or isinstance(value, (str, int, float))
    shown = f", not {value!r}" if is_scalar and len(repr(value)) <= 60 else ""
    return message[0].lower() + message[1:] + shown


def _fields_at(model: type[BaseModel], loc: tuple[Any, ...]) -> list[str]:
    """Field names of the nested model at `loc`, found through the annotations."""
    current: Any = model
    for part in loc:
        if isinstance(current, type) and issubclass(current, BaseModel) and part in current.model_fields:
            current = current.model_fields[part].annotation
        current = _inner_model(current)
    if isinstance(current, type) and issubclass(current, BaseModel):
        return [field.alias or name for name, field in current.model_fields.items()]
    return []


def _inner_model(annotation: Any) -> Any:
    """The first file model inside a container annotation, or the annotation itself."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    for argument in getattr(annotation, "__args__", ()):
        inner = _inner_model(argument)
        if isinstance(inner, type) and issubclass(inner, BaseModel):
            return inner
    return annotation


def resolve_beside(source: Path, relative: str, field: str) -> Path:
    """Path named inside the file `source`, which must stay at or below that file's folder.

    Raises:
        InputError: for an absolute path or one that leaves the folder.
    """
    try:
        base = source.resolve().parent
        target = (base / relative).resolve()
    except (OSError, RuntimeError, ValueError):  # a loop of links, a null character
        raise InputError(source, field, f"{relative!r} is not the path of a file") from None
    if Path(relative).is_absolute() or not target.is_relative_to(base):
        raise InputError(source, field, f"{relative!r} must be a path below the folder of this file")
    return target


def write_text(path: Path, text: str) -> None:
    """Writes a file whole or not at all: into a temporary neighbour, then renamed."""
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.name}.{os.getpid()}.{secrets.token_hex(4)}")
    try:
        with temporary.open("x", encoding="utf-8") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def write_json(path: Path, data: Any) -> None:
    """Writes JSON whole or not at all; NaN and infinity are refused."""
    write_text(path, json.dumps(data, indent=1, allow_nan=False) + "\n")
