"""3MF files, as slicers and printers of parts write them: the triangles of what is built, in m.

A file is an archive of XML documents: objects are meshes, or are made of other objects, and what is built are
objects with a pose each. Other documents of the archive may hold objects as well (the production extension).
What supports a print, or is none of the solid (`other`, such as modifiers), is left out.
"""

import zipfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from io import BytesIO
from xml.parsers import expat

import numpy as np
import trimesh
from numpy.typing import NDArray

from .xml_file import parse_xml

__all__ = ["read_3mf"]

_CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02 "
_PATH = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06 path"
_ROOT_TYPE = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
_UNITS_M = {
    "micron": 1e-6,
    "millimeter": 1e-3,
    "centimeter": 1e-2,
    "inch": 0.0254,
    "foot": 0.3048,
    "meter": 1.0,
}
_LEFT_OUT = ("support", "other")
# What the documents of an archive may come to: some hundred bytes for each of a million triangles.
_LARGEST_BYTES = 256 * 1024 * 1024
_MOST_COPIES = 10_000


@dataclass
class _Object:
    """A mesh in units of its document, with what it is made of: path, identifier and pose of each."""

    vertices: list[tuple[float, float, float]] = field(default_factory=list)
    faces: list[tuple[int, int, int]] = field(default_factory=list)
    parts: list["_Part"] = field(default_factory=list)
    is_solid: bool = True


@dataclass(frozen=True, eq=False)
class _Part:
    """An object at a place.

    Attributes:
        path: of its document in the archive.
        name: its identifier there.
        T: (4, 4) its pose in the units of where it is placed.
    """

    path: str
    name: str
    T: NDArray[np.float64]


@dataclass
class _Document:
    unit_m: float = 1e-3
    objects: dict[str, _Object] = field(default_factory=dict)
    built: list[_Part] = field(default_factory=list)


def read_3mf(data: bytes, *, largest: int) -> trimesh.Trimesh:
    """The triangles of what a file builds, in m.

    Args:
        data: the file.
        largest: how many triangles it may describe, with all copies of them.

    Raises:
        ValueError: saying what is wrong.
    """
    try:
        with zipfile.ZipFile(BytesIO(data)) as archive:
            return _Reader(archive, largest).read()
    except RecursionError:
        raise ValueError("its objects are made of others too many times over") from None
    except (zipfile.BadZipFile, zlib.error, expat.ExpatError) as error:
        raise ValueError(f"it is no 3MF file: {error}") from None


class _Reader:
    def __init__(self, archive: zipfile.ZipFile, largest: int):
        self._archive, self._largest = archive, largest
        self._left_bytes, self._copies = _LARGEST_BYTES, 0
        self._documents: dict[str, _Document] = {}
        self._counts: dict[tuple[str, str], int | None] = {}

    def read(self) -> trimesh.Trimesh:
        root_path = self._root_path()
        root = self._document(root_path)
        if sum(self._count(part) for part in root.built) > self._largest:
            raise ValueError(f"it describes more than {self._largest} triangles")
        vertices: list[NDArray[np.float64]] = [np.zeros((0, 3))]
        faces: list[NDArray[np.int64]] = [np.zeros((0, 3), dtype=np.int64)]
        count = 0
        for part in root.built:
            for corners, triangles in self._placed(part, np.eye(4)):
                vertices.append(root.unit_m * corners)
                faces.append(triangles + count)
                count += len(corners)
        return trimesh.Trimesh(np.concatenate(vertices), np.concatenate(faces), process=False)

    def _root_path(self) -> str:
        relations = parse_xml(self._bytes("_rels/.rels"))
        for relation in relations.iter():
            if relation.get("Type") == _ROOT_TYPE:
                return relation.get("Target", "")
        raise ValueError("its archive names no 3D model")

    def _bytes(self, path: str) -> bytes:
        try:
            about = self._archive.getinfo(path.lstrip("/"))
        except KeyError:
            raise ValueError(f"its archive has no {path[:80]!r}") from None
        if about.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise ValueError(f"{path[:80]!r} is packed in a way that 3MF does not allow")
        with self._archive.open(about) as entry:
            data = entry.read(self._left_bytes + 1)
        if len(data) > self._left_bytes:
            raise ValueError(f"its documents come to more than {_LARGEST_BYTES // 2**20} MiB")
        self._left_bytes -= len(data)
        return data

    def _document(self, path: str) -> _Document:
        if path not in self._documents:
            self._documents[path] = _Parser(path, self._largest).parse(self._bytes(path))
        return self._documents[path]

    def _object(self, part: _Part) -> _Object:
        found = self._document(part.path).objects.get(part.name)
        if found is None:
            raise ValueError(f"it has no object {part.name[:40]!r}, which is built")
        return found

    def _count(self, part: _Part) -> int:
        """Triangles that an object comes to, which few lines can multiply without end."""
        key = part.path, part.name
        if key not in self._counts:
            self._counts[key] = None
            found = self._object(part)
            below = [self._count(other) for other in found.parts] if found.is_solid else []
            # An empty copy takes its time as well.
            self._counts[key] = 1 + sum(below) + (len(found.faces) if found.is_solid else 0)
        count = self._counts[key]
        if count is None:
            raise ValueError("objects are made of each other in a circle")
        return count

    def _placed(
        self, part: _Part, T: NDArray[np.float64]
    ) -> Iterator[tuple[NDArray[np.float64], NDArray[np.int64]]]:
        """Corners (n, 3) and triangles (m, 3) of an object and what it is made of, in the root's units."""
        self._copies += 1
        if self._copies > _MOST_COPIES:
            raise ValueError(f"it places more than {_MOST_COPIES} objects")
        found, T = self._object(part), T @ part.T
        if not found.is_solid:
            return
        if found.faces:
            corners = np.array(found.vertices, dtype=float).reshape(-1, 3)
            triangles = np.array(found.faces, dtype=np.int64)
            if not 0 <= triangles.min() <= triangles.max() < len(corners):
                raise ValueError("a triangle names a vertex that does not exist")
            if np.linalg.det(T[:3, :3]) < 0.0:
                triangles = triangles[:, ::-1]
            yield corners @ T[:3, :3].T + T[:3, 3], triangles
        for other in found.parts:
            yield from self._placed(other, T)


class _Parser:
    """One document, read as it comes: a tree of a million elements would take a gigabyte."""

    def __init__(self, path: str, largest: int):
        self._path, self._left = path, largest
        self._document = _Document()
        self._object = _Object()

    def parse(self, data: bytes) -> _Document:
        parser = expat.ParserCreate(namespace_separator=" ")
        parser.StartDoctypeDeclHandler = self._refuse
        parser.StartElementHandler = self._start
        try:
            parser.Parse(data, True)
        except KeyError as missing:
            raise ValueError(f"an element lacks its {missing}") from None
        return self._document

    @staticmethod
    def _refuse(*_: object) -> None:
        raise ValueError("a document type or entities are not accepted")

    def _start(self, name: str, said: dict[str, str]) -> None:
        if not name.startswith(_CORE):
            return
        match name.removeprefix(_CORE):
            case "vertex":
                self._object.vertices.append((float(said["x"]), float(said["y"]), float(said["z"])))
            case "triangle":
                self._left -= 1
                if self._left < 0:
                    raise ValueError("it has too many triangles")
                self._object.faces.append((int(said["v1"]), int(said["v2"]), int(said["v3"])))
            case "object":
                self._object = _Object(is_solid=said.get("type", "model") not in _LEFT_OUT)
                self._document.objects[said["id"]] = self._object
            case "component":
                self._object.parts.append(self._part(said))
            case "item":
                self._document.built.append(self._part(said))
            case "model":
                unit = said.get("unit", "millimeter")
                if unit not in _UNITS_M:
                    raise ValueError(f"its unit is {unit[:40]!r}, not one of {', '.join(_UNITS_M)}")
                self._document.unit_m = _UNITS_M[unit]

    def _part(self, said: dict[str, str]) -> _Part:
        T = np.eye(4)
        if "transform" in said:
            numbers = [float(word) for word in said["transform"].split()]
            if len(numbers) != 12:
                raise ValueError("a pose has twelve numbers")
            # Rows of the file are what its axes become: points stand before the matrix there.
            T[:3] = np.array(numbers).reshape(4, 3).T
        return _Part(said.get(_PATH, self._path), said["objectid"], T)
