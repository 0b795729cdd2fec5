"""Pictures and videos as files."""

import io
from collections.abc import Sequence
from pathlib import Path

from PIL import Image

from ...base.files.output_file import write_bytes
from ...base.numeric.arrays import Picture

__all__ = ["write_png", "write_video"]

_FRAME_MS, _LAST_MS = 120, 1500
_QUALITY = 80


def write_png(path: Path, picture: Picture) -> None:
    """Writes a picture (height, width, 3 or 4) whole or not at all."""
    buffer = io.BytesIO()
    Image.fromarray(picture).save(buffer, "PNG")
    write_bytes(path, buffer.getvalue())


def write_video(path: Path, pictures: Sequence[Picture]) -> None:
    """Writes pictures of one size as a WebP that plays again and again; whole or not at all."""
    first, *others = (Image.fromarray(picture) for picture in pictures)
    times = [_FRAME_MS] * len(others) + [_LAST_MS]
    buffer = io.BytesIO()
    first.save(buffer, "WEBP", save_all=True, append_images=others, duration=times, loop=0, quality=_QUALITY)
    write_bytes(path, buffer.getvalue())
