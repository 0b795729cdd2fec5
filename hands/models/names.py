"""Names of links and joints: the model's, unless the hand file gives new ones."""

import re

from ...errors import InputError, UnknownName

__all__ = ["new_names", "plain_name"]

_NOT_IN_NAMES = re.compile(r"[^A-Za-z0-9_.-]")


def new_names(
    field: str,
    new: dict[str, str],
    known: list[str],
    kept: list[int],
    source: str,
    *,
    has_world: bool = False,
) -> dict[int, str]:
    """Names by number, new or the model's own, no two of them alike.

    Args:
        field: of the hand file, with the new names.
        new: these, by the model's.
        known: the model's names.
        kept: numbers of those that the hand has.
        source: the file, for error messages.
        has_world: whether the palm is the world, which is then called `palm` unless it has a new name.

    Raises:
        InputError: an unknown name, or one that stands twice.
    """
    for name in new:
        if name not in [known[i] for i in kept]:
            what = "body" if field == "link_names" else "joint"
            raise UnknownName(source, f"{field}.{name}", what, name, [known[i] for i in kept])
    what = field.removesuffix("_names")
    names = {i: new.get(known[i]) or _readable(known[i]) or f"{what}_{i}" for i in kept}
    if has_world and "world" not in new:
        names[0] = "palm"
    for i, name in names.items():
        if name == "world" or list(names.values()).count(name) > 1:
            raise InputError(
                source,
                f"{field}.{known[i]}",
                f"{name!r} is reserved or stands twice: give it a new name",
            )
    return names


def _readable(name: str) -> str:
    """`plain_name`; empty where nothing would be left of it, as of words in another script."""
    plain = plain_name(name)
    return plain if plain.strip("_") else ""


def plain_name(name: str) -> str:
    """A model's name with `_` for signs that names here do not have, such as in `robot0:palm`."""
    return _NOT_IN_NAMES.sub("_", name).lstrip(".-")[:64] or "_"
