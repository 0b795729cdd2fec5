"""`dataset.json`: what a data set is, in one file that says how everything else is to be read."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from ... import __version__
from ...hands import load_hand
from ...mjcf import HoldSettings
from ..choice import CONDITIONS, SCHEMA_VERSION, SPLITS, ChoiceData
from ..records import fingerprint
from .part import Part
from .plan import DatasetPlan

__all__ = ["head_of"]


def head_of(
    data: ChoiceData, parts: Sequence[Part], plan: DatasetPlan, *, licence: str, command: str
) -> dict[str, Any]:
    """What `dataset.json` says.

    Args:
        data: the arrays.
        parts: all parts, those without candidates too.
        plan: what was asked for.
        licence: of the data.
        command: by which it was made.
    """
    refused: Counter[str] = Counter()
    for part in parts:
        refused.update(part.refused)
    return {
        "schema_version": SCHEMA_VERSION,
        "holdfast": __version__,
        "licence": licence,
        "command": command,
        "seed": plan.seed,
        "families": list(plan.families) if plan.objects else [],
        "hands": [_hand(hand) for hand in plan.hands],
        "counts": {
            "situations": len(parts),
            "groups": data.group_count,
            "objects": len(data.object_ids),
            "candidates": len(data),
            "outcomes": int(data.held.size),
            "refused": dict(sorted(refused.items())),
        },
        "splits": {
            name: {part: int((values == part).sum()) for part in SPLITS}
            for name, values in data.splits.items()
        },
        "candidates": plan.candidates,
        "draws": plan.draws,
        "draw_ranges": plan.ranges.as_record(),
        "loads": list(plan.loads),
        "settings": asdict(HoldSettings()),
        "features": [feature.as_record() for feature in data.feature_specs],
        "object_features": [feature.as_record() for feature in data.object_specs],
        "formulas": data.formulas,
        "conditions": [{"name": name, "unit": unit, "words": words} for name, unit, words in CONDITIONS],
    }


def _hand(reference: str) -> dict[str, Any]:
    hand = load_hand(reference)
    # Of a file its name alone: where it lies is nobody's business.
    return {
        "name": hand.name,
        "reference": Path(reference).name,
        "hash": fingerprint(hand),
        "joints": list(hand.independent_names),
    }
