"""`holdfast hold GRASP`."""

import argparse
from math import degrees

from ..backend import configure
from ..output import format_table
from ..records import GraspFile

__all__ = ["main"]


def main(arguments: argparse.Namespace) -> int:
    """Squeezes a grasp as it is, holds it against gravity, and says what happened in each direction."""
    configure()
    from ...mjcf import HoldSettings
    from ..stages import hold_grasp
    from ._grasp import finish, load

    loaded = load(arguments)
    record, _ = hold_grasp(loaded.record, loaded.configuration, HoldSettings())
    finish(arguments, record, _table(record))
    return 0 if record.is_held else 4


def _table(record: GraspFile) -> str:
    hold = record.hold
    assert hold is not None
    verdict = "held" if hold.held else "not held"
    if not hold.directions:
        return f"{record.id}: {verdict}: {hold.reason}"
    rows = [
        (
            " ".join(f"{x:+.1f}" for x in direction.gravity),
            direction.outcome,
            f"{1e3 * direction.slip:.3f}" if direction.slip is not None else "-",
            f"{degrees(direction.rotation):.3f}" if direction.rotation is not None else "-",
        )
        for direction in hold.directions
    ]
    table = format_table(("gravity/(m/s2)", "outcome", "slip/mm", "turn/deg"), rows)
    return f"{record.id}: {verdict} in {hold.held_count} of {len(hold.directions)} directions\n\n{table}"
