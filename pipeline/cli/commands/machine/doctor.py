"""`holdfast doctor`."""

import argparse

from .....base.text.console import emit, emit_json, format_table
from ._findings import State, findings

__all__ = ["main"]

_WELL, _ILL = 0, 4


def main(arguments: argparse.Namespace) -> int:
    """Says what of this machine and installation counts; exit code 4 where something is wrong."""
    found = list(findings())
    wrong = [finding for finding in found if finding.state is State.WRONG]
    if arguments.json:
        rows = [{"name": f.name, "found": f.found, "state": f.state.value, "advice": f.advice} for f in found]
        emit_json(arguments.json, {"well": not wrong, "findings": rows})
    if arguments.json != "-":
        table = format_table(
            ("what", "found", "state", "what to do"),
            [(f.name, f.found, f.state.value, f.advice) for f in found],
        )
        verdict = f"{len(wrong)} things are wrong" if len(wrong) > 1 else "one thing is wrong"
        emit(f"{table}\n\n{verdict if wrong else 'all is well'}")
    return _ILL if wrong else _WELL
