"""`holdfast check FILE [--row N]`."""

import argparse
from dataclasses import asdict
from pathlib import Path

from .....base.text.console import emit, emit_json, format_table
from .....errors import InputError
from ....database import Row, checked_rows, find_row, replay_row

__all__ = ["main"]

_AGREES, _DIFFERS = 0, 4
# Damaged rows that are named one by one.
_NAMED = 20


def main(arguments: argparse.Namespace) -> int:
    """Tries a row again, or looks whether all rows are whole; 4 where something differs or is damaged."""
    path = Path(arguments.file)
    if arguments.row is None:
        if arguments.task:
            raise InputError("check", "--task", "goes with --row")
        return _check_all(arguments, path)
    row = find_row(path, arguments.row)
    found = replay_row(row, path, arguments.task)
    if arguments.json:
        findings = [asdict(finding) for finding in found.findings]
        data = {"row": row.number, "grasp": row.grasp.id, "agrees": found.agrees, "findings": findings}
        emit_json(arguments.json, data)
    if arguments.json != "-":
        rows = [
            (entry.what, entry.written, entry.now, "yes" if entry.agrees else "NO")
            for entry in found.findings
        ]
        differing = [entry.what for entry in found.findings if not entry.agrees]
        verdict = f"differs in {', '.join(differing)}" if differing else "as it says"
        emit(f"row {row.number}, {row.head.task} {row.grasp.id}: {verdict}\n")
        emit(format_table(("what", "row", "now", "agrees"), rows))
    return _AGREES if found.agrees else _DIFFERS


def _check_all(arguments: argparse.Namespace, path: Path) -> int:
    whole, damaged = 0, list[str]()
    for row in checked_rows(path):
        if isinstance(row, Row):
            whole += 1
        else:
            damaged.append(row)
    if arguments.json:
        emit_json(arguments.json, {"whole": whole, "damaged": damaged})
    if arguments.json != "-":
        for words in damaged[:_NAMED]:
            emit(words)
        if len(damaged) > _NAMED:
            emit(f"and {len(damaged) - _NAMED} more")
        emit(f"{path}: {whole} rows are whole, {len(damaged)} damaged")
    return _DIFFERS if damaged else _AGREES
