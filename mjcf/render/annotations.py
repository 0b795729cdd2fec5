"""What is drawn onto pictures: rings around contacts, captions, the arrow of gravity."""

from collections.abc import Sequence

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from ...base.numeric.arrays import Array, Picture
from .camera import Camera

__all__ = ["draw_arrow", "with_caption", "with_rings"]


_RING = (214, 48, 36)
_ARROW = (40, 44, 52)
_INK = (60, 64, 72)
_DASHES = 4


def with_rings(picture: Picture, pixels: Array, in_sight: Sequence[bool]) -> Picture:
    """The picture with rings around places (n, 2); dashed around those that are not in sight."""
    image = Image.fromarray(picture)
    draw = ImageDraw.Draw(image)
    radius = max(5, picture.shape[0] // 50)
    for (x, y), whole in zip(pixels, in_sight, strict=True):
        pitch = 360.0 / _DASHES
        arcs = [(0.0, 360.0)] if whole else [((k - 0.25) * pitch, (k + 0.25) * pitch) for k in range(_DASHES)]
        for r, colour in ((radius + 1, (255, 255, 255)), (radius, _RING)):
            for start, end in arcs:
                draw.arc((x - r, y - r, x + r, y + r), start, end, fill=colour, width=2)
    return np.array(image)


def with_caption(picture: Picture, label: str, gravity: Array | None, camera: Camera) -> Picture:
    """Adds a line of text, and an arrow along gravity, which shrinks as gravity points at the camera."""
    image = Image.fromarray(picture)
    draw = ImageDraw.Draw(image)
    height, width = picture.shape[:2]
    font = ImageFont.load_default(max(11, height // 22))
    draw.text((8, 6), label, fill=_INK, font=font, stroke_width=2, stroke_fill="white")
    if gravity is not None:
        step = camera.axes[:2] @ gravity * [1.0, -1.0] * 0.11 * height
        middle = np.array([width - 0.15 * height, height - 0.15 * height])
        draw_arrow(draw, middle - step, middle + step, 0.035 * height, _ARROW)
    draw.line((width - 1, 0, width - 1, height), fill=(225, 228, 232))
    return np.array(image)


def draw_arrow(
    draw: ImageDraw.ImageDraw, start: Array, end: Array, head: float, ink: tuple[int, int, int]
) -> None:
    """An arrow between pixels (2,), with a head of `head` pixels; nothing where they are the same."""
    along = end - start
    length = float(np.linalg.norm(along))
    if length < 1e-6:
        return
    along /= length
    head = min(head, length)
    across = np.array([-along[1], along[0]])
    # First wider and white, so that the arrow stands out from whatever is behind it.
    for colour, more in (("white", 2.0), (ink, 0.0)):
        neck = end - head * along
        draw.line((*(start - more * along), *neck), fill=colour, width=round(3 + 2 * more))
        wing = (0.5 * head + 1.5 * more) * across
        corners = [end + 2.0 * more * along, neck - more * along + wing, neck - more * along - wing]
        draw.polygon([(float(x), float(y)) for x, y in corners], fill=colour)
