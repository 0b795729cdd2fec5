"""Built-in objects, and objects by path."""

from pathlib import Path

from ..library import Library
from .families import family_object, is_family
from .object_file import read_object
from .object_model import ObjectModel

__all__ = ["builtin_objects", "load_object"]

_LIBRARY = Library(__package__, "object", read_object)


def builtin_objects() -> tuple[str, ...]:
    """Names of the built-in objects, sorted."""
    return _LIBRARY.names()


def load_object(name_or_path: str | Path, *, source: str = "object", field: str = "") -> ObjectModel:
    """Loads a built-in object by name, a member of a family, or an object file by path (.yaml, .yml).

    Args:
        name_or_path: a name from `builtin_objects()`, `family:<family>:<seed>`, or a path that ends in .yaml
            or .yml.
        source: what asked for the object, for the error message.
        field: field of `source` that names the object.

    Raises:
        InputError: no such object, or a file that can't be used.
    """
    text = str(name_or_path)
    if is_family(text):
        return family_object(text, source=source, field=field)
    return _LIBRARY.load(text, source, field)
