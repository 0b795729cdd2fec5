"""`holdfast table RUN...`."""

import argparse
from datetime import UTC, datetime
from pathlib import Path

from .....base.files.output_file import write_json
from .....base.text.console import Console, emit
from .....base.text.plain_text import counted
from .....errors import InputError
from ....database import Collected, check_table_target, croissant, write_table

__all__ = ["main"]


def main(arguments: argparse.Namespace) -> int:
    """Writes the grasps of runs as one table; runs that can't be read are named, and the exit code is 4."""
    console, table = Console(quiet=arguments.quiet), Path(arguments.out)
    check_table_target(table)
    if arguments.croissant and table.suffix != ".parquet":
        raise InputError("table", "--croissant", "goes with a Parquet table")
    if arguments.licence and not arguments.croissant:
        raise InputError("table", "--licence", "goes with --croissant")
    collected = Collected([Path(name) for name in arguments.runs], table)
    write_table(collected, table)
    for words in collected.refused:
        console.say(f"left out: {words}")
    if arguments.croissant:
        today = datetime.now(UTC).date()
        about = croissant(
            table, name=table.stem, rows=collected.rows, published=today, licence=arguments.licence
        )
        write_json(Path(arguments.croissant), about)
    left = counted(len(collected.refused), "run")
    emit(f"{table}: {counted(collected.rows, 'grasp')} of {counted(collected.runs, 'run')}, {left} left out")
    return 4 if collected.refused else 0
