"""Paths of clients lead nowhere but below the served folder."""

from pathlib import Path, PurePosixPath

from ...base.files.file_paths import real_path
from ...errors import InputError

__all__ = ["check_inside"]


def check_inside(folder: Path, name: str, source: str, field: str) -> Path:
    """The place that a name would be read from: where it is a path, one below `folder`.

    Args:
        folder: the served folder.
        name: a path, or the name of something built in, perhaps with `@` and a hand.
        source: of the request, for the message.
        field: in it.

    Raises:
        InputError: it is absolute, has `..` in it, or leads elsewhere by a link.
    """
    places = []
    for part in name.split("@"):
        path = PurePosixPath(part)
        if path.is_absolute() or ".." in path.parts or "\\" in part or "~" in part:
            raise _outside(source, field, name)
        try:
            places.append(real_path(folder / part))
        except (OSError, ValueError):
            raise _outside(source, field, name) from None
    if not all(place.is_relative_to(real_path(folder)) for place in places):
        raise _outside(source, field, name)
    return places[0]


def _outside(source: str, field: str, name: str) -> InputError:
    return InputError(source, field, f"must be a name, or a path below the served folder, not {name[:80]!r}")
