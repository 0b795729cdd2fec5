"""Files as checked values."""

from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ConfigDict, Tag, ValidationError

from ...errors import InputError, suggest

__all__ = ["FileModel", "parse"]


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
