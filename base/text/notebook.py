"""Results as HTML for notebooks: small tables, with everything in them escaped."""

from collections.abc import Iterable, Sequence
from html import escape

from .plain_text import printable

__all__ = ["html_table"]

_MOST_ROWS = 50


def html_table(title: str, head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A paragraph and a table below it, of which the first rows are shown.

    Args:
        title: the paragraph.
        head: names of the columns.
        rows: cells of each row; numbers are written in six digits.
    """
    rows = list(rows)
    title = f"<p>{escape(printable(title))}</p>"
    if not rows:
        return title
    more = len(rows) - _MOST_ROWS
    body = "".join(_row("td", row) for row in rows[:_MOST_ROWS])
    table = f"<table><thead>{_row('th', head)}</thead><tbody>{body}</tbody></table>"
    return f"{title}{table}" + (f"<p>and {more} more</p>" if more > 0 else "")


def _row(kind: str, cells: Sequence[object]) -> str:
    return "<tr>" + "".join(f"<{kind}>{escape(printable(_text(cell)))}</{kind}>" for cell in cells) + "</tr>"


def _text(cell: object) -> str:
    return f"{cell:.6g}" if isinstance(cell, float) else str(cell)
