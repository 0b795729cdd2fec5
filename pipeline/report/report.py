"""The report: one HTML page that needs nothing else, neither files beside it nor a network."""

import base64
import io
from dataclasses import fields
from math import degrees
from pathlib import Path
from typing import Any

import jinja2
import numpy as np
from markupsafe import Markup
from PIL import Image

from ...files import write_text
from ...mjcf import HoldSettings, Quality, auc, kind_of_test
from ...mjcf.hold import load_word, passed_word, verdict_word
from ...objects import Task, describe_test
from ...plain_text import printable, shortened
from ...significant import significant
from ..records import GraspRecord, RunFolder, RunRecord, Setting
from .charts import slip_chart
from .pictures import VIEW_NAMES, film_path, picture_bytes, view_path
from .policy import content_policy
from .style import report_style
from .text import leaning, proved

__all__ = ["render_report", "write_report"]

_UNITS = ("m", "s", "rad")
_THUMBNAIL = (240, 180)
_LONGEST_TEXT = 3000
# Beyond it, a limit of slip is no run's own.
_LARGEST_LIMIT_M = 10.0
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
}


def write_report(task: Task, record: RunRecord, folder: RunFolder, out: Path | None = None) -> None:
    """Writes the report of a run, with the pictures that lie in its folder."""
    write_text(out or folder.report_path, render_report(task, record, folder.media))


def render_report(task: Task, record: RunRecord, media: Path) -> str:
    """The report as HTML; pictures that are missing are left out."""
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("holdfast.pipeline.report"),
        autoescape=True,  # names come from files that anyone may have written
        finalize=_shown,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"mm": _mm, "tiny_mm": _tiny_mm, "deg": _deg, "number": _number}
    style = report_style()
    best = record.grasps[0] if record.grasps else None
    kind = kind_of_test(task)
    passed = passed_word(kind)
    return environment.get_template("report.html.j2").render(
        style=Markup(style),
        policy=content_policy([style]),
        task=task,
        run=record,
        verdict=verdict_word(record.verdict, kind) + (", narrowly" if record.narrow else ""),
        verdict_sentence=_VERDICTS["friction" if record.lacks_friction else record.verdict].format(
            passed=passed
        ),
        kind=kind,
        passed=passed,
        load=load_word(kind),
        counts=_counts(record, passed),
        best=best,
        best_views=_views(best, media) if best else [],
        best_film=_embed(film_path(media, best.id)) if best else None,
        best_chart=_chart(best) if best else None,
        creep_budget=_creep_budget(best) if best else None,
        lifts=kind == "lift",
        thumbnails={
            grasp.id: _embed(view_path(media, grasp.id, VIEW_NAMES[0]), _THUMBNAIL) for grasp in record.grasps
        },
        hold_settings=[
            (_setting_name(name.removeprefix("hold.")), _setting_text(value, _BY_DEFAULT.get(name, "none")))
            for name, value in record.settings.items()
            if name.startswith("hold.")
        ],
        object_figures=_object_figures(task),
        patch=_soft_patch(record, task),
        pad=task.hand.pad,
        leaning=leaning,
        proved=proved,
        measures=_measures(record),
        test_text=describe_test(task.test),
    )


def _counts(record: RunRecord, passed: str) -> list[tuple[str, int]]:
    """How many grasps came how far."""
    grasps = record.grasps
    untested = sum(grasp.is_untested for grasp in grasps)
    narrow = sum(grasp.is_narrow for grasp in grasps)
    unreachable = sum(grasp.is_unreachable for grasp in grasps)
    return [
        *([] if record.solve is None else [("solved", record.solve.solved)]),
        ("tried", len(grasps)),
        ("certified", sum(grasp.certified for grasp in grasps)),
        ("clear", sum(grasp.is_clear for grasp in grasps)),
        (passed, sum(grasp.is_held for grasp in grasps)),
        *([("narrowly", narrow)] if narrow else []),
        *([("unreachable", unreachable)] if unreachable else []),
        *([("not tested", untested)] if untested else []),
    ]


def _views(grasp: GraspRecord, media: Path) -> list[tuple[str, str]]:
    """Names and data URIs of the four sides."""
    embedded = [(name, _embed(view_path(media, grasp.id, name))) for name in VIEW_NAMES]
    return [(name, picture) for name, picture in embedded if picture is not None]


def _chart(grasp: GraspRecord) -> Any:
    if grasp.hold is None:
        return None
    limit = grasp.hold.settings.get("slip_limit_m")
    if not isinstance(limit, float) or not 0.0 < limit < _LARGEST_LIMIT_M:
        return None
    return slip_chart(grasp.hold.directions, limit)


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
    if not isinstance(radius, float) or not 0.0 < radius < _LARGEST_LIMIT_M:
        return None
    settings = HoldSettings(
        friction=friction if isinstance(friction, float) and friction > 0.0 else None, patch_radius_m=radius
    )
    return radius, settings.torsional_friction(task.object)


def _setting_name(name: str) -> str:
    """`slip_limit_m` as `slip limit, m`."""
    words, _, unit = name.rpartition("_")
    return f"{words.replace('_', ' ')}, {unit}" if unit in _UNITS else name.replace("_", " ")


def _setting_text(value: Setting, unset: str = "none") -> str:
    if value is None:
        return unset
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, list):
        rows = [f"({_setting_text(list(row))})" if isinstance(row, tuple) else f"{row:g}" for row in value]
        return ", ".join(rows)
    return f"{value:g}" if isinstance(value, float) else str(value)


def _embed(path: Path, size: tuple[int, int] | None = None) -> Markup | None:
    """A picture as a data URI, no larger than `size`; None where there is none that this run has drawn."""
    data = picture_bytes(path)
    if data is None:
        return None
    if size is not None:
        with Image.open(io.BytesIO(data)) as image:
            image.thumbnail(size)
            buffer = io.BytesIO()
            image.save(buffer, "PNG", optimize=True)
            data = buffer.getvalue()
    return Markup(f"data:image/png;base64,{base64.b64encode(data).decode()}")


def _shown(value: Any) -> Any:
    """What the page says, without what would turn it round or flood it; what is markup already stays."""
    if not isinstance(value, str) or isinstance(value, Markup):
        return value
    return printable(shortened(value, _LONGEST_TEXT))


def _mm(metres: float | None, digits: int = 2) -> str:
    return "–" if metres is None else _plain(1e3 * metres, digits)


def _tiny_mm(metres: float) -> str:
    return f"{1e3 * metres:.0e}"


def _deg(radians: float | None, digits: int = 1) -> str:
    return "–" if radians is None else _plain(degrees(radians), digits)


def _plain(value: float, digits: int) -> str:
    """A number with so many decimals; adding zero turns the -0 that rounding may leave into 0."""
    return f"{round(value, digits) + 0.0:.{digits}f}"


def _number(value: float | None, digits: int = 3) -> str:
    return "–" if value is None else significant(value, digits)
