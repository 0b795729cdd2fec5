"""`holdfast tasks`, `holdfast hands`, `holdfast objects`."""

import argparse
from pathlib import Path

from ....console import emit, format_table
from ....errors import InputError
from ..catalogue import entries

__all__ = ["main"]

_FAMILY_ROW = (
    "family:FAMILY:SEED",
    "any number of others, such as family:mug:17; families: bottle, box, cylinder, handle, mug, plate",
)


def main(arguments: argparse.Namespace) -> int:
    """Lists what is built in, or shows one thing in full."""
    kind, name = arguments.kind, arguments.name
    for option in ("mjcf", "mirror") if name is None and kind == "hand" else ():
        if getattr(arguments, option):
            raise InputError("hands", f"--{option}", "needs the NAME of a hand")
    if name is None:
        rows = [(e.name, e.description) for e in entries(kind)]
        emit(format_table(("name", "description"), rows + ([] if kind == "hand" else [_FAMILY_ROW])))
        return 0
    # Late: a list needs names alone, and to load hands and objects takes half a second.
    if kind == "hand" and arguments.mjcf:
        from ._hand_folder import write_hand

        write_hand(name, Path(arguments.mjcf), mirror=arguments.mirror)
    else:
        from ._details import details

        emit("\n".join(details(kind, name, arguments)))
    return 0
