"""Bars with a name and a value each, as the plain figures of an inline drawing."""

from collections.abc import Sequence
from dataclasses import dataclass

__all__ = ["Bar", "Bars", "bar_chart"]

_ROW, _BAR = 24.0, 14.0
_VALUE_ROOM, _CHARACTER = 96.0, 7.0
_MOST_NAME = 170.0


@dataclass(frozen=True)
class Bar:
    """A bar: its name, its value in words, `good`, `fair`, `bad` or empty, and top and length in pixels."""

    name: str
    text: str
    look: str
    y: float
    length: float


@dataclass(frozen=True)
class Bars:
    """A drawing of bars.

    Attributes:
        width: in pixels.
        height: in pixels.
        left: where the bars begin.
        thick: how thick each is.
        bars: from the top.
        mark_x: where a line across all bars stands; None for no line.
        mark: what it says.
    """

    width: float
    height: float
    left: float
    thick: float
    bars: list[Bar]
    mark_x: float | None
    mark: str


def bar_chart(
    rows: Sequence[tuple[str, float, str, str]],
    *,
    mark: tuple[float, str] | None = None,
    width: float = 560.0,
) -> Bars | None:
    """A drawing of bars of values that are not negative; None where there are none.

    Args:
        rows: name, value, the value in words, and the look, as in `Bar`.
        mark: a value at which a line stands, and what it says.
        width: in pixels.
    """
    if not rows:
        return None
    left = min(_MOST_NAME, 10.0 + _CHARACTER * max(len(name) for name, *_ in rows))
    most = max([value for _, value, *_ in rows] + ([mark[0]] if mark else [])) or 1.0
    scale = (width - left - _VALUE_ROOM) / most
    top = 18.0 if mark else 4.0
    bars = [
        Bar(name, text, look, round(top + _ROW * k, 1), round(scale * max(0.0, value), 1))
        for k, (name, value, text, look) in enumerate(rows)
    ]
    mark_x = round(left + scale * mark[0], 1) if mark else None
    return Bars(width, top + _ROW * len(rows) + 4.0, left, _BAR, bars, mark_x, mark[1] if mark else "")
