"""The page of a study: one HTML file that needs nothing else, neither files beside it nor a network."""

from importlib.resources import files
from typing import Any

import jinja2
from markupsafe import Markup

from .... import __version__
from ....base.text.plain_text import printable, shortened
from ...report import content_policy, report_style
from .charts import Plot, calibration_plot, curve_plot, whiskers
from .evaluation import Comparison
from .intervals import Estimate
from .study import Study
from .summary import headline, load_words

__all__ = ["render_page"]

_LONGEST_TEXT = 300


def render_page(study: Study, source: str) -> str:
    """The page as HTML; `source` says where the data is from."""
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("holdfast.pipeline.choose.study"),
        autoescape=True,  # names come from files that anyone may have written
        finalize=_shown,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"percent": _percent, "plain": Estimate.text, "load": load_words}
    own = files(__package__).joinpath("templates", "choice.css").read_text("utf-8")
    styles = [report_style(), own]
    return environment.get_template("choice.html.j2").render(
        policy=content_policy(styles),
        styles=[Markup(style) for style in styles],
        study=study,
        source=source,
        summary=headline(study),
        whiskers=whiskers,
        calibration=_calibration,
        curves=_curves(study),
        version=__version__,
    )


def _calibration(entry: Comparison) -> Plot | None:
    found = [(one.policy, one.calibration) for one in entry.standings if one.calibration is not None]
    return calibration_plot(found)


def _curves(study: Study) -> list[tuple[float, Plot]]:
    """A learning curve for each load."""
    loads = sorted({point.load for point in study.curve})
    return [(load, curve_plot([point for point in study.curve if point.load == load])) for load in loads]


def _percent(estimate: Estimate) -> str:
    """Without decimals: intervals are wider than a point, and the table has its room."""
    return estimate.text(100.0, 0)


def _shown(value: Any) -> Any:
    """What the page says, without what would turn it round or flood it; what is markup already stays."""
    if not isinstance(value, str) or isinstance(value, Markup):
        return value
    return printable(shortened(value, _LONGEST_TEXT))
