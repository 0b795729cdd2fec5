"""Reading untrusted input files and writing whole ones."""

import json
import os
import tempfile
from pathlib import Path
from typing import Any, TypeVar

import yaml
from pydantic import BaseModel, ConfigDict, ValidationError

from .errors import InputError, suggest

__all__ = ["FileModel", "parse", "read_yaml", "resolve_beside", "write_json", "write_text"]

# Aliases make a small YAML file expand without bound, so a file may be this long and no longer.
_MAX_BYTES = 32 * 1024 * 1024
_TAGS = ("named", "inline")


class FileModel(BaseModel):
    """Base of the models that describe files: unknown fields are errors, numbers are finite."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False, frozen=True)


ModelT = TypeVar("ModelT", bound=FileModel)


class _Loader(yaml.CSafeLoader if hasattr(yaml, "CSafeLoader") else yaml.SafeLoader):  # type: ignore[misc]
    """A safe loader that refuses duplicate keys and aliases."""

    def compose_node(self, parent: Any, index: Any) -> Any:
        if self.check_event(yaml.AliasEvent):
            event = self.peek_event()
            raise yaml.constructor.ConstructorError(
                None, None, "aliases (*name) are not accepted", event.start_mark
            )
        return super().compose_node(parent, index)

    def construct_mapping(self, node: Any, deep: bool = False) -> Any:
        seen = set()
        for key_node, _ in node.value:
            key = key_node.value
            if key in seen:
                raise yaml.constructor.ConstructorError(
                    None, None, f"{key!r} stands twice", key_node.start_mark
                )
            seen.add(key)
        return super().construct_mapping(node, deep)


def read_yaml(path: Path) -> dict[str, Any]:
    """Reads a YAML file that holds a mapping.

    Raises:
        InputError: no such file, too large, not UTF-8, not YAML, or not a mapping.
    """
    try:
        if path.stat().st_size > _MAX_BYTES:
            raise InputError(path, "", f"larger than {_MAX_BYTES} bytes")
        text = path.read_text("utf-8")
    except UnicodeDecodeError:
        raise InputError(path, "", "not a UTF-8 text file") from None
    except OSError as error:
        raise InputError(path, "", error.strerror or "can't be read") from None
    try:
        data = yaml.load(text, Loader=_Loader)  # noqa: S506  _Loader is a safe loader
    except RecursionError:
        raise InputError(path, "", "nested too deeply") from None
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        line = f"line {mark.line + 1}" if mark else ""
        raise InputError(path, line, f"not valid YAML: {getattr(error, 'problem', None) or error}") from None
    except ValueError as error:  # such as a date that does not exist
        raise InputError(path, "", f"not valid YAML: {error}") from None
    if not isinstance(data, dict):
        raise InputError(path, "", "must be a mapping of fields, such as `name: ...`")
    return data


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
        # Tags of unions ("named", "inline") are ours, not the user's.
        loc = tuple(part for part in first["loc"] if part not in _TAGS)
        field = ".".join(str(part) for part in loc)
        if first["type"] == "extra_forbidden":
            known = _fields_at(model, first["loc"][:-1])
            raise InputError(source, field, f"unknown field{suggest(str(first['loc'][-1]), known)}") from None
        raise InputError(source, field, _plain(first)) from None


def _plain(entry: Any) -> str:
    message = str(entry["msg"]).removeprefix("Value error, ")
    if entry["type"] == "missing":
        return "is required"
    value = repr(entry.get("input"))
    shown = f", not {value}" if len(value) <= 60 and entry["type"] != "value_error" else ""
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
    base = source.resolve().parent
    target = (base / relative).resolve()
    if Path(relative).is_absolute() or not target.is_relative_to(base):
        raise InputError(source, field, f"{relative!r} must be a path below the folder of this file")
    return target


def write_text(path: Path, text: str) -> None:
    """Writes a file whole or not at all: into a temporary neighbour, then renamed."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        # mkstemp makes the file private; a result should be as readable as any other new file.
        umask = os.umask(0)
        os.umask(umask)
        os.chmod(temporary, 0o666 & ~umask)
        os.replace(temporary, path)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise


def write_json(path: Path, data: Any) -> None:
    """Writes JSON whole or not at all; NaN and infinity are refused."""
    write_text(path, json.dumps(data, indent=1, allow_nan=False) + "\n")
