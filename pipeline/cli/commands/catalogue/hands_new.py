"""`holdfast hands new FILE`."""

import argparse
from pathlib import Path

from .....base.files.library import FILE_SUFFIXES
from .....base.files.output_file import write_text
from .....base.machine.backend import configure
from .....base.text.console import emit
from .....errors import InputError
from .....hands import new_hand_file

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
