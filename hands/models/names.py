"""Names of links and joints: the model's, unless the hand file gives new ones."""

from ...base.files.fields import plain_name
from ...errors import InputError, UnknownName

__all__ = ["new_names"]


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
    names = {i: new.get(known[i]) or plain_name(known[i], f"{what}_{i}") for i in kept}
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
