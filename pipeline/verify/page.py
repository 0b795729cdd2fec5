"""The page of a verification: how files were read, and each grasp beside the certified one near it."""

import base64
import io
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any

import jinja2
from markupsafe import Markup
from PIL import Image

from ...base.files.output_file import write_text
from ...base.text.plain_text import counted, printable, shortened
from ...errors import InputError, MissingBackend
from ...mjcf.render import Studio
from ...solver import Configuration
from ..report import content_policy, report_style
from .nearby import given_configuration, main_touches, task_of
from .verify import Verification, Verified
from .words import reading_lines

__all__ = ["write_page"]

_SIZE = (400, 300)
_LONGEST_TEXT = 2000


@dataclass(frozen=True)
class _Row:
    """A grasp on the page, with pictures as the address of their data; empty for none."""

    grasp: Verified
    given: str
    fixed: str


def write_page(
    verification: Verification, path: Path, *, should_stop: Callable[[], bool] = lambda: False
) -> None:
    """Writes the page; pictures that nothing on this machine can draw are left out.

    Args:
        verification: what was found.
        path: of the page.
        should_stop: whether to leave out the pictures that are still missing.
    """
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("holdfast.pipeline.verify"),
        autoescape=True,  # names come from files that anyone may have written
        finalize=_shown,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    style = report_style() + files(__package__).joinpath("templates", "verify.css").read_text("utf-8")
    rows = [_row(verification, grasp, should_stop) for grasp in verification.grasps]
    text = environment.get_template("verify.html.j2").render(
        style=Markup(style),
        policy=content_policy([style]),
        verification=verification,
        count=counted(len(verification.grasps), "grasp"),
        readings=[line for read in verification.pools for line in reading_lines(read)],
        rows=rows,
    )
    write_text(path, text)


def _row(verification: Verification, grasp: Verified, should_stop: Callable[[], bool]) -> _Row:
    if should_stop():
        return _Row(grasp, "", "")
    nearby = grasp.judged.nearby
    fixed = None if nearby is None or nearby.grasp is None else nearby.grasp.configuration
    return _Row(grasp, _picture(_given(verification, grasp)), _picture(fixed))


def _given(verification: Verification, grasp: Verified) -> Configuration | None:
    """The given grasp as a configuration; None where too little touches to make a task of it."""
    given = grasp.judged.measured
    touches = main_touches(given)
    if not touches:
        return None
    with suppress(InputError):
        task = task_of(verification.hand, grasp.judged.obj, given, touches, "given")
        return given_configuration(task, given)
    return None


def _picture(configuration: Configuration | None) -> str:
    """The address of a picture's data."""
    if configuration is None:
        return ""
    try:
        with Studio(configuration.task) as studio:
            pixels = studio.view(configuration, width=_SIZE[0], height=_SIZE[1])
    except MissingBackend:
        return ""
    data = io.BytesIO()
    Image.fromarray(pixels).save(data, "PNG", optimize=True)
    return f"data:image/png;base64,{base64.b64encode(data.getvalue()).decode()}"


def _shown(value: Any) -> Any:
    """What the page says, without what would turn it round or flood it; what is markup already stays."""
    if not isinstance(value, str) or isinstance(value, Markup) or value.startswith("data:image/png;"):
        return value
    return printable(shortened(value, _LONGEST_TEXT))
