"""Tables of text."""

import textwrap
from collections.abc import Sequence

from .plain_text import printable

__all__ = ["format_table"]

# A column of words is not made narrower than this.
_NARROWEST = 12
_BETWEEN = "  "


def format_table(header: Sequence[str], rows: Sequence[Sequence[str]], width: int | None = None) -> str:
    """A text table; columns whose cells are all numbers (or a dash) stand flush right.

    Args:
        header: over the columns.
        rows: the cells.
        width: of what it is shown in; columns of words are folded where it is wider. None folds nothing.
    """
    rows = [[printable(cell) for cell in row] for row in rows]
    widths = [max(len(row[i]) for row in [header, *rows]) for i in range(len(header))]
    right = [all(_is_number(row[i]) for row in rows) for i in range(len(header))]
    if width is not None:
        widths = _narrowed(widths, right, width, header)
    lines = []
    for row in [header, ["-" * width for width in widths], *rows]:
        folded = [_folded(cell, width) for cell, width in zip(row, widths, strict=True)]
        for i in range(max(map(len, folded), default=1)):
            cells = [cell[i] if i < len(cell) else "" for cell in folded]
            lines.append(_line(cells, widths, right))
    return "\n".join(lines)


def _line(cells: Sequence[str], widths: Sequence[int], right: Sequence[bool]) -> str:
    padded = [
        cell.rjust(width) if flush else cell.ljust(width)
        for cell, width, flush in zip(cells, widths, right, strict=True)
    ]
    return _BETWEEN.join(padded).rstrip()


def _narrowed(widths: Sequence[int], right: Sequence[bool], most: int, header: Sequence[str]) -> list[int]:
    """Widths that fit where they can: the widest column of words gives way first."""
    widths = list(widths)
    least = [
        len(head) if flush else max(_NARROWEST, len(head)) for head, flush in zip(header, right, strict=True)
    ]
    while (excess := sum(widths) + len(_BETWEEN) * (len(widths) - 1) - most) > 0:
        wide = [i for i in range(len(widths)) if not right[i] and widths[i] > least[i]]
        if not wide:
            break
        widest = max(wide, key=lambda i: widths[i])
        others = [widths[i] for i in wide if widths[i] < widths[widest]]
        # Down to the next widest at once, so that equal columns share what is to be saved.
        step = widths[widest] - max(others) if others else excess
        widths[widest] = max(least[widest], widths[widest] - max(1, min(excess, step)))
    return widths


def _folded(cell: str, width: int) -> list[str]:
    if len(cell) <= width:
        return [cell]
    return textwrap.wrap(cell, width, break_on_hyphens=False) or [""]


def _is_number(cell: str) -> bool:
    return cell == "-" or cell.replace(".", "", 1).lstrip("+-").isdigit()
