"""How pages of this program look."""

from importlib.resources import files

__all__ = ["report_style"]


def report_style() -> str:
    """The style sheet that all pages share."""
    return files(__package__).joinpath("templates", "report.css").read_text("utf-8")
