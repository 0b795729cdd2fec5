"""What `holdfast tasks`, `holdfast hands` and `holdfast objects` have in common."""

import argparse
from pathlib import Path

from .....base.text.console import emit, emit_json, format_table
from .....errors import InputError
from ...catalogue import entries, find_entry, head_comment

__all__ = ["list_or_show"]

_FAMILY_ROW = (
    "family:FAMILY:SEED",
    "any number of others, such as family:mug:17; families: bottle, box, cylinder, handle, mug, plate",
)


def list_or_show(kind: str, arguments: argparse.Namespace) -> int:
    """Lists what is built in of a kind, or shows one thing in full."""
    name: str | None = arguments.name
    for option in ("mjcf", "mirror") if name is None and kind == "hand" else ():
        if getattr(arguments, option):
            raise InputError("hands", f"--{option}", "needs the NAME of a hand")
    if name is None:
        _list(kind, arguments.json)
        return 0
    # Late: a list needs names alone, and to load hands and objects takes half a second.
    if kind == "hand" and arguments.mjcf:
        _write_hand(name, Path(arguments.mjcf), mirror=arguments.mirror)
    else:
        from ._details import details, details_data

        if arguments.json:
            emit_json(arguments.json, details_data(kind, name, arguments))
        if arguments.json != "-":
            emit("\n".join(details(kind, name, arguments)))
    return 0


def _list(kind: str, json: str | None) -> None:
    found = entries(kind)
    if json:
        emit_json(json, [{"name": e.name, "description": e.description, "file": str(e.path)} for e in found])
    if json != "-":
        rows = [(e.name, e.description) for e in found]
        emit(format_table(("name", "description"), rows + ([] if kind == "hand" else [_FAMILY_ROW])))


def _write_hand(name: str, folder: Path, *, mirror: bool) -> None:
    """Writes the folder of a hand by its name or path, or of its mirror image, and prints the paths.

    Raises:
        InputError: no such hand, or a name in it that a model can't carry.
    """
    from .....base.machine.backend import configure
    from .....hands import HAND_SUFFIXES, load_hand, mirrored
    from .....mjcf.hand_folder import export_hand

    configure()
    hand = load_hand(name)
    if mirror:
        hand = mirrored(hand)
    source = Path(name) if name.lower().endswith(HAND_SUFFIXES) else find_entry("hand", name).path
    for path in export_hand(hand, folder, sources=head_comment(source)):
        emit(str(path))
