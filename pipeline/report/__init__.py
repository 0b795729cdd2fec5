"""The report of a run: a page with tables, charts and pictures."""

from .comparison import Comparison, Row, compare_runs
from .drawing import Drawing
from .earlier import EarlierSet, write_earlier
from .motions import Motion, motions
from .pictures import VIEW_NAMES, Drawn, draw_grasp, missing_pictures, view_path
from .policy import content_policy
from .readme import readme
from .report import write_report
from .style import report_style
from .text import describe, describe_extras, leaning, near_miss

__all__ = [
    "VIEW_NAMES",
    "Comparison",
    "Drawing",
    "Drawn",
    "EarlierSet",
    "Motion",
    "Row",
    "compare_runs",
    "content_policy",
    "describe",
    "describe_extras",
    "draw_grasp",
    "leaning",
    "missing_pictures",
    "motions",
    "near_miss",
    "readme",
    "report_style",
    "view_path",
    "write_earlier",
    "write_report",
]
