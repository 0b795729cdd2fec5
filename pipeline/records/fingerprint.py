"""A short hash of what a task, a hand or an object says, by which it is recognised."""

import hashlib
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
import trimesh

from ...hands import Hand
from ...objects import ObjectModel, Task

__all__ = ["fingerprint"]

# Words, colours and frames for people, and what is allowed of a region, change no result.
_LEFT_OUT = ("description", "sources", "notes", "rgba", "paint", "off_surface", "frames")


def fingerprint(model: Task | Hand | ObjectModel) -> str:
    """Hash (16 hex digits) of all that a result depends on; of a task: hand, object, regions and limits.

    Files are not looked at, so a comment changed in a task file leaves the fingerprint as it is.
    """
    digest = hashlib.sha256()
    _feed(digest, model)
    return digest.hexdigest()[:16]


def _feed(digest: Any, value: Any) -> None:
    # Each value is led by its kind and length, so that no two trees of values read the same.
    if is_dataclass(value):
        digest.update(f"<{type(value).__name__}".encode())
        for entry in fields(value):
            if entry.name not in _LEFT_OUT:
                digest.update(entry.name.encode())
                _feed(digest, getattr(value, entry.name))
    elif isinstance(value, trimesh.Trimesh):
        _feed(digest, np.asarray(value.vertices))
        _feed(digest, np.asarray(value.faces))
    elif isinstance(value, np.ndarray):
        digest.update(f"[{value.shape}{value.dtype}".encode())
        digest.update(np.ascontiguousarray(value).tobytes())
    elif isinstance(value, dict):
        digest.update(f"{{{len(value)}".encode())
        for key in sorted(value):
            _feed(digest, key)
            _feed(digest, value[key])
    elif isinstance(value, (tuple, list)):
        digest.update(f"({len(value)}".encode())
        for item in value:
            _feed(digest, item)
    elif value is None or isinstance(value, (str, int, float, np.generic)):
        digest.update(f"={type(value).__name__}:{value!r};".encode())
    else:
        raise TypeError(f"no fingerprint for {type(value).__name__}")
