"""Mesh files as exporters write them, brought to the form that readers of meshes take.

Nothing of the shape changes. What is odd: tabs and comments, bytes behind the end, a missing last line,
polygons of several sizes in one list, strips of triangles, coordinates as shares of a whole number, decimal
commas, textures of some faces of a PLY file.
"""

import json
import re
import struct
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from .mesh_guard import check_mesh, glb_content

__all__ = ["checked_mesh", "mended_mesh"]

_STL_HEADER, _STL_FACE = 84, 50
_OBJ_MARGIN = re.compile(rb"(?m)^[ \t]+")
_COMMA = re.compile(rb"(?m)(?:(?<=[ \t])|^)([+-]?\d*),(\d+(?:[eE][+-]?\d+)?)(?=\s|\Z)")
_COMMA_IN_XML = re.compile(rb"(?<=[\s>\"])([+-]?\d*),(\d+(?:[eE][+-]?\d+)?)(?=[\s<\"])")
_COMMA_IN_VERTEX = re.compile(rb"(?m)^[ \t]*(v|vertex)[ \t][^\r\n#]*,[^\r\n]*")
_PLY_END = re.compile(rb"end_header\r?\n")
_OFF_COMMENT, _EMPTY_LINES = re.compile(rb"#[^\r\n]*"), re.compile(rb"(?:[ \t]*\r?\n)+[ \t]*")
_PLY_TYPES = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}
_PLY_CORNERS = ("vertex_indices", "vertex_index")
# How scanners say triangles: each corner of a strip makes one with the two before it; -1 ends a strip.
_PLY_STRIPS = "tristrips"
# Of whole numbers in GLB, by their code: how numpy writes them, and what stands for 1.
_GLB_WHOLE = {5120: ("i1", 127.0), 5121: ("u1", 255.0), 5122: ("<i2", 32767.0), 5123: ("<u2", 65535.0)}
_GLB_FLOAT = 5126


def checked_mesh(data: bytes, kind: str, *, largest: int) -> bytes:
    """The bytes of a mesh file for a reader to take: looked at, then mended.

    Args:
        data: the file.
        kind: its suffix without the dot, in small letters.
        largest: how many triangles it may describe.

    Raises:
        ValueError: saying what is wrong.
    """
    check_mesh(data, kind, largest=largest)
    return mended_mesh(data, kind)


def mended_mesh(data: bytes, kind: str) -> bytes:
    """The bytes of a mesh file in a form that readers take; as they are where nothing is odd.

    Args:
        data: the file.
        kind: its suffix without the dot, in small letters.

    Raises:
        ValueError: a file that is cut short.
    """
    match kind:
        case "stl":
            return _mended_stl(data)
        case "obj":
            return _with_points(_OBJ_MARGIN.sub(b"", data).replace(b"\t", b" "))
        case "off":
            data = _EMPTY_LINES.sub(b"\n", _OFF_COMMENT.sub(b"", data)).lstrip()
            return _mended_off(_with_points(data))
        case "ply":
            return _mended_ply(data)
        case "glb":
            return _mended_glb(data)
        case "dae":
            return _COMMA_IN_XML.sub(rb"\1.\2", data)
    return data


def _mended_stl(data: bytes) -> bytes:
    """Without bytes behind the last triangle; with a last line, where text has none."""
    if b"\0" in data[: _STL_HEADER + _STL_FACE]:  # no text
        end = _STL_HEADER + _STL_FACE * int.from_bytes(data[_STL_HEADER - 4 : _STL_HEADER], "little")
        return data[:end]
    is_text = data[:5].lower() == b"solid"
    data = _with_points(data) if is_text else data
    return data + b"\nendsolid\n" if is_text and b"endsolid" not in data[-200:].lower() else data


def _with_points(text: bytes) -> bytes:
    """With decimal points, where numbers between spaces have decimal commas.

    Raises:
        ValueError: commas elsewhere in a corner.
    """
    if b"," not in text:
        return text
    text = _COMMA.sub(rb"\1.\2", text)
    if odd := _COMMA_IN_VERTEX.search(text):
        said = odd.group(0).strip()[:60].decode("utf-8", "replace")
        raise ValueError(f"{said!r} has commas: coordinates stand between spaces, with decimal points")
    return text


def _mended_off(data: bytes) -> bytes:
    """With triangles alone, where a file has polygons of more corners than four."""
    lines = data.split(b"\n")
    head = 1 if len(lines[0].split()) >= 4 else 2  # counts behind the keyword, or in a line of their own
    counts = lines[head - 1].split()[-3:]
    if not data[:1].isalpha() or len(counts) < 2 or not all(count.isdigit() for count in counts):
        return data
    first, faces = head + int(counts[0]), int(counts[1])
    polygons = [line.split() for line in lines[first : first + faces]]
    if not all(row and row[0].isdigit() for row in polygons) or max(map(_size, polygons), default=0) <= 4:
        return data
    triangles = [
        b" ".join([b"3", row[1], row[k], row[k + 1]])
        for row in polygons
        for k in range(2, min(_size(row), len(row) - 1))
    ]
    keyword = lines[0].split()[0]
    return b"\n".join(
        [keyword, b"%s %d 0" % (counts[0], len(triangles)), *lines[head:first], *triangles, b""]
    )


def _size(row: list[bytes]) -> int:
    """How many corners a line says that a polygon has."""
    return int(row[0])


class _Element(NamedTuple):
    """An element of a PLY file: its name, how many there are, and its properties.

    A property has a name, a type, and for lists a type of the length.
    """

    name: str
    rows: int
    properties: list[tuple[str, str, str | None]]


def _mended_ply(data: bytes) -> bytes:
    """With triangles alone, where polygons have several sizes or are strips, or faces more than corners."""
    found = _PLY_END.search(data)
    if found is None:
        return data
    head, end, body = data[: found.start()], found.group(0), data[found.end() :]
    lines = [line.split() for line in head.decode("ascii", "replace").splitlines()]
    if ["format", "ascii", "1.0"] in lines:
        return _mended_text_ply(head, end, body, list(_elements(lines)))
    order = {"binary_little_endian": "<", "binary_big_endian": ">"}.get(
        next((line[1] for line in lines if line[:1] == ["format"] and len(line) > 1), "")
    )
    if order is None:
        return data
    elements = list(_elements(lines))
    names = [element.name for element in elements]
    kind = _kind_of_faces(names)
    if "vertex" not in names or kind not in names or names.index("vertex") > names.index(kind):
        return data
    at = 0
    for element in elements[: names.index(kind)]:
        if any(length is not None for _, _, length in element.properties):
            return data
        at += element.rows * sum(np.dtype(kind).itemsize for _, kind, _ in element.properties)
    faces = elements[names.index(kind)]
    if kind != _PLY_STRIPS and _are_alike(body, at, faces, order):
        return data
    triangles = _triangles(_corners(body, at, faces, order), kind)
    rows = np.zeros(len(triangles), dtype=[("n", "u1"), ("corners", f"{order}i4", 3)])
    rows["n"], rows["corners"] = 3, triangles
    return _with_triangles(head, kind, len(triangles)) + end + body[:at] + rows.tobytes()


def _kind_of_faces(names: list[str]) -> str:
    """The element of a PLY file that has its triangles."""
    return _PLY_STRIPS if _PLY_STRIPS in names and "face" not in names else "face"


def _with_triangles(head: bytes, kind: str, count: int) -> bytes:
    """The head of a PLY file, up to its faces, which are of that element: so many triangles."""
    cut = head.index(f"element {kind}".encode())
    return head[:cut] + f"element face {count}\nproperty list uchar int vertex_indices\n".encode()


def _triangles(polygons: list[tuple[int, ...]], kind: str) -> list[tuple[int, int, int]]:
    if kind == _PLY_STRIPS:
        return [triangle for strips in polygons for triangle in _unrolled(strips)]
    return [
        (polygon[0], polygon[k], polygon[k + 1]) for polygon in polygons for k in range(1, len(polygon) - 1)
    ]


def _unrolled(strips: tuple[int, ...]) -> Iterator[tuple[int, int, int]]:
    """The triangles of strips; every second one of a strip winds the other way round there."""
    start = 0
    for k, corner in enumerate(strips):
        if corner < 0:
            start = k + 1
        elif k - start >= 2:
            a, b = strips[k - 2 : k]
            yield (a, b, corner) if (k - start) % 2 == 0 else (b, a, corner)


def _mended_text_ply(head: bytes, end: bytes, body: bytes, elements: list["_Element"]) -> bytes:
    """With triangles alone, where the faces of a text have more than their corners."""
    body = _with_points(body)
    kind = _kind_of_faces([element.name for element in elements])
    faces = next((element for element in elements if element.name == kind), None)
    if faces is None or (len(faces.properties) < 2 and kind != _PLY_STRIPS):
        return head + end + body
    lines = [line for line in body.splitlines() if line.strip()]
    first = 0
    for element in elements[: elements.index(faces)]:
        first += element.rows
    polygons = [_text_corners(line.split(), faces) for line in lines[first : first + faces.rows]]
    rows = [b"3 %d %d %d" % triangle for triangle in _triangles(polygons, kind)]
    return b"\n".join([_with_triangles(head, kind, len(rows)) + end.strip(), *lines[:first], *rows, b""])


def _text_corners(words: list[bytes], faces: "_Element") -> tuple[int, ...]:
    """Vertices of a polygon in the line of a face."""
    at, corners = 0, tuple[int, ...]()
    for name, _, length in faces.properties:
        count = 1
        if length is not None:
            count = int(words[at])
            at += 1
        if name in _PLY_CORNERS:
            corners = tuple(int(word) for word in words[at : at + count])
        at += count
    return corners


def _elements(lines: list[list[str]]) -> Iterator[_Element]:
    """The elements that the head of a PLY file lists."""
    found: _Element | None = None
    try:
        for line in lines:
            if line[:1] == ["element"]:
                if found is not None:
                    yield found
                found = _Element(line[1], int(line[2]), [])
            elif line[:2] == ["property", "list"] and found is not None:
                found.properties.append((line[4], _PLY_TYPES[line[3]], _PLY_TYPES[line[2]]))
            elif line[:1] == ["property"] and found is not None:
                found.properties.append((line[2], _PLY_TYPES[line[1]], None))
    except (IndexError, KeyError):
        raise ValueError("its head is not what PLY allows") from None
    if found is not None:
        yield found


def _are_alike(body: bytes, at: int, faces: _Element, order: str) -> bool:
    """Whether all rows of faces have lists as long as those of the first, which readers take for granted."""
    if faces.rows == 0:
        return True
    fields: list[Any] = []
    lengths: list[int] = []
    there = at
    for number, (_, kind, length) in enumerate(faces.properties):
        count = 1
        if length is not None:
            count = int(np.frombuffer(body, order + length, 1, there)[0])
            there += np.dtype(length).itemsize
            fields.append((f"n{number}", order + length))
            lengths.append(count)
        fields.append((f"x{number}", order + kind, count))
        there += count * np.dtype(kind).itemsize
    row = np.dtype(fields)
    if len(body) < at + faces.rows * row.itemsize:
        return False
    rows = np.frombuffer(body, row, faces.rows, at)
    names = [name for name in rows.dtype.names or () if name.startswith("n")]
    return all(bool((rows[name] == n).all()) for name, n in zip(names, lengths, strict=True))


def _corners(body: bytes, at: int, faces: _Element, order: str) -> list[tuple[int, ...]]:
    """Vertices of each polygon in the body of a binary PLY file, from a byte on."""
    found: list[tuple[int, ...]] = []
    properties = [
        (name in _PLY_CORNERS, np.dtype(order + kind), None if length is None else np.dtype(order + length))
        for name, kind, length in faces.properties
    ]
    for _ in range(faces.rows):
        for is_corners, kind, length in properties:
            count = 1
            if length is not None:
                count = int(np.frombuffer(body, length, 1, at)[0])
                at += length.itemsize
            if is_corners:
                found.append(tuple(np.frombuffer(body, kind, count, at).tolist()))
            at += count * kind.itemsize
    return found


def _mended_glb(data: bytes) -> bytes:
    """With coordinates as numbers of their own, where they are shares of a whole number."""
    content, start = glb_content(data)
    binary = bytearray(data[start + 8 : start + 8 + int.from_bytes(data[start : start + 4], "little")])
    places = {
        part["attributes"]["POSITION"] for mesh in content.get("meshes", []) for part in mesh["primitives"]
    }
    shares = [n for n in sorted(places) if content["accessors"][n].get("normalized")]
    if not shares:
        return data
    for number in shares:
        accessor = content["accessors"][number]
        view = content["bufferViews"][accessor["bufferView"]]
        kind, whole = _GLB_WHOLE[accessor["componentType"]]
        item = np.dtype(kind).itemsize
        first = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        step = view.get("byteStride", 3 * item)
        points = np.ndarray((accessor["count"], 3), kind, bytes(binary), first, (step, item))
        values = np.maximum(points / whole, -1.0).astype("<f4").tobytes()
        binary += b"\0" * (-len(binary) % 4)
        content["bufferViews"].append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(values)})
        binary += values
        for name in ("normalized", "min", "max", "byteOffset"):
            accessor.pop(name, None)
        accessor |= {"bufferView": len(content["bufferViews"]) - 1, "componentType": _GLB_FLOAT}
    content["buffers"][0]["byteLength"] = len(binary)
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    body = (
        struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    )
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body
