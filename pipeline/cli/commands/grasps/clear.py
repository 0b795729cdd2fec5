"""`holdfast clear GRASP`."""

import argparse

from .....base.machine.backend import configure
from .....base.text.console import format_table
from .....grasping import clear
from .....mjcf import HoldSettings
from .....retraction import ClearanceComparison, PairClearance, RetractionSettings
from ....report import describe
from ....run import proved, with_clearing
from .._grasp import finish, load

__all__ = ["main"]

# Pairs that are shown unless all are asked for.
_SHOWN = 12


def main(arguments: argparse.Namespace) -> int:
    """Frees a grasp of penetration, and shows how near each pair of bodies is then, by FCL and by MuJoCo."""
    configure()
    loaded = load(arguments)
    clearing = clear(loaded.configuration, retraction=RetractionSettings(margin_m=arguments.clearance))
    record = with_clearing(loaded.record, clearing)
    if arguments.out or arguments.json:
        record = proved(record, loaded.configuration.task, HoldSettings(), loaded.path)
    table = _table(clearing.comparison, everything=arguments.every_pair)
    finish(arguments, record, f"{describe(record)}\n\n{table}")
    return 0 if clearing.is_clear else 4


def _table(comparison: ClearanceComparison, *, everything: bool) -> str:
    """The pairs, nearest first, with what the two libraries say."""
    differing = {(ours.a, ours.b) for ours, _ in comparison.differing}
    pairs = sorted(
        zip(comparison.fcl.pairs, comparison.mujoco.pairs, strict=True), key=lambda pair: pair[0].distance_m
    )
    shown = pairs if everything else pairs[:_SHOWN]
    rows = [
        (
            ours.a,
            ours.b,
            "contact" if ours.intended else "apart",
            f"{1e3 * ours.distance_m:.4f}",
            f"{1e3 * theirs.distance_m:.4f}",
            _note(ours, (ours.a, ours.b) in differing),
        )
        for ours, theirs in shown
    ]
    table = format_table(("link", "body", "should be", "FCL/mm", "MuJoCo/mm", "note"), rows)
    rest = len(pairs) - len(shown)
    if rest:
        table += f"\nand {rest} pairs that are further apart; --every-pair shows them"
    agree = f"FCL and MuJoCo differ on {len(differing)} of" if differing else "FCL and MuJoCo agree on all"
    return f"{table}\n{agree} {len(pairs)} pairs"


def _note(pair: PairClearance, differs: bool) -> str:
    notes = []
    if not pair.is_clear:
        notes.append("too deep" if pair.distance_m < 0.0 else "too near")
    elif pair.intended and not pair.touches:
        notes.append("does not touch")
    if differs:
        notes.append("the two differ")
    return ", ".join(notes)
