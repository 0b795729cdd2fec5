"""The report of a run: a page with tables, charts and pictures."""

from .pictures import Drawn, draw_grasp, draw_grasps, missing_pictures, view_path
from .policy import content_policy
from .report import write_report
from .style import report_style
from .text import describe, describe_extras, leaning

__all__ = [
    "Drawn",
    "content_policy",
    "describe",
    "describe_extras",
    "draw_grasp",
    "draw_grasps",
    "leaning",
    "missing_pictures",
    "report_style",
    "view_path",
    "write_report",
]
