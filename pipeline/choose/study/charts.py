"""Charts of a study as the plain figures of inline drawings; the template writes the SVG."""

from collections.abc import Sequence
from dataclasses import dataclass

from .calibration import Calibration
from .evaluation import Comparison
from .learning_curve import CurvePoint

__all__ = ["Plot", "PlotLine", "Whisker", "calibration_plot", "curve_plot", "whiskers"]

_LEFT, _RIGHT, _TOP, _BOTTOM = 40.0, 110.0, 12.0, 34.0
_WIDTH, _HEIGHT = 540.0, 280.0
_LABEL_STEP = 13.0
_BESIDE = 2.5


@dataclass(frozen=True)
class Whisker:
    """A value with its interval along a line from 0 to 1, in percent of the line.

    Attributes:
        name: what it is of.
        value: of the point.
        low: where the interval begins.
        high: where it ends.
    """

    name: str
    value: float
    low: float
    high: float


@dataclass(frozen=True)
class PlotLine:
    """A line in a plot.

    Attributes:
        name: written at its end.
        points: for a polyline.
        marks: (x, y) of each point.
        bars: (x, low, high) of each interval; empty where there are none.
        end: place of the last point.
        label_y: height of the name, moved apart from the others.
        hue: number of its colour, from 0.
    """

    name: str
    points: str
    marks: list[tuple[float, float]]
    bars: list[tuple[float, float, float]]
    end: tuple[float, float]
    label_y: float
    hue: int


@dataclass(frozen=True)
class Plot:
    """A plot.

    Attributes:
        width: in pixels.
        height: in pixels.
        frame: left, top, right, bottom.
        x_ticks: (place, text).
        y_ticks: (place, text).
        x_title: below the axis.
        lines: the lines.
        diagonal: a line for comparison as (x1, y1, x2, y2); None without.
    """

    width: float
    height: float
    frame: tuple[float, float, float, float]
    x_ticks: list[tuple[float, str]]
    y_ticks: list[tuple[float, str]]
    x_title: str
    lines: list[PlotLine]
    diagonal: tuple[float, float, float, float] | None = None


def whiskers(entry: Comparison) -> list[Whisker]:
    """First choices that held, best first."""
    rows = sorted(entry.standings, key=lambda one: -one.success.value)
    return [
        Whisker(one.policy, *(100.0 * x for x in (one.success.value, one.success.low, one.success.high)))
        for one in rows
    ]


def curve_plot(points: Sequence[CurvePoint]) -> Plot:
    """The learning curve of at least one point."""
    most = max(point.objects for point in points)
    low = min(point.success.low for point in points)
    high = max(point.success.high for point in points)
    floor, ceiling = int(10 * low) / 10.0, min(1.0, int(10 * high + 1) / 10.0)
    place = _Scale(0.0, 1.05 * most, floor, ceiling)
    names = list(dict.fromkeys(point.policy for point in points))
    lines = [
        place.line(
            name,
            [(one.objects, one.success.value) for one in points if one.policy == name],
            [(one.objects, one.success.low, one.success.high) for one in points if one.policy == name],
            hue,
            # Beside each other, or intervals of policies would hide one another.
            aside=_BESIDE * (hue - 0.5 * (len(names) - 1)),
        )
        for hue, name in enumerate(names)
    ]
    objects = sorted({round(point.objects) for point in points})
    steps = range(round(10 * floor), round(10 * ceiling) + 1)
    return place.plot(
        lines, [(x, str(x)) for x in objects], [(0.1 * k, f"{10 * k} %") for k in steps], "objects trained on"
    )


def calibration_plot(found: Sequence[tuple[str, Calibration]]) -> Plot | None:
    """Observed by predicted chance; None where no policy gives chances."""
    if not found:
        return None
    place = _Scale(0.0, 1.0, 0.0, 1.0)
    lines = [
        place.line(name, [(entry.predicted, entry.observed) for entry in calibration.bins], [], hue)
        for hue, (name, calibration) in enumerate(found)
    ]
    ticks = [(0.2 * k, f"{20 * k} %") for k in range(6)]
    return place.plot(lines, ticks, ticks, "predicted chance", diagonal=True)


class _Scale:
    """Where values stand in the drawing."""

    def __init__(self, left: float, right: float, bottom: float, top: float):
        self._x, self._y = (left, max(right - left, 1e-9)), (bottom, max(top - bottom, 1e-9))

    def x(self, value: float) -> float:
        return round(_LEFT + (_WIDTH - _RIGHT - _LEFT) * (value - self._x[0]) / self._x[1], 1)

    def y(self, value: float) -> float:
        share = (value - self._y[0]) / self._y[1]
        return round(_HEIGHT - _BOTTOM - (_HEIGHT - _BOTTOM - _TOP) * share, 1)

    def line(
        self,
        name: str,
        points: Sequence[tuple[float, float]],
        bars: Sequence[tuple[float, float, float]],
        hue: int,
        *,
        aside: float = 0.0,
    ) -> PlotLine:
        marks = [(round(self.x(x) + aside, 1), self.y(y)) for x, y in points]
        return PlotLine(
            name,
            " ".join(f"{x:g},{y:g}" for x, y in marks),
            marks,
            [(round(self.x(x) + aside, 1), self.y(low), self.y(high)) for x, low, high in bars],
            marks[-1],
            marks[-1][1],
            hue,
        )

    def plot(
        self,
        lines: Sequence[PlotLine],
        x_ticks: Sequence[tuple[float, str]],
        y_ticks: Sequence[tuple[float, str]],
        x_title: str,
        *,
        diagonal: bool = False,
    ) -> Plot:
        frame = (_LEFT, _TOP, _WIDTH - _RIGHT, _HEIGHT - _BOTTOM)
        return Plot(
            _WIDTH,
            _HEIGHT,
            frame,
            [(self.x(x), text) for x, text in x_ticks],
            [(self.y(y), text) for y, text in y_ticks],
            x_title,
            _apart(lines),
            (self.x(0.0), self.y(0.0), self.x(1.0), self.y(1.0)) if diagonal else None,
        )


def _apart(lines: Sequence[PlotLine]) -> list[PlotLine]:
    """The lines with their names moved so that none stands on another."""
    moved, lowest = [], float("-inf")
    for line in sorted(lines, key=lambda one: one.end[1]):
        lowest = max(line.end[1], lowest + _LABEL_STEP)
        moved.append(PlotLine(**{**vars(line), "label_y": lowest}))
    return moved
