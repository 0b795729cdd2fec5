"""Pictures as files."""

import io
from pathlib import Path

from PIL import Image

from ...arrays import Picture
from ...files import write_bytes

__all__ = ["write_png"]


def write_png(path: Path, picture: Picture) -> None:
    """Writes a picture (height, width, 3) whole or not at all."""
    buffer = io.BytesIO()
    Image.fromarray(picture).save(buffer, "PNG")
    write_bytes(path, buffer.getvalue())
