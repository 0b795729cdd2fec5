"""Where the mesh files of a model are, and how MuJoCo can read them.

Published models name meshes from the folder of a package, from meshdir, from their own folder, or repeat
meshdir in the name. Each of these places is tried, all below the folder of the hand file, the model's own
reading first.
"""

import io
import re
from collections.abc import Iterator
from pathlib import Path, PurePosixPath
from typing import Any, NamedTuple

import trimesh

from ....base.files.collada_file import read_collada
from ....base.files.mesh_guard import READER_ERRORS
from ....base.files.mesh_mend import checked_mesh
from ....errors import InputError

__all__ = ["MESH_SUFFIXES", "STAND_IN", "MissingMesh", "mesh_places", "readable_mesh"]

MESH_SUFFIXES = (".obj", ".stl", ".msh", ".ply", ".off", ".glb", ".dae")
_OF_MUJOCO = (".obj", ".stl", ".msh")
_SCHEMES = ("package://", "model://")
# MuJoCo takes no larger STL; only the convex hull of a mesh is used, so nothing is lost.
_MOST_STL_FACES = 200_000
_MOST_FACES = 2_000_000
_STL_HEADER_BYTES, _STL_FACE_BYTES = 84, 50
# A body of 2 mm for the compiler, in place of a mesh that is not there; nothing else ever sees it.
STAND_IN: bytes = trimesh.creation.box((2e-3, 2e-3, 2e-3)).export(file_type="stl")


class MissingMesh(NamedTuple):
    """A mesh that can't be had.

    Attributes:
        name: as the model gives it.
        why: the error for models that need it.
    """

    name: str
    why: InputError


def mesh_places(name: str, meshdir: str, parents: int) -> Iterator[str]:
    """Paths, from the folder of the model, at which the mesh `name` of a model may lie; the likeliest first.

    Args:
        name: as the model gives it.
        meshdir: the model's folder of meshes.
        parents: how many folders above that of the model may be looked into.
    """
    above = ["../" * k for k in range(parents + 1)]
    for scheme in _SCHEMES:
        if name.startswith(scheme):
            package, _, rest = name.removeprefix(scheme).partition("/")
            # A package is a folder at or above the model's, which may be called otherwise, or one in it.
            for up in above:
                if package:
                    yield f"{up}{package}/{rest}"
                yield f"{up}{rest}"
            for up in above:
                # An outer package, of which the hand file's folder is a part.
                yield from (up + tail for tail in _tails(rest))
            return
    yield str(Path(meshdir) / name)
    if not Path(name).is_absolute() and ":/" not in name:
        yield name
        yield from (str(Path(meshdir) / tail) for tail in _tails(name))
        yield from (up + name for up in above[1:])


def _tails(name: str) -> Iterator[str]:
    """The path without its first folder, without its first two, ..."""
    parts = [part for part in PurePosixPath(name).parts if part not in ("..", ".")]
    yield from ("/".join(parts[k:]) for k in range(1, len(parts)))


def readable_mesh(data: bytes, suffix: str, path: Path) -> tuple[bytes, str]:
    """The mesh and its suffix in a form that MuJoCo reads: as it is, or written anew.

    Raises:
        InputError: a file that holds no triangles.
    """
    try:
        data = checked_mesh(data, suffix[1:], largest=_MOST_FACES)
    except READER_ERRORS as error:
        raise InputError(path, "", f"can't be read as a mesh: {error}") from None
    is_other = (suffix == ".stl" and not _is_plain_stl(data)) or (suffix == ".obj" and _has_groups(data))
    if suffix in _OF_MUJOCO and not is_other:
        return data, suffix
    try:
        mesh: Any
        if suffix == ".dae":
            mesh = read_collada(data)
        else:
            mesh = trimesh.load(io.BytesIO(data), file_type=suffix[1:], force="mesh", skip_materials=True)
    except READER_ERRORS as error:
        raise InputError(path, "", f"can't be read as a mesh: {str(error)[:200]}") from None
    if not isinstance(mesh, trimesh.Trimesh) or not len(mesh.faces):
        raise InputError(path, "", "holds no triangles")
    if len(mesh.faces) > _MOST_STL_FACES:
        mesh = mesh.convex_hull
    out = io.BytesIO()
    mesh.export(out, file_type="stl")
    return out.getvalue(), ".stl"


def _has_groups(data: bytes) -> bool:
    """Whether an OBJ file may hold several groups or objects: MuJoCo takes the faces of the first alone."""
    return sum(len(re.findall(rb"(?m)^[ \t]*" + word + rb"[ \t]", data)) for word in (b"g", b"o")) > 1


def _is_plain_stl(data: bytes) -> bool:
    """Whether the file is a binary STL that MuJoCo takes; text is not."""
    count = int.from_bytes(data[_STL_HEADER_BYTES - 4 : _STL_HEADER_BYTES], "little")
    said = _STL_HEADER_BYTES + _STL_FACE_BYTES * count
    return count <= _MOST_STL_FACES and not (data[:5].lower() == b"solid" and said != len(data))
