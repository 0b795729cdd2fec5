"""Pictures as data URIs, for a page that needs no other file."""

import base64
import io
from pathlib import Path

from markupsafe import Markup
from PIL import Image

from .pictures import picture_bytes

__all__ = ["embed_picture"]


def embed_picture(path: Path, size: tuple[int, int] | None = None) -> Markup | None:
    """A picture as a data URI, no larger than `size`; None where there is none that this run has drawn."""
    data = picture_bytes(path)
    if data is None:
        return None
    if size is not None:
        with Image.open(io.BytesIO(data)) as image:
            image.thumbnail(size)
            buffer = io.BytesIO()
            image.save(buffer, "PNG")  # a few bytes less would cost three times as much
            data = buffer.getvalue()
    kind = "webp" if path.suffix == ".webp" else "png"
    return Markup(f"data:image/{kind};base64,{base64.b64encode(data).decode()}")
