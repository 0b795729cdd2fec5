"""What is wrong with a mesh file before a library reads it, or too much for that.

Readers build what a file describes before anyone can look at it: a few kilobytes of GLB may stand for
millions of copies of a mesh. They take the index 0 of an OBJ file, which counts from 1, for the last vertex.
"""

import json
import re
import struct
from collections import Counter
from typing import Any

from .collada_file import check_collada

__all__ = ["READER_ERRORS", "check_mesh", "glb_content"]

READER_ERRORS = (
    ArithmeticError,
    AssertionError,
    AttributeError,
    EOFError,
    ImportError,
    LookupError,
    MemoryError,
    NameError,
    OSError,
    RuntimeError,
    TypeError,
    ValueError,
    struct.error,
)
"""What readers of meshes raise on files that are cut short, garbled or of another kind."""

_MOST_NODES = 100_000
_ZERO_INDEX = re.compile(rb"(?m)^[ \t]*f(?:[ \t]+[^ \t\r\n]+)*?[ \t]+[+-]?0+(?:/|[ \t\r]|$)")


def check_mesh(data: bytes, kind: str, *, largest: int) -> None:
    """Looks at the bytes of a mesh file.

    Args:
        data: the file.
        kind: its suffix without the dot, in small letters.
        largest: how many triangles it may describe.

    Raises:
        ValueError: saying what is wrong.
    """
    if kind == "obj" and _ZERO_INDEX.search(data):
        raise ValueError("a face has the index 0, and OBJ counts from 1")
    if kind == "dae":
        check_collada(data, largest=largest)
    if kind == "glb":
        try:
            _check_glb(glb_content(data)[0], 3 * largest)
        except (TypeError, KeyError, IndexError, AttributeError, RecursionError):
            raise ValueError("its description is not what glTF allows") from None


def glb_content(data: bytes) -> tuple[dict[str, Any], int]:
    """The description that a GLB file begins with, and where that ends.

    Raises:
        ValueError: it is no GLB file.
    """
    if data[:4] == b"glTF" and int.from_bytes(data[4:8], "little") == 1:
        raise ValueError("it is a GLB file of glTF 1.0, which is no longer read: export it as glTF 2.0")
    length = int.from_bytes(data[12:16], "little")
    if data[:4] != b"glTF" or data[16:20] != b"JSON" or len(data) < 20 + length:
        raise ValueError("it is no GLB file, or is cut short")
    content: dict[str, Any] = json.loads(data[20 : 20 + length])
    return content, 20 + length


def _check_glb(content: dict[str, Any], most_indices: int) -> None:
    nodes, meshes, accessors = (content.get(key, []) for key in ("nodes", "meshes", "accessors"))
    if len(nodes) > _MOST_NODES:
        raise ValueError(f"it has more than {_MOST_NODES} nodes")
    counts = [_count(accessor["count"]) for accessor in accessors]
    packed = [name for name in content.get("extensionsRequired", []) if "compression" in str(name)]
    if packed:
        raise ValueError(f"it is compressed by {str(packed[0])[:80]}: export it without compression")
    if any("bufferView" not in accessor or "sparse" in accessor for accessor in accessors):
        raise ValueError("it has numbers without a buffer, or sparse ones, which are not read")
    if sum(counts) > 2 * most_indices:
        raise ValueError("it has too many numbers")
    _check_forest(nodes)
    size_of = [sum(_indices(part, counts) for part in mesh["primitives"]) for mesh in meshes]
    instances = Counter(node["mesh"] for node in nodes if "mesh" in node)
    placed = sum(times * size_of[_count(mesh)] for mesh, times in instances.items())
    if max(placed, sum(size_of)) > most_indices:
        raise ValueError(f"it describes more than {most_indices // 3} triangles")


def _indices(primitive: dict[str, Any], counts: list[int]) -> int:
    vertices = counts[_count(primitive["attributes"]["POSITION"])]
    return max(vertices, counts[_count(primitive["indices"])] if "indices" in primitive else 0)


def _check_forest(nodes: list[dict[str, Any]]) -> None:
    """Each node hangs on one other at most, and none on itself: a reader would walk along for ever."""
    parent: dict[int, int] = {}
    for number, node in enumerate(nodes):
        for child in node.get("children", []):
            if _count(child) >= len(nodes) or child in parent:
                raise ValueError("a node hangs on two others, or is missing")
            parent[child] = number
    seen = set[int]()
    for start in range(len(nodes)):
        way = set[int]()
        here: int | None = start
        while here is not None and here not in seen:
            if here in way:
                raise ValueError("nodes hang on each other in a circle")
            way.add(here)
            here = parent.get(here)
        seen |= way


def _count(value: Any) -> int:
    if type(value) is not int or value < 0:
        raise ValueError("a count or number in its description is not a whole number")
    return value
