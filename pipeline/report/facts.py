"""Tables and charts of a report beside its cards: what a run, its task and its object come to in numbers."""

from dataclasses import fields
from math import degrees

import numpy as np

from ...base.text.plain_text import counted
from ...mjcf import HoldSettings, Quality, auc
from ...objects import Task
from ..records import GraspRecord, RunRecord
from .bars import Bars, bar_chart
from .cards import Card
from .formats import fixed
from .why import is_untried

__all__ = [
    "counts",
    "creep_budget",
    "limits",
    "margins",
    "measures",
    "object_figures",
    "soft_patch",
    "times",
]

_LARGEST_PATCH_M = 10.0


def counts(record: RunRecord, passed: str) -> list[tuple[str, int]]:
    """How many grasps came how far."""
    grasps = record.grasps
    untested = sum(grasp.is_untested for grasp in grasps)
    narrow = sum(grasp.is_narrow for grasp in grasps)
    unreachable = sum(grasp.is_unreachable for grasp in grasps)
    missed = sum(grasp.is_near_miss for grasp in grasps)
    return [
        *([] if record.solve is None else [("solved", record.solve.solved)]),
        ("tried", sum(not is_untried(grasp) for grasp in grasps)),
        ("certified", sum(grasp.certified for grasp in grasps)),
        ("clear", sum(grasp.is_clear for grasp in grasps)),
        (passed, sum(grasp.is_held for grasp in grasps)),
        *([("narrowly", narrow)] if narrow else []),
        *([("near misses", missed)] if missed else []),
        *([("unreachable", unreachable)] if unreachable else []),
        *([("not tested", untested)] if untested else []),
    ]


def limits(task: Task) -> list[tuple[str, str, str, bool]]:
    """Name, limits with units, and whether they are narrower than the hand's own, by independent joint."""
    axes = {axis.name: axis for link in task.hand.links for axis in link.axes}
    found = []
    for name, (lower, upper) in zip(task.hand.independent_names, task.limits, strict=True):
        axis = axes[name]
        is_own = bool(lower > axis.lower + 1e-9 or upper < axis.upper - 1e-9)
        if axis.kind == "prismatic":
            words = [f"{fixed(1e3 * value, 1)} mm" for value in (lower, upper)]
        else:
            words = [f"{fixed(degrees(value), 1)}°" for value in (lower, upper)]
        found.append((name.replace("_", " "), words[0], words[1], is_own))
    return found


def creep_budget(grasp: GraspRecord) -> float | None:
    """The pace in m/s that a slip may have at the end of the test; None where the record says nothing."""
    budget = grasp.hold.settings.get("creep_budget_m_s") if grasp.hold else None
    return budget if isinstance(budget, float) else None


def measures(record: RunRecord) -> list[tuple[str, float | None]]:
    """Analytic measures of the grasps that came to a test, each with its AUC against the outcome."""
    names = [f.name for f in fields(Quality)]
    grasps = [g for g in record.grasps if g.hold is not None and g.quality.keys() >= set(names)]
    if not grasps:  # nothing is measured before every verdict is known, and in quick runs not at all
        return []
    held = np.array([grasp.is_held for grasp in grasps], dtype=bool)
    return [(name, auc(np.array([grasp.quality[name] for grasp in grasps]), held)) for name in names]


def margins(record: RunRecord, cards: dict[str, Card]) -> Bars | None:
    """A bar for the margin of each grasp that has one."""
    looks = {"good": "good", "narrow": "fair", "uncertain": "fair"}
    rows = [
        (grasp.id, hold.margin, f"{hold.margin:.2f}", looks.get(cards[grasp.id].look, ""))
        for grasp in record.grasps
        if (hold := grasp.hold) is not None and hold.margin is not None
    ]
    return bar_chart(rows, mark=(1.0, "the load"))


def times(record: RunRecord) -> Bars | None:
    """A bar for the seconds of each stage."""
    total = sum(record.seconds.values())
    return bar_chart(
        [
            (name, seconds, f"{seconds:.1f} s, {100 * seconds / total:.0f} %", "")
            for name, seconds in record.seconds.items()
            if total > 0.0
        ]
    )


def object_figures(task: Task) -> list[tuple[str, str, str]]:
    """Name, value and source of the object's numbers."""
    obj = task.object
    extents = " × ".join(f"{1e3 * side:.1f}" for side in obj.mesh.extents)
    inflation = max(part.inflation for part in obj.parts)
    pieces = counted(len(obj.pieces), "convex piece")
    values = {
        "shape": f"{extents} mm, {pieces} ({100 * inflation:.1f} % inflation)",
        "mass": f"{1e3 * obj.inertia.mass:.1f} g",
        "friction": f"{obj.friction:g}",
    }
    named = [(name, value, obj.sources.get(name, "the object file")) for name, value in values.items()]
    return named + [(name, "", source) for name, source in obj.sources.items() if name not in values]


def soft_patch(record: RunRecord, task: Task) -> tuple[float, float] | None:
    """Radius in m of the patch that all contacts are assumed to have, and torque in N m it resists per N.

    None where the hand's pads decide, or the record says nothing sane.
    """
    radius = record.settings.get("hold.patch_radius_m")
    friction = record.settings.get("hold.friction")
    if not isinstance(radius, float) or not 0.0 < radius < _LARGEST_PATCH_M:
        return None
    settings = HoldSettings(
        friction=friction if isinstance(friction, float) and friction > 0.0 else None, patch_radius_m=radius
    )
    return radius, settings.torsional_friction(task.object)
