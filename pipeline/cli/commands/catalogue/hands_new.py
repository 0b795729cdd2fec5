"""`holdfast hands new FILE`."""

import argparse
from pathlib import Path

from .....backend import configure
from .....console import emit
from .....errors import InputError
from .....files import write_text
from .....hands import new_hand_file
from .....library import FILE_SUFFIXES

__all__ = ["main"]


def main(arguments: argparse.Namespace) -> int:
    """Writes a hand file to edit, and prints its path."""
    configure()
    path = Path(arguments.file)
    if not arguments.file.endswith(FILE_SUFFIXES):
        raise InputError("hands new", "FILE", f"ends in .yaml or .yml, as {arguments.file!r} does not")
    if path.exists() and not arguments.force:
        raise InputError(path, "", "is there already; --force writes over it")
    write_text(path, new_hand_file(path, arguments.model, mirror=arguments.mirror))
    emit(str(path))
    return 0
