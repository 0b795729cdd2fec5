"""What a browser may do for the page: show it with its own style and pictures, and nothing else."""

import base64
import hashlib
from collections.abc import Sequence

__all__ = ["content_policy"]


def content_policy(
    styles: Sequence[str], scripts: Sequence[str] = (), *, images: Sequence[str] = ("data:",)
) -> str:
    """The Content-Security-Policy of a page.

    Args:
        styles: contents of its style elements, to the last character.
        scripts: contents of its script elements.
        images: where its pictures may come from, in the policy's own words.
    """
    rules = {
        "default-src": ["'none'"],
        "img-src": list(images),
        "style-src": [_hash(text) for text in styles] or ["'none'"],
        "script-src": [_hash(text) for text in scripts] or ["'none'"],
        "base-uri": ["'none'"],
        "form-action": ["'none'"],
    }
    return "; ".join(f"{name} {' '.join(sources)}" for name, sources in rules.items())


def _hash(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode('utf-8')).digest()).decode()}'"
