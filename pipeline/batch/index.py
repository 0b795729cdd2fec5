"""The page of a batch: every item with a picture, to be filtered; it needs no network."""

from collections.abc import Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from urllib.parse import quote

import jinja2
from markupsafe import Markup

from ...base.files.output_file import write_text
from ...base.text.plain_text import printable, shortened
from ..report import content_policy, view_path
from .batch_folder import BatchFolder
from .item import Item
from .outcome import Outcome, RunOutcome

__all__ = ["write_index"]

_LONGEST_TEXT = 300


def write_index(folder: BatchFolder, items: Sequence[Item], outcomes: Mapping[str, Outcome]) -> None:
    """Writes the page; items without an outcome yet are shown as open."""
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("holdfast.pipeline.batch"),
        autoescape=True,  # names come from files that anyone may have written
        finalize=_shown,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    rows = [row for item in items for row in _rows(folder, item, outcomes.get(item.name))]
    style, script = _text("index.css"), _text("index.js")
    page = environment.get_template("index.html.j2").render(
        style=Markup(style),
        script=Markup(script),
        policy=content_policy([style], [script], images=("'self'", "file:")),
        rows=rows,
        pictures=any(row["picture"] for row in rows),
        name=folder.path.name,
        verdicts=sorted({row["verdict"] for row in rows}),
        hands=sorted({row["hand"] for row in rows if row["hand"]}),
        good=sum(outcome.good for outcome in outcomes.values()),
        done=sum(outcome.state == "done" for outcome in outcomes.values()),
        total=len(items),
    )
    write_text(folder.index_path, page)


def _rows(folder: BatchFolder, item: Item, outcome: Outcome | None) -> list[dict[str, object]]:
    if outcome is None or not outcome.runs:
        verdict, reason = ("open", "") if outcome is None else (outcome.state, outcome.reason)
        return [_row(item, verdict, reason, None, None, None)]
    rows = []
    for run in outcome.runs:
        report, picture = Path(run.folder) / "report.html", None
        if run.best is not None:
            picture = view_path(Path(run.folder) / "media", run.best, "front")
        links = [
            quote(str(path)) if path is not None and (folder.path / path).is_file() else None
            for path in (report, picture)
        ]
        rows.append(_row(item, run.verdict, "narrowly" if run.narrow else "", run, *links))
    return rows


def _row(
    item: Item, verdict: str, reason: str, run: RunOutcome | None, report: str | None, picture: str | None
) -> dict[str, object]:
    return {
        "name": item.name,
        "verdict": verdict,
        "reason": reason,
        "task": run.task if run else item.name,
        "hand": run.hand if run else "",
        "object": run.object if run else "",
        "run": run,
        "seconds": sum(run.seconds.values()) if run else None,
        "report": report,
        "picture": picture,
    }


def _shown(value: object) -> object:
    """What the page says, without what would turn it round or flood it; what is markup already stays."""
    if not isinstance(value, str) or isinstance(value, Markup):
        return value
    return printable(shortened(value, _LONGEST_TEXT))


def _text(name: str) -> str:
    return files(__package__).joinpath("templates", name).read_text("utf-8")
