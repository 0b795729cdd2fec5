"""Curves of a test over time as the plain figures of an inline drawing; the template writes the SVG."""

from collections.abc import Callable
from dataclasses import dataclass
from math import ceil, degrees, floor, log10

from ...mjcf import gravity_names, main_axis
from ..records import Direction, Round

__all__ = ["Chart", "Line", "slip_chart", "tree_chart", "turn_chart"]

_LEFT, _TOP, _BOTTOM = 46.0, 12.0, 30.0
# Right of the plot stand the lines' names, of so many pixels a character.
_NAME_GAP, _CHARACTER = 20.0, 6.6
# Labels at the ends of the lines keep this distance, in pixels.
_LABEL_STEP = 13.0
_SHORTEST_S = 1e-6
_HUES = 8

Samples = list[tuple[float, float]]


@dataclass(frozen=True)
class Line:
    """One curve.

    Attributes:
        points: for a polyline.
        label: direction of gravity, such as `+x`; no two in a chart are the same.
        axis: `x`, `y`, `z`, or `other` for directions between them.
        hue: number of a colour, for lines that are `other`.
        dashed: whether gravity points against the axis.
        end: place (x, y) of the line's last point.
        label_y: height of the label, moved apart from the others.
        held: whether this direction held.
    """

    points: str
    label: str
    axis: str
    hue: int
    dashed: bool
    end: tuple[float, float]
    label_y: float
    held: bool


@dataclass(frozen=True)
class Chart:
    """A drawing.

    Attributes:
        width: in pixels.
        height: in pixels.
        frame: left, top, right, bottom of the plot.
        x_ticks: (place, text), time in s or what `x_unit` says.
        y_ticks: (place, text), in `unit`.
        lines: the curves.
        limit_y: height of the limit; None where it is above the chart, or there is none.
        limit: the limit in `unit`; None where there is none.
        unit: of the values.
        x_unit: of what runs along x.
    """

    width: float
    height: float
    frame: tuple[float, float, float, float]
    x_ticks: list[tuple[float, str]]
    y_ticks: list[tuple[float, str]]
    lines: list[Line]
    limit_y: float | None
    limit: float | None
    unit: str
    x_unit: str = "s"


def slip_chart(
    directions: list[Direction], limit_m: float, *, width: float = 560.0, height: float = 240.0
) -> Chart | None:
    """The slip curves of a hold test over time, in mm; None where there are none."""
    return _chart(directions, [entry.curve for entry in directions], _to_mm, limit_m, ("mm", width, height))


def turn_chart(
    directions: list[Direction], limit_rad: float | None, *, width: float = 560.0, height: float = 240.0
) -> Chart | None:
    """The rotation of the object in a hold test over time, in degrees; None where there is none."""
    curves = [entry.rotation_curve for entry in directions]
    return _chart(directions, curves, degrees, limit_rad, ("°", width, height))


def tree_chart(rounds: list[Round], *, width: float = 560.0, height: float = 200.0) -> Chart | None:
    """How the search trees of a run's rounds went: the share decided in per cent, over the boxes done.

    None where no round split its first box.
    """
    curves = [[(float(step.boxes), 100.0 * step.decided) for step in entry.search] for entry in rounds]
    drawn = [k for k, curve in enumerate(curves) if len(curve) > 1 and curve[-1][0] > 1.0]
    if not drawn:
        return None
    most = max(curves[k][-1][0] for k in drawn)
    right, bottom = width - _NAME_GAP - _CHARACTER * 8, height - _BOTTOM

    def place(boxes: float, decided: float) -> tuple[float, float]:
        x = _LEFT + (right - _LEFT) * boxes / most
        return round(x, 1), round(bottom - (bottom - _TOP) * min(decided, 100.0) / 100.0, 1)

    placed = [[place(*sample) for sample in curves[k]] for k in drawn]
    heights = _spread([points[-1][1] for points in placed])
    lines = [
        Line(_polyline(points), f"round {k + 1}", "other", k % _HUES, False, points[-1], label_y, True)
        for k, points, label_y in zip(drawn, placed, heights, strict=True)
    ]
    return Chart(
        width,
        height,
        (_LEFT, _TOP, right, bottom),
        [(place(boxes, 0.0)[0], f"{boxes:g}") for boxes in _ticks(most) if boxes <= most * 1.001],
        [(place(0.0, share)[1], f"{share:g}") for share in (0.0, 25.0, 50.0, 75.0, 100.0)],
        lines,
        None,
        None,
        "%",
        "boxes",
    )


def _polyline(points: list[tuple[float, float]]) -> str:
    return " ".join(f"{x:g},{y:g}" for x, y in points)


def _to_mm(metres: float) -> float:
    return 1e3 * metres


def _chart(
    directions: list[Direction],
    curves: list[Samples],
    scaled: Callable[[float], float],
    limit: float | None,
    look: tuple[str, float, float],
) -> Chart | None:
    """A chart of curves that belong to directions, with values scaled for people; `look`: unit and size."""
    unit, width, height = look
    names = gravity_names([entry.gravity for entry in directions])
    # Time runs on in every curve of a test; a file that says otherwise says nothing that can be drawn.
    drawn = [k for k, curve in enumerate(curves) if curve and curve[-1][0] > _SHORTEST_S]
    if not drawn:
        return None
    height = max(height, _TOP + _BOTTOM + _LABEL_STEP * len(drawn))
    seconds = max(curves[k][-1][0] for k in drawn)
    top = scaled(max(value for k in drawn for _, value in curves[k]))
    # A grasp that gives way leaves the chart; what matters is near the limit.
    top = max(top if limit is None else min(top, 2.0 * scaled(limit)), 1e-3)
    ticks = _ticks(top)
    top = ticks[-1]
    longest = max(len(names[k]) + 2 for k in drawn)
    right, bottom = width - _NAME_GAP - _CHARACTER * longest, height - _BOTTOM

    def place(time: float, value: float) -> tuple[float, float]:
        x = _LEFT + (right - _LEFT) * time / seconds
        y = bottom - (bottom - _TOP) * min(scaled(value) / top, 1.02)
        return round(x, 1), round(y, 1)

    placed = [[place(*sample) for sample in curves[k]] for k in drawn]
    label_heights = _spread([points[-1][1] for points in placed])
    lines = [
        Line(
            _polyline(points),
            names[k],
            *_look(directions[k], names[k], k),
            points[-1],
            label_y,
            directions[k].held,
        )
        for k, points, label_y in zip(drawn, placed, label_heights, strict=True)
    ]
    is_within = limit is not None and scaled(limit) <= top
    return Chart(
        width,
        height,
        (_LEFT, _TOP, right, bottom),
        [(place(time, 0.0)[0], f"{time:g}") for time in _ticks(seconds) if time <= seconds * 1.001],
        [(round(bottom - (bottom - _TOP) * tick / top, 1), f"{tick:g}") for tick in ticks],
        lines,
        place(0.0, limit)[1] if limit is not None and is_within else None,
        None if limit is None else scaled(limit),
        unit,
    )


def _ticks(top: float) -> list[float]:
    """Round numbers from 0 to the first one at or above `top`."""
    size = 10.0 ** floor(log10(top / 3.0))
    step = next(size * factor for factor in (1.0, 2.0, 2.5, 5.0, 10.0) if top / (size * factor) <= 5.0)
    return [round(step * k, 12) for k in range(ceil(top / step - 1e-9) + 1)]


def _look(direction: Direction, name: str, number: int) -> tuple[str, int, bool]:
    """Axis, hue and whether the line is dashed: directions along an axis have its colour."""
    axis, backwards = main_axis(direction.gravity)
    is_plain = name[1:2] == axis and len(name) == 2
    return (axis, 0, backwards) if axis and is_plain else ("other", number % _HUES, False)


def _spread(heights: list[float]) -> list[float]:
    """The heights moved apart so that labels at them do not overlap, in the same order."""
    order = sorted(range(len(heights)), key=lambda i: heights[i], reverse=True)
    out = list(heights)
    ceiling = float("inf")
    for i in order:  # from the lowest on the page upwards
        out[i] = min(heights[i], ceiling - _LABEL_STEP)
        ceiling = out[i]
    # What has been pushed out of the top moves all down again.
    shortfall = _TOP + 4.0 - min(out)
    return [y + max(0.0, shortfall) for y in out]
