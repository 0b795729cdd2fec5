"""Slip curves as the plain figures of an inline drawing; the template writes the SVG."""

from dataclasses import dataclass
from math import ceil, floor, log10

from ..records import Direction

__all__ = ["Chart", "Line", "slip_chart"]

_LEFT, _TOP, _RIGHT, _BOTTOM = 46.0, 12.0, 62.0, 30.0
_AXES = "xyz"
# Labels at the ends of the lines keep this distance, in pixels.
_LABEL_STEP = 13.0
_SHORTEST_S = 1e-6


@dataclass(frozen=True)
class Line:
    """One curve.

    Attributes:
        points: for a polyline.
        label: direction of gravity, such as `+x`.
        axis: `x`, `y`, `z`, or `other`: chooses the colour.
        dashed: whether gravity points against the axis.
        end: place (x, y) of the line's last point.
        label_y: height of the label, moved apart from the others.
        held: whether this direction held.
    """

    points: str
    label: str
    axis: str
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
        x_ticks: (place, text), time in s.
        y_ticks: (place, text), slip in mm.
        lines: the curves.
        limit_y: height of the slip limit; None where it is above the chart.
        limit_mm: the slip limit.
    """

    width: float
    height: float
    frame: tuple[float, float, float, float]
    x_ticks: list[tuple[float, str]]
    y_ticks: list[tuple[float, str]]
    lines: list[Line]
    limit_y: float | None
    limit_mm: float


def slip_chart(
    directions: list[Direction], limit_m: float, *, width: float = 560.0, height: float = 240.0
) -> Chart | None:
    """The slip curves of a hold test over time; None where there are none."""
    # Time runs on in every curve of a test; a file that says otherwise says nothing that can be drawn.
    curves = [
        direction for direction in directions if direction.curve and direction.curve[-1][0] > _SHORTEST_S
    ]
    if not curves:
        return None
    seconds = max(direction.curve[-1][0] for direction in curves)
    top_mm = 1e3 * max(slip for direction in curves for _, slip in direction.curve)
    # A grasp that gives way leaves the chart; what matters is near the limit.
    top_mm = max(min(top_mm, 2e3 * limit_m), 1e-3)
    ticks = _ticks(top_mm)
    top_mm = ticks[-1]
    right, bottom = width - _RIGHT, height - _BOTTOM

    def place(time: float, slip: float) -> tuple[float, float]:
        x = _LEFT + (right - _LEFT) * time / seconds
        y = bottom - (bottom - _TOP) * min(1e3 * slip / top_mm, 1.02)
        return round(x, 1), round(y, 1)

    placed = [[place(*sample) for sample in direction.curve] for direction in curves]
    label_heights = _spread([points[-1][1] for points in placed])
    lines = [
        Line(
            " ".join(f"{x:g},{y:g}" for x, y in points),
            *_name(direction),
            points[-1],
            label_y,
            direction.held,
        )
        for direction, points, label_y in zip(curves, placed, label_heights, strict=True)
    ]
    within = 1e3 * limit_m <= top_mm
    return Chart(
        width,
        height,
        (_LEFT, _TOP, right, bottom),
        [(place(time, 0.0)[0], f"{time:g}") for time in _ticks(seconds) if time <= seconds * 1.001],
        [(place(0.0, 1e-3 * slip)[1], f"{slip:g}") for slip in ticks],
        lines,
        place(0.0, limit_m)[1] if within else None,
        1e3 * limit_m,
    )


def _ticks(top: float) -> list[float]:
    """Round numbers from 0 to the first one at or above `top`."""
    size = 10.0 ** floor(log10(top / 3.0))
    step = next(size * factor for factor in (1.0, 2.0, 2.5, 5.0, 10.0) if top / (size * factor) <= 5.0)
    return [round(step * k, 12) for k in range(ceil(top / step - 1e-9) + 1)]


def _name(direction: Direction) -> tuple[str, str, bool]:
    """Label, axis and whether it points backwards."""
    size = max(abs(x) for x in direction.gravity)
    along = [i for i, x in enumerate(direction.gravity) if abs(x) > 1e-9 * size]
    if not along:  # nothing but the test itself pulls
        return "", "other", False
    if len(along) > 1:
        along.sort(key=lambda i: -abs(direction.gravity[i]))
        parts = [("−" if direction.gravity[i] < 0.0 else "+") + _AXES[i] for i in along]
        return "".join(parts), "other", False
    axis = _AXES[along[0]]
    backwards = direction.gravity[along[0]] < 0.0
    return ("−" if backwards else "+") + axis, axis, backwards


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
