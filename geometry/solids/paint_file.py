"""Reading the colours of mesh files: of corners, of materials, and of textures in the file or beside it.

They are for pictures alone, so whatever is wrong with them costs a warning, never the mesh.
"""

import re
import warnings
from dataclasses import dataclass
from hashlib import sha256
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from PIL import Image

from ...base.files.file_paths import real_path
from ...base.files.input_file import read_input
from ...base.files.mesh_guard import READER_ERRORS
from ...base.files.mesh_mend import checked_mesh
from ...base.numeric.arrays import Array, Indices, Picture
from ...errors import InputError, InputWarning
from .mesh_file import MAX_BYTES, MAX_FACES
from .paint import MOST_TRIANGLES, Paint

__all__ = ["paint_files", "read_paint"]

_remesh: Any = trimesh.remesh  # without types
_FORMATS = (".obj", ".ply", ".glb")
# A corner in an OBJ file: the letter, three coordinates and perhaps a weight, else colours.
_FIRST_CORNER, _NUMBERS_OF_CORNER = re.compile(rb"^\s*v[ \t][^\r\n]*", re.MULTILINE), 5
# Of files beside the mesh, each and how many; of a texture in pixels.
_MAX_FILE_BYTES, _MOST_FILES = 32 * 1024 * 1024, 64
_MAX_PIXELS = 8192 * 8192
# As fine as what corners of the surface can show of a texture.
_TEXTURE_PX = 512
# What was said to be missing, by mesh: its copy beside the task files of a run lacks the same.
_told: set[tuple[bytes, str, str]] = set()
_BLANK = (217, 140, 64)  # what has no colour beside what has one: `DEFAULT_RGBA`


def read_paint(path: Path, source: str, field: str, *, unit_m: float = 1.0) -> Paint | None:
    """The colours of a mesh file; None where it has none.

    Of an OBJ file the materials (MTL) and their textures are read, from its own folder and what lies in that.
    What is missing there, or is no picture, costs a warning, one for the same mesh wherever it lies.

    Args:
        path: a mesh file that can be read as a mesh.
        source: the file that names it, for warnings.
        field: where in that file.
        unit_m: metres for each unit of its coordinates.
    """
    beside = _Beside(path)
    pieces = _pieces(path, beside, source, field)
    digest = sha256(read_input(path, MAX_BYTES)).digest() if beside.lacking else b""
    for name, reason in beside.lacking.items():
        if (digest, name, reason) in _told:
            continue
        _told.add((digest, name, reason))
        text = f"{path.name!r} is drawn without {name!r}: {reason}"
        warnings.warn(InputWarning(source, field, text), stacklevel=2)
    if all(colours is None for _, _, colours in pieces):
        return None
    fine = [_fine(*piece, most=MOST_TRIANGLES // len(pieces)) for piece in pieces]
    first = np.cumsum([0, *(len(vertices) for vertices, _, _ in fine[:-1])])
    vertices = unit_m * np.concatenate([vertices for vertices, _, _ in fine])
    faces = np.concatenate([own + start for (_, own, _), start in zip(fine, first, strict=True)])
    return Paint(vertices, faces, np.concatenate([rgb for _, _, rgb in fine])).lightened()


def paint_files(path: Path) -> dict[str, bytes]:
    """The files beside a mesh file that its colours are in, by their path from its folder."""
    if path.suffix.lower() != ".obj":
        return {}
    beside = _Beside(path)
    _pieces(path, beside, "", "")
    return beside.read


class _Beside:
    """Files that a mesh file names, from its own folder and what lies in that.

    Attributes:
        read: those that were read, by the path as it was named.
        lacking: why others were not.
    """

    file_name = None  # what the reader asks for to name a mesh

    def __init__(self, path: Path):
        self._folder = real_path(path.parent)
        self.read: dict[str, bytes] = {}
        self.lacking: dict[str, str] = {}

    def get(self, name: str) -> bytes:
        plain = name.replace("\\", "/")
        try:
            place = real_path(self._folder / plain)
            if not place.is_relative_to(self._folder):
                raise InputError("", "", "lies outside of the mesh's folder")
            if len(self.read) >= _MOST_FILES:
                raise InputError("", "", f"more than {_MOST_FILES} files are named")
            data = read_input(place, _MAX_FILE_BYTES)
        except (InputError, OSError, ValueError, RuntimeError) as error:
            reason = error.allowed if isinstance(error, InputError) else "is not the path of a file"
            self.lacking[name] = reason
            raise OSError(reason) from None
        self.read[plain] = data
        return data

    __getitem__ = get


_Piece = tuple[Array, Indices, "_Coat | None"]


@dataclass(frozen=True, eq=False)
class _Coat:
    """Colours of one piece: of vertices or faces (k, 3), or a texture with places (n, 2) in it."""

    rgb: Picture | None = None
    is_of_faces: bool = False
    uv: Array | None = None
    texture: Picture | None = None


def _pieces(path: Path, beside: _Beside, source: str, field: str) -> list[_Piece]:
    """The geometries of a file, placed, with what colours them; none where nothing can."""
    kind = path.suffix.lower()
    if kind not in _FORMATS:
        return []
    try:
        data = read_input(path, MAX_BYTES)
        if not _may_be_coloured(data, kind):
            return []
        data = checked_mesh(data, kind[1:], largest=MAX_FACES)
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            reader: Any = beside
            scene: Any = trimesh.load_scene(BytesIO(data), file_type=kind[1:], process=False, resolver=reader)
            found: list[_Piece] = []
            for node in scene.graph.nodes_geometry:
                T, name = scene.graph[node]
                mesh = scene.geometry[name]
                if isinstance(mesh, trimesh.Trimesh) and len(mesh.faces):
                    vertices = trimesh.transform_points(mesh.vertices, T)
                    found.append((vertices, np.array(mesh.faces, dtype=np.int64), _coat(mesh, beside)))
            return found
    except (InputError, *READER_ERRORS) as error:
        beside.lacking.setdefault("its colours", str(error)[:200])
        return []


def _may_be_coloured(data: bytes, kind: str) -> bool:
    """Whether a file can have colours, for reading it once more takes as long as the first time."""
    match kind:
        case ".ply":
            header = data[: max(0, data.find(b"end_header"))]
            return b"red" in header or b"texture" in header.lower()
        case ".obj":
            # Colours of corners stand behind their coordinates.
            first = _FIRST_CORNER.search(data)
            has_more = first is not None and len(first.group().split()) > _NUMBERS_OF_CORNER
            return has_more or b"mtllib" in data
        case _:
            return b"material" in data or b"COLOR_0" in data


def _coat(mesh: Any, beside: _Beside) -> _Coat | None:
    visual = mesh.visual
    if visual.kind == "vertex":
        return _Coat(np.array(visual.vertex_colors, dtype=np.uint8)[:, :3])
    if visual.kind == "face":
        return _Coat(np.array(visual.face_colors, dtype=np.uint8)[:, :3], is_of_faces=True)
    material = getattr(visual, "material", None)
    if material is None:
        return None
    is_gltf = hasattr(material, "baseColorFactor")
    image = material.baseColorTexture if is_gltf else material.image
    if not is_gltf and image is not None and "file_path" not in image.info:
        image = None  # the reader's own stand-in
    factor = material.baseColorFactor if is_gltf else material.diffuse if "kd" in material.kwargs else None
    tint = np.ones(3) if factor is None else np.array(factor, dtype=float)[:3] / 255.0
    if is_gltf:
        tint = np.where(tint <= 0.0031308, 12.92 * tint, 1.055 * tint ** (1.0 / 2.4) - 0.055)
    uv = None if visual.uv is None else np.array(visual.uv, dtype=float)
    if image is not None and uv is not None and len(uv) == len(mesh.vertices):
        texture = _pixels(image, beside)
        if texture is not None:
            # MTL files often say a dull or black Kd beside a texture, which viewers leave out.
            shade = tint if is_gltf else np.ones(3)
            return _Coat(uv=uv, texture=np.round(texture * shade).astype(np.uint8))
    if factor is None:
        return None
    return _Coat(np.tile(np.round(255.0 * tint).astype(np.uint8), (len(mesh.vertices), 1)))


def _pixels(image: Image.Image, beside: _Beside) -> Picture | None:
    name = str(image.info.get("file_path", "its texture"))
    if image.width * image.height > _MAX_PIXELS:
        beside.lacking[name] = f"has more than {_MAX_PIXELS} pixels"
        return None
    try:
        small = image.convert("RGB")
        small.thumbnail((_TEXTURE_PX, _TEXTURE_PX))
        return np.asarray(small, dtype=np.uint8)
    except READER_ERRORS as error:
        beside.lacking[name] = f"can't be read as a picture: {str(error)[:100]}"
        return None


def _fine(
    vertices: Array, faces: Indices, coat: _Coat | None, *, most: int
) -> tuple[Array, Indices, Picture]:
    """A piece with a colour at each vertex; where it has a texture, with more vertices to show that."""
    if coat is None:
        return vertices, faces, np.tile(np.array(_BLANK, dtype=np.uint8), (len(vertices), 1))
    if coat.rgb is not None and not coat.is_of_faces:
        return vertices, faces, coat.rgb
    if coat.rgb is not None:
        apart = np.arange(3 * len(faces)).reshape(-1, 3)
        return vertices[faces.ravel()], apart, np.repeat(coat.rgb, 3, axis=0)
    assert coat.uv is not None and coat.texture is not None
    uv = coat.uv
    while 4 * len(faces) <= most:
        vertices, faces, attributes = _remesh.subdivide(vertices, faces, vertex_attributes={"uv": uv})
        uv = attributes["uv"]
    return vertices, faces, _sampled(coat.texture, uv)


def _sampled(texture: Picture, uv: Array) -> Picture:
    """The texture's colours (n, 3) at places (n, 2), which repeat beyond 1; v points up."""
    height, width = texture.shape[:2]
    u, v = np.nan_to_num(uv[:, 0]), np.nan_to_num(uv[:, 1])
    # The far edge is the last pixel and not the first one again.
    column = np.clip(np.where((u < 0.0) | (u > 1.0), u % 1.0, u) * width, 0, width - 1).astype(int)
    row = np.clip((1.0 - np.where((v < 0.0) | (v > 1.0), v % 1.0, v)) * height, 0, height - 1).astype(int)
    return texture[row, column]
