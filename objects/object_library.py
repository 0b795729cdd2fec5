"""Built-in objects, and objects by path."""

from functools import cache
from importlib.resources import files
from pathlib import Path

from ..errors import UnknownName
from .object_file import read_object
from .object_model import ObjectModel

__all__ = ["builtin_objects", "load_object"]


def _folder() -> Path:
    return Path(str(files(__package__))) / "data"


def builtin_objects() -> tuple[str, ...]:
    """Names of the built-in objects, sorted."""
    return tuple(sorted(path.stem for path in _folder().glob("*.yaml")))


@cache
def _builtin(name: str) -> ObjectModel:
    return read_object(_folder() / f"{name}.yaml")


def load_object(name_or_path: str | Path, *, source: str = "object", field: str = "") -> ObjectModel:
    """Loads a built-in object by name, or an object file by path (.yaml, .yml).

    Args:
        name_or_path: a name from `builtin_objects()`, or a path that ends in .yaml or .yml.
        source: what asked for the object, for the error message.
        field: field of `source` that names the object.

    Raises:
        InputError: no such object, or a file that can't be used.
    """
    text = str(name_or_path)
    if text.endswith((".yaml", ".yml")):
        return read_object(Path(text))
    if text not in builtin_objects():
        raise UnknownName(source, field, "object", text, builtin_objects())
    return _builtin(text)
