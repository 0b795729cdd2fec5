"""Faces of rooms that import what is asked for only then."""

from collections.abc import Callable, Mapping, MutableMapping, Sequence
from importlib import import_module
from typing import Any

__all__ = ["late_names"]


def late_names(
    face: MutableMapping[str, Any], homes: Mapping[str, Sequence[str]]
) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """What a face needs as `__getattr__` and `__dir__`, so that its modules are imported late.

    Args:
        face: `globals()` of the room's `__init__.py`; what was asked for once is kept there.
        homes: names by the module of the room in which they are defined.
    """
    home_of = {name: home for home, names in homes.items() for name in names}
    room = face["__name__"]

    def find(name: str) -> Any:
        if name not in home_of:
            raise AttributeError(f"module {room!r} has no attribute {name!r}")
        face[name] = getattr(import_module(f".{home_of[name]}", room), name)
        return face[name]

    return find, lambda: sorted({*face, *home_of})
