"""The report: one HTML page that needs nothing else, neither files beside it nor a network."""

from dataclasses import fields
from functools import cache
from importlib.resources import files
from math import degrees
from pathlib import Path

import jinja2
import numpy as np
from markupsafe import Markup

from ...files import write_text
from ...mjcf import HoldSettings, Quality, auc, kind_of_test
from ...mjcf.hold import load_word, passed_word, verdict_word
from ...objects import Task, describe_test
from ...solver import pad_misfits
from ..records import GraspRecord, RunFolder, RunRecord
from .bars import Bars, bar_chart
from .cards import Card, make_card
from .charts import tree_chart
from .embed import embed_picture
from .formats import FILTERS, fixed, setting_name, setting_text, shown
from .pictures import VIEW_NAMES, task_path, view_path
from .policy import content_policy
from .reproduce import command_of, made_with, proof_commands
from .scene import scene_data, scene_text
from .style import report_style
from .text import proved
from .why import is_untried, run_advice, tally

__all__ = ["render_report", "write_report"]

_THUMBNAIL = (240, 180)
# So many grasps, the best ones, have a card, a picture and a place in the 3D view: a page of hundreds would
# take tens of megabytes.
_MOST_CARDS = 64
_LARGEST_PATCH_M = 10.0
# What holds where a setting of the hold test says nothing itself.
_BY_DEFAULT = {
    "hold.friction": "the object's",
    "hold.object_mass_kg": "the object's",
    "hold.patch_radius_m": "by the hand's pads",
}
_VERDICTS = {
    "held": "A grasp was found that is certified, clear and {passed}.",
    "not held": "Grasps were found, but none of them is certified, clear and {passed}.",
    "infeasible": "Proved infeasible: no configuration of the hand makes these contacts.",
    "friction": "Proved infeasible: no forces at the object's regions can hold the load with its friction.",
    "undecided": "Undecided: the budget ended before a grasp or a proof was found.",
    "untried": "Undecided: configurations were found, but the run ended before one of them was {passed}.",
}
# What the 3D view shows: name, words, whether at first.
_LAYERS = (
    ("regions", "contact regions", True),
    ("normals", "normals", False),
    ("cones", "friction cones", False),
    ("forces", "forces", False),
    ("pieces", "collision pieces", False),
    ("penetration", "penetration in red", True),
    ("through", "see through bodies", False),
    ("axes", "axes of the palm", False),
)
# Azimuth and elevation in degrees.
_SIDES = (
    ("front", "205,-18"),
    ("left", "295,-18"),
    ("back", "25,-18"),
    ("right", "115,-18"),
    ("top", "205,-80"),
)


def write_report(task: Task, record: RunRecord, folder: RunFolder, out: Path | None = None) -> None:
    """Writes the report of a run, with the pictures that lie in its folder."""
    page = out or folder.report_path
    write_text(page, render_report(task, record, folder.media, page=page))


def render_report(task: Task, record: RunRecord, media: Path, *, page: Path | None = None) -> str:
    """The report as HTML.

    Args:
        task: of the run.
        record: of the run.
        media: folder of its pictures; those that are missing are left out.
        page: where the page will lie, from which links to the grasps' files count; None for beside `media`.
    """
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("holdfast.pipeline.report"),
        autoescape=True,  # names come from files that anyone may have written
        finalize=shown,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= FILTERS
    style, library = report_style(), _template("three.min.js")
    scripts = [_template("table.js"), _template("viewer.js")]
    best = record.grasps[0] if record.grasps else None
    kind = kind_of_test(task)
    passed = passed_word(kind)
    page = page or media.parent / "report.html"
    cards = {
        grasp.id: make_card(grasp, task, kind, media, page, best=grasp is best, enough=record.has_enough)
        for grasp in record.grasps
    }
    detailed = record.grasps[:_MOST_CARDS]
    scene = scene_data(task, record.model_copy(update={"grasps": detailed}), media.parent)
    return environment.get_template("report.html.j2").render(
        style=Markup(style),
        scripts=[Markup(script) for script in scripts],
        library=Markup(library),
        policy=content_policy([style], [library, *scripts]),
        scene=Markup(scene_text(scene)),
        scene_ids=[entry["id"] for entry in scene["grasps"]],
        layers=_LAYERS,
        sides=_SIDES,
        poster=embed_picture(view_path(media, best.id, VIEW_NAMES[0])) if best else None,
        cards=cards,
        stages=sorted({card.stage for card in cards.values()}),
        task=task,
        run=record,
        verdict=verdict_word(record.verdict, kind) + (", narrowly" if record.narrow else ""),
        verdict_sentence=_VERDICTS[_verdict(record)].format(passed=passed),
        tally=tally(record, passed),
        advice=run_advice(record),
        kind=kind,
        passed=passed,
        load=load_word(kind),
        counts=_counts(record, passed),
        best=best,
        creep_budget=_creep_budget(best) if best else None,
        lifts=kind == "lift",
        thumbnails={
            grasp.id: embed_picture(view_path(media, grasp.id, VIEW_NAMES[0]), _THUMBNAIL)
            for grasp in detailed
        },
        detailed=detailed,
        task_pictures=embed_picture(task_path(media)) if not best else None,
        limits=_limits(task),
        misfits=[str(m) for m in pad_misfits(task)]
        if record.verdict == "infeasible" and not record.lacks_friction
        else [],
        proof_commands=proof_commands(record),
        hold_settings=[
            (setting_name(name.removeprefix("hold.")), setting_text(value, _BY_DEFAULT.get(name, "none")))
            for name, value in record.settings.items()
            if name.startswith("hold.")
        ],
        object_figures=_object_figures(task),
        patch=_soft_patch(record, task),
        pad=task.hand.pad,
        proved=proved,
        measures=_measures(record),
        margins=_margins(record, cards),
        times=_times(record),
        tree=None if record.solve is None else tree_chart(record.solve.rounds),
        test_text=describe_test(task.test),
        command=command_of(record),
        task_is_file=record.task_source.endswith((".yaml", ".yml")),
        made=made_with(record),
    )


def _verdict(record: RunRecord) -> str:
    """Which of the sentences on verdicts is meant."""
    if record.lacks_friction:
        return "friction"
    return "untried" if record.verdict == "undecided" and record.grasps else record.verdict


def _counts(record: RunRecord, passed: str) -> list[tuple[str, int]]:
    """How many grasps came how far."""
    grasps = record.grasps
    untested = sum(grasp.is_untested for grasp in grasps)
    narrow = sum(grasp.is_narrow for grasp in grasps)
    unreachable = sum(grasp.is_unreachable for grasp in grasps)
    return [
        *([] if record.solve is None else [("solved", record.solve.solved)]),
        ("tried", sum(not is_untried(grasp) for grasp in grasps)),
        ("certified", sum(grasp.certified for grasp in grasps)),
        ("clear", sum(grasp.is_clear for grasp in grasps)),
        (passed, sum(grasp.is_held for grasp in grasps)),
        *([("narrowly", narrow)] if narrow else []),
        *([("unreachable", unreachable)] if unreachable else []),
        *([("not tested", untested)] if untested else []),
    ]


def _limits(task: Task) -> list[tuple[str, str, str, bool]]:
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


def _creep_budget(grasp: GraspRecord) -> float | None:
    budget = grasp.hold.settings.get("creep_budget_m_s") if grasp.hold else None
    return budget if isinstance(budget, float) else None


def _measures(record: RunRecord) -> list[tuple[str, float | None]]:
    """Analytic measures of the grasps that came to a test, each with its AUC against the outcome."""
    names = [f.name for f in fields(Quality)]
    grasps = [g for g in record.grasps if g.hold is not None and g.quality.keys() >= set(names)]
    if not grasps:  # nothing is measured before every verdict is known, and in quick runs not at all
        return []
    held = np.array([grasp.is_held for grasp in grasps], dtype=bool)
    return [(name, auc(np.array([grasp.quality[name] for grasp in grasps]), held)) for name in names]


def _margins(record: RunRecord, cards: dict[str, Card]) -> Bars | None:
    looks = {"good": "good", "narrow": "fair", "uncertain": "fair"}
    rows = [
        (grasp.id, hold.margin, f"{hold.margin:.2f}", looks.get(cards[grasp.id].look, ""))
        for grasp in record.grasps
        if (hold := grasp.hold) is not None and hold.margin is not None
    ]
    return bar_chart(rows, mark=(1.0, "the load"))


def _times(record: RunRecord) -> Bars | None:
    total = sum(record.seconds.values())
    return bar_chart(
        [
            (name, seconds, f"{seconds:.1f} s, {100 * seconds / total:.0f} %", "")
            for name, seconds in record.seconds.items()
            if total > 0.0
        ]
    )


def _object_figures(task: Task) -> list[tuple[str, str, str]]:
    """Name, value and source of the object's numbers."""
    obj = task.object
    extents = " × ".join(f"{1e3 * side:.1f}" for side in obj.mesh.extents)
    inflation = max(part.inflation for part in obj.parts)
    values = {
        "shape": f"{extents} mm, {len(obj.pieces)} convex pieces ({100 * inflation:.1f} % inflation)",
        "mass": f"{1e3 * obj.inertia.mass:.1f} g",
        "friction": f"{obj.friction:g}",
    }
    named = [(name, value, obj.sources.get(name, "the object file")) for name, value in values.items()]
    return named + [(name, "", source) for name, source in obj.sources.items() if name not in values]


def _soft_patch(record: RunRecord, task: Task) -> tuple[float, float] | None:
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


@cache
def _template(name: str) -> str:
    return files(__package__).joinpath("templates", name).read_text("utf-8")
