"""`holdfast query FILE SQL`."""

import argparse
import json
from pathlib import Path
from typing import Any

from .....base.text.console import emit, emit_json, format_table
from ....database import query_table

__all__ = ["main"]

_WIDEST = 60


def main(arguments: argparse.Namespace) -> int:
    """Prints the answer of a question to a table of grasps; 4 where it is empty."""
    most = None if arguments.json else arguments.most
    answer = query_table(Path(arguments.file), arguments.sql, most=most)
    if arguments.json:
        emit_json(arguments.json, {"columns": answer.names, "rows": answer.rows})
    if arguments.json != "-":
        shown = answer.rows[: arguments.most]
        emit(format_table(answer.names, [[_cell(value) for value in row] for row in shown]))
        if answer.more or len(shown) < len(answer.rows):
            emit(f"and more: --most prints more than {arguments.most} rows")
    return 0 if answer.rows else 4


def _cell(value: Any) -> str:
    if value is None:
        return "-"
    if isinstance(value, float):
        text = f"{value:.6g}"
    else:
        text = value if isinstance(value, str) else json.dumps(value)
    return text if len(text) <= _WIDEST else f"{text[: _WIDEST - 3]}..."
