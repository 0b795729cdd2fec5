"""What is written onto a picture of regions: their names in two columns, axes, a scale bar, a title."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from ...base.numeric.arrays import Array, Picture
from ...base.text.plain_text import printable
from .annotations import draw_arrow

__all__ = ["Callout", "colour_of", "with_axes", "with_callouts", "with_scale_bar", "with_title"]

_INK = (45, 49, 56)
_FAINT = (120, 125, 133)
_AXES = (("x", (196, 48, 43)), ("y", (38, 140, 62)), ("z", (40, 84, 196)))
# Steps of hue by the golden ratio keep any number of colours apart.
_GOLDEN = 0.6180339887
_SATURATION, _VALUE = (0.85, 0.65), (0.82, 0.62)
_FONT_PX = 15
_LINE_PX = 19
_EDGE_PX = 8
_SWATCH_PX = 10
# Where scale bars end: lengths of 1, 2 and 5 times a power of ten, at most this share of the width.
_BAR_SHARE = 0.2


@dataclass(frozen=True, eq=False)
class Callout:
    """A name beside the picture, with a line to what it names.

    Attributes:
        text: the name.
        pixel: (2,) place in the picture.
        colour: RGB.
        hidden: whether something stands before that place.
    """

    text: str
    pixel: Array
    colour: tuple[int, int, int]
    hidden: bool = False


def colour_of(number: int) -> tuple[int, int, int]:
    """RGB of colour `number`: dark enough for white paper, and unlike its neighbours."""
    hue = 360.0 * ((0.02 + number * _GOLDEN) % 1.0)
    saturation, value = _SATURATION[number // 2 % 2], _VALUE[number % 2]
    image = Image.new("HSV", (1, 1), (round(hue * 255 / 360), round(255 * saturation), round(255 * value)))
    r, g, b = image.convert("RGB").getpixel((0, 0))  # type: ignore[misc]
    return int(r), int(g), int(b)


def with_callouts(picture: Picture, callouts: Sequence[Callout], column_px: int) -> Picture:
    """Writes names into columns of this width at the left and the right, none over another.

    What is hidden is named in brackets, with a dashed line. Names that find no room in either column are
    counted in a last line.
    """
    image = Image.fromarray(picture)
    draw = ImageDraw.Draw(image)
    height, width = picture.shape[:2]
    top, bottom = 2 * _LINE_PX, height - 4 * _LINE_PX
    rows = max(1, (bottom - top) // _LINE_PX)
    left, right, left_out = _columns(callouts, width, rows)
    places: list[tuple[Callout, float, bool]] = []
    for column, is_left in ((left, True), (right, False)):
        heights = spread_out([float(c.pixel[1]) for c in column], float(_LINE_PX), float(top), float(bottom))
        places += [(callout, y, is_left) for callout, y in zip(column, heights, strict=True)]
    for callout, y, is_left in places:
        _lead(
            draw,
            callout,
            y,
            column_px if is_left else width - column_px,
            _EDGE_PX if is_left else width - _EDGE_PX,
        )
    for callout, y, is_left in places:
        _write(draw, callout, y, width, column_px, is_left=is_left)
    if any(callout.hidden for callout in callouts):
        text = "in brackets: behind something"
        draw.text((_EDGE_PX, bottom + 2 * _LINE_PX - 6), text, fill=_FAINT, font=_font())
    if left_out:
        text = f"and {left_out} more regions without room for a name"
        draw.text((_EDGE_PX, bottom + _LINE_PX), text, fill=_FAINT, font=_font())
    return np.array(image)


def spread_out(wanted: Sequence[float], gap: float, low: float, high: float) -> list[float]:
    """Places in ascending order, near the wanted ones (ascending), `gap` apart, within [low, high].

    Blocks of places that touch share the mean of what they want, as in isotonic regression.
    """
    blocks: list[tuple[float, int]] = []  # mean of the places less their offsets, and how many
    for i, place in enumerate(wanted):
        mean, count = place - gap * i, 1
        while blocks and blocks[-1][0] >= mean:
            other, more = blocks.pop()
            mean, count = (mean * count + other * more) / (count + more), count + more
        blocks.append((mean, count))
    flat = [mean for mean, count in blocks for _ in range(count)]
    most = high - gap * (len(wanted) - 1)
    return [min(max(mean, low), most) + gap * i for i, mean in enumerate(flat)]


def with_axes(picture: Picture, origin: Array, ends: Array, label: str, *, is_at_origin: bool) -> Picture:
    """Draws the axes of a frame over everything.

    Args:
        picture: what is drawn over.
        origin: pixel (2,) at which they begin.
        ends: pixels (3, 2) of the tips of x, y and z.
        label: whose axes they are.
        is_at_origin: whether they begin where the frame's origin is; in a corner else.
    """
    image = Image.fromarray(picture)
    draw = ImageDraw.Draw(image)
    font = _font()
    for end, (name, colour) in zip(ends, _AXES, strict=True):
        draw_arrow(draw, origin, end, 9.0, colour)
        way = end - origin
        x, y = end + 11.0 * way / max(float(np.linalg.norm(way)), 1.0)
        draw.text((x, y), name, fill=colour, font=font, anchor="mm", stroke_width=2, stroke_fill="white")
    place = "" if is_at_origin else ", in a corner as its origin is out of sight"
    draw.text(
        (_EDGE_PX, picture.shape[0] - _LINE_PX - 4),
        f"axes: frame of the {label}{place}",
        fill=_FAINT,
        font=font,
        stroke_width=2,
        stroke_fill="white",
    )
    return np.array(image)


def with_scale_bar(picture: Picture, metres_per_px: float) -> Picture:
    """Draws a bar of a round length with that length in mm, at the lower right."""
    image = Image.fromarray(picture)
    draw = ImageDraw.Draw(image)
    height, width = picture.shape[:2]
    length = round_length(_BAR_SHARE * width * metres_per_px)
    pixels = length / metres_per_px
    x1, y = width - 2 * _EDGE_PX, height - 2 * _EDGE_PX
    for colour, more in (("white", 2), (_INK, 0)):
        draw.line((x1 - pixels - more, y, x1 + more, y), fill=colour, width=3 + 2 * more)
        for x in (x1 - pixels, x1):
            draw.line((x, y - 5 - more, x, y + 5 + more), fill=colour, width=2 + 2 * more)
    text = f"{1e3 * length:g} mm"
    draw.text(
        (x1 - 0.5 * pixels, y - 8), text, fill=_INK, font=_font(), anchor="mb", stroke_width=2,
        stroke_fill="white",
    )  # fmt: skip
    return np.array(image)


def round_length(most: float) -> float:
    """The largest of 1, 2 and 5 times a power of ten that is at most `most`."""
    power = 10.0 ** np.floor(np.log10(most))
    return float(power * max(step for step in (1.0, 2.0, 5.0) if step * power <= most * (1.0 + 1e-9)))


def with_title(picture: Picture, title: str) -> Picture:
    """Writes a line at the top, and rules a line at the right edge."""
    image = Image.fromarray(picture)
    draw = ImageDraw.Draw(image)
    height, width = picture.shape[:2]
    font = ImageFont.load_default(_FONT_PX + 3)
    text = _shortened(draw, printable(title), width - 2 * _EDGE_PX, font)
    draw.text((_EDGE_PX, 6), text, fill=_INK, font=font, stroke_width=2, stroke_fill="white")
    draw.line((width - 1, 0, width - 1, height), fill=(225, 228, 232))
    return np.array(image)


def _columns(callouts: Sequence[Callout], width: int, rows: int) -> tuple[list[Callout], list[Callout], int]:
    """Who goes to the left and who to the right, each from top to bottom, and how many to neither."""
    in_order = sorted(callouts, key=lambda c: float(c.pixel[0]))
    left_out = max(0, len(in_order) - 2 * rows)
    if left_out:  # those in the middle have the longest way to a column
        in_order = in_order[:rows] + in_order[-rows:]
    on_left = sum(float(c.pixel[0]) < 0.5 * width for c in in_order)
    on_left = min(max(on_left, len(in_order) - rows), rows)
    left, right = in_order[:on_left], in_order[on_left:]
    by_height = [sorted(column, key=lambda c: float(c.pixel[1])) for column in (left, right)]
    return by_height[0], by_height[1], left_out


def _lead(draw: ImageDraw.ImageDraw, callout: Callout, y: float, bend: float, end: float) -> None:
    """The line from a name at height `y`: along its column until `bend`, then to what it names."""
    x1, y1 = (float(p) for p in callout.pixel)
    for colour, width in (((255, 255, 255), 3), (callout.colour, 1)):
        draw.line((end, y, bend, y), fill=colour, width=width)
        _line(draw, (bend, y, x1, y1), colour, width, dashed=callout.hidden)
    if not callout.hidden:
        draw.ellipse((x1 - 3, y1 - 3, x1 + 3, y1 + 3), fill=callout.colour, outline="white")


def _write(
    draw: ImageDraw.ImageDraw, callout: Callout, y: float, width: int, column_px: int, *, is_left: bool
) -> None:
    """A name with its swatch at height `y` of its column, over all lines."""
    font = _font()
    text = _shortened(draw, printable(callout.text), column_px - 4 * _EDGE_PX - _SWATCH_PX, font)
    text = f"({text})" if callout.hidden else text
    half = 0.5 * _SWATCH_PX
    if is_left:
        swatch, at, anchor = _EDGE_PX, 2 * _EDGE_PX + _SWATCH_PX, "lm"
    else:
        swatch, at, anchor = width - _EDGE_PX - _SWATCH_PX, width - 2 * _EDGE_PX - _SWATCH_PX, "rm"
    # White paper behind the name hides the lines that pass there.
    x0, y0, x1, y1 = draw.textbbox((at, y), text, font=font, anchor=anchor)
    draw.rectangle((min(x0, swatch) - 3, y0 - 1, max(x1, swatch + _SWATCH_PX) + 3, y1 + 1), fill="white")
    draw.rectangle((swatch, y - half, swatch + _SWATCH_PX, y + half), fill=callout.colour)
    draw.text((at, y), text, fill=_FAINT if callout.hidden else _INK, font=font, anchor=anchor)


def _line(
    draw: ImageDraw.ImageDraw,
    ends: tuple[float, float, float, float],
    colour: tuple[int, int, int],
    width: int,
    *,
    dashed: bool,
) -> None:
    if not dashed:
        draw.line(ends, fill=colour, width=width)
        return
    x0, y0, x1, y1 = ends
    count = max(1, int(np.hypot(x1 - x0, y1 - y0) / 8.0))
    for k in range(count):
        a, b = k / count, (k + 0.5) / count
        dash = (x0 + a * (x1 - x0), y0 + a * (y1 - y0), x0 + b * (x1 - x0), y0 + b * (y1 - y0))
        draw.line(dash, fill=colour, width=width)


def _shortened(
    draw: ImageDraw.ImageDraw, text: str, width: float, font: ImageFont.FreeTypeFont | ImageFont.ImageFont
) -> str:
    """The text, without its middle where it is too long; names often differ at their ends."""
    if draw.textlength(text, font=font) <= width:
        return text
    for kept in range(len(text) - 1, 1, -1):
        shorter = f"{text[: kept - kept // 2]}…{text[len(text) - kept // 2 :]}"
        if draw.textlength(shorter, font=font) <= width:
            return shorter
    return "…"


def _font() -> ImageFont.FreeTypeFont | ImageFont.ImageFont:
    return ImageFont.load_default(_FONT_PX)
