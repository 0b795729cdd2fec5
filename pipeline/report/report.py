"""The report: one HTML page that needs nothing else, neither files beside it nor a network."""

from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import jinja2
from markupsafe import Markup

from ...base.files.output_file import write_text
from ...mjcf import TestKind, kind_of_test
from ...mjcf.hold import load_word, passed_word, verdict_word
from ...objects import Task, describe_test
from ...solver import pad_misfits
from ..records import MOST_SHOWN, RunFolder, RunRecord
from .cards import Card, make_card
from .charts import tree_chart
from .earlier import earlier_sets
from .embed import embed_picture
from .facts import (
    counts,
    creep_budget,
    limits,
    margins,
    measures,
    object_figures,
    soft_patch,
    times,
)
from .formats import FILTERS, setting_name, setting_text, shown
from .pictures import VIEW_NAMES, task_path, view_path
from .policy import content_policy
from .reproduce import command_of, made_with, proof_commands
from .scene import scene_data, scene_text
from .style import report_style
from .text import proved
from .why import run_advice, tally

__all__ = ["render_report", "write_report"]

_THUMBNAIL = (240, 180)
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
    kind = kind_of_test(task)
    page = page or media.parent / "report.html"
    best = record.grasps[0] if record.grasps else None
    cards = {
        grasp.id: make_card(grasp, task, kind, media, page, best=grasp is best, enough=record.has_enough)
        for grasp in record.grasps
    }
    return (
        _environment()
        .get_template("report.html.j2")
        .render(
            task=task,
            run=record,
            cards=cards,
            best=best,
            kind=kind,
            **_machinery(task, record, media),
            **_outcome(record, kind, cards),
            **_test_and_object(task, record),
            **_pictures(record, media),
        )
    )


def _environment() -> jinja2.Environment:
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("holdfast.pipeline.report"),
        autoescape=True,  # names come from files that anyone may have written
        finalize=shown,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= FILTERS
    return environment


def _machinery(task: Task, record: RunRecord, media: Path) -> dict[str, Any]:
    """Style, scripts and what they draw."""
    style, library = report_style(), _template("three.min.js")
    scripts = [_template("table.js"), _template("viewer.js")]
    shown_grasps = record.model_copy(update={"grasps": record.grasps[:MOST_SHOWN]})
    scene = scene_data(task, shown_grasps, media.parent)
    return {
        "style": Markup(style),
        "scripts": [Markup(script) for script in scripts],
        "library": Markup(library),
        "policy": content_policy([style], [library, *scripts]),
        "scene": Markup(scene_text(scene)),
        "scene_ids": [entry["id"] for entry in scene["grasps"]],
        "layers": _LAYERS,
        "sides": _SIDES,
    }


def _outcome(record: RunRecord, kind: TestKind, cards: dict[str, Card]) -> dict[str, Any]:
    """What came of the run and of its grasps, and how it is repeated."""
    passed = passed_word(kind)
    return {
        "passed": passed,
        "load": load_word(kind),
        "verdict": verdict_word(record.verdict, kind) + (", narrowly" if record.narrow else ""),
        "verdict_sentence": _VERDICTS[_verdict(record)].format(passed=passed),
        "tally": tally(record, passed),
        "advice": run_advice(record),
        "counts": counts(record, passed),
        "stages": sorted({card.stage for card in cards.values()}),
        "creep_budget": creep_budget(record.grasps[0]) if record.grasps else None,
        "proved": proved,
        "measures": measures(record),
        "margins": margins(record, cards),
        "times": times(record),
        "tree": None if record.solve is None else tree_chart(record.solve.rounds),
        "proof_commands": proof_commands(record),
        "command": command_of(record),
        "task_is_file": record.task_source.endswith((".yaml", ".yml")),
        "made": made_with(record),
    }


def _test_and_object(task: Task, record: RunRecord) -> dict[str, Any]:
    """The hand, the object and the test, with its settings."""
    is_refuted = record.verdict == "infeasible" and not record.lacks_friction
    return {
        "lifts": kind_of_test(task) == "lift",
        "limits": limits(task),
        "misfits": [str(misfit) for misfit in pad_misfits(task)] if is_refuted else [],
        "hold_settings": [
            (setting_name(name.removeprefix("hold.")), setting_text(value, _BY_DEFAULT.get(name, "none")))
            for name, value in record.settings.items()
            if name.startswith("hold.")
        ],
        "object_figures": object_figures(task),
        "patch": soft_patch(record, task),
        "pad": task.hand.pad,
        "test_text": describe_test(task.test),
    }


def _pictures(record: RunRecord, media: Path) -> dict[str, Any]:
    """The grasps that are shown one by one, pictures that lie in the run's folder, and runs before it."""
    detailed = record.grasps[:MOST_SHOWN]
    best = record.grasps[0] if record.grasps else None
    return {
        "detailed": detailed,
        "poster": embed_picture(view_path(media, best.id, VIEW_NAMES[0])) if best else None,
        "thumbnails": {
            grasp.id: embed_picture(view_path(media, grasp.id, VIEW_NAMES[0]), _THUMBNAIL)
            for grasp in detailed
        },
        "earlier": earlier_sets(media),
        "task_pictures": None if best else embed_picture(task_path(media)),
    }


def _verdict(record: RunRecord) -> str:
    """Which of the sentences on verdicts is meant."""
    if record.lacks_friction:
        return "friction"
    return "untried" if record.verdict == "undecided" and record.grasps else record.verdict


@cache
def _template(name: str) -> str:
    return files(__package__).joinpath("templates", name).read_text("utf-8")
