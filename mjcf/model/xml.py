"""Small helpers to write MJCF: numbers, names, elements, text."""

import re
import xml.etree.ElementTree as ET
from collections.abc import Iterable
from functools import lru_cache

import numpy as np

from ...base.numeric.arrays import Array, Indices
from ...errors import InputError
from ...geometry import mujoco_pose

__all__ = ["check_names", "element", "face_text", "numbers", "pose_attributes", "to_text", "vertex_text"]

# What XML can't carry at all, even escaped.
_UNPRINTABLE = re.compile(r"[\x00-\x1f\x7f\ud800-\udfff\ufffe\uffff]")
# Names that the model uses itself or that MuJoCo keeps for itself.
_RESERVED = frozenset({"world", "object", "stand", "main"})


def numbers(values: Iterable[float] | Array, *, digits: int = 13) -> str:
    """Numbers for an attribute with so many significant digits; 13 are exact to 1e-12 of their size."""
    flat = np.ravel(np.asarray(values, dtype=float))
    # What lies below 1e-16 in SI units is rounding; adding zero turns -0 into 0: equal models, equal text.
    return " ".join(f"{round(float(value), 16) + 0.0:.{digits}g}" for value in flat)


def vertex_text(vertices: Array) -> str:
    """Vertices (n, 3) of a mesh asset with 9 digits, as MuJoCo keeps single precision."""
    return _vertex_text(np.ascontiguousarray(vertices, dtype=float).tobytes())


def face_text(faces: Indices) -> str:
    """Faces (n, 3) of a mesh asset."""
    return _face_text(np.ascontiguousarray(faces, dtype=np.int64).tobytes())


# The same meshes are written with every grasp of a run, and take longer than all the rest of its model.
@lru_cache(maxsize=128)
def _vertex_text(data: bytes) -> str:
    return numbers(np.frombuffer(data), digits=9)


@lru_cache(maxsize=32)
def _face_text(data: bytes) -> str:
    return " ".join(map(str, np.frombuffer(data, dtype=np.int64).tolist()))


def pose_attributes(T: Array) -> dict[str, str]:
    """`pos` and `quat` of a pose (4, 4), left out where they are those of the identity."""
    return {name: numbers(values) for name, values in mujoco_pose(T).items()}


def element(parent: ET.Element, tag: str, **attributes: str) -> ET.Element:
    """A new child of `parent`; a trailing underscore of an attribute's name falls away (`class_`)."""
    return ET.SubElement(parent, tag, {name.rstrip("_"): value for name, value in attributes.items()})


def to_text(root: ET.Element) -> str:
    """The document, indented by two spaces."""
    ET.indent(root, "  ")
    return ET.tostring(root, encoding="unicode") + "\n"


def check_names(names: Iterable[str], *, source: str, kind: str) -> None:
    """Refuses names that a model can't carry: they may come from any user's file.

    Raises:
        InputError: naming the first one at fault.
    """
    seen = set()
    for name in names:
        if not name or _UNPRINTABLE.search(name):
            raise InputError(source, "", f"{kind} {name!r}: a name must be printable and not empty")
        if name in _RESERVED:
            raise InputError(source, "", f"{kind} {name!r}: this name is reserved in the simulation model")
        if name in seen:
            raise InputError(source, "", f"{kind} {name!r} stands twice")
        seen.add(name)
