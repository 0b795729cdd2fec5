"""Reading meshes from people: one closed, outward surface, and nothing but the file itself is opened."""

import struct
import warnings
from io import BytesIO
from pathlib import Path

import numpy as np
import trimesh

from ..errors import InputError

__all__ = ["read_mesh"]

_FORMATS = (".obj", ".stl", ".ply", ".glb", ".off")
_MAX_BYTES = 64 * 1024 * 1024
_MAX_FACES = 500_000
# What parsers of five formats raise on files that are cut short or garbled.
_PARSER_ERRORS = (
    ArithmeticError,
    AssertionError,
    AttributeError,
    EOFError,
    ImportError,
    LookupError,
    MemoryError,
    OSError,
    RuntimeError,
    TypeError,
    ValueError,
    struct.error,
)


def read_mesh(path: Path, source: str, field: str) -> trimesh.Trimesh:
    """Reads a mesh file as one closed surface in m; materials and textures that it names are left alone.

    Several geometries in a file are merged, with the poses that the file gives them. A surface that is inside
    out is turned.

    Args:
        path: the mesh file.
        source: the file that names it, for error messages.
        field: where in that file.

    Raises:
        InputError: not a mesh, or one that is not closed.
    """
    if path.suffix.lower() not in _FORMATS:
        raise InputError(source, field, f"{path.name!r} must end in one of {', '.join(_FORMATS)}")
    if not path.is_file():
        raise InputError(source, field, f"there is no file {path.name!r}")
    mesh = _load(path, source, field)
    if len(mesh.faces) > _MAX_FACES:
        raise InputError(source, field, f"{path.name!r} has more than {_MAX_FACES} triangles")
    if len(mesh.faces) == 0:
        raise InputError(source, field, f"{path.name!r} holds no triangles")
    if not np.isfinite(mesh.vertices).all():
        raise InputError(source, field, f"{path.name!r} has coordinates that are not finite")
    # Formats that repeat a vertex for each of its faces or texture seams would leave every edge open.
    mesh.merge_vertices()
    a, b, c = mesh.faces.T
    mesh.update_faces((a != b) & (b != c) & (c != a))
    mesh.remove_unreferenced_vertices()
    if not mesh.is_watertight:
        raise InputError(source, field, f"{path.name!r} is not closed: the surface has open edges")
    _turn_outwards(mesh)
    if not mesh.is_winding_consistent or mesh.volume <= 1e-12:
        raise InputError(source, field, f"{path.name!r} encloses no volume")
    return mesh


def _load(path: Path, source: str, field: str) -> trimesh.Trimesh:
    try:
        data = path.read_bytes() if path.stat().st_size <= _MAX_BYTES else None
    except OSError as error:
        raise InputError(
            source, field, f"{path.name!r}: {(error.strerror or 'unreadable').lower()}"
        ) from None
    if data is None:
        raise InputError(source, field, f"{path.name!r} is larger than {_MAX_BYTES // 1024**2} MiB")
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            # From memory and without a resolver, so that no other file is found by what this one says.
            scene = trimesh.load_scene(BytesIO(data), file_type=path.suffix.lower()[1:], process=False)
            mesh = scene.to_mesh()
            vertices, faces = np.array(mesh.vertices, dtype=float), np.array(mesh.faces, dtype=np.int64)
            if len(faces) and not 0 <= faces.min() <= faces.max() < len(vertices):
                raise ValueError("a face names a vertex that does not exist")
            return trimesh.Trimesh(vertices.reshape(-1, 3), faces.reshape(-1, 3), process=False)
    except _PARSER_ERRORS as error:
        raise InputError(source, field, f"{path.name!r} can't be read as a mesh: {error}") from None


def _turn_outwards(mesh: trimesh.Trimesh) -> None:
    """Turns what is inside out: a closed surface can be turned without guessing, a cavity stays one."""
    if not mesh.is_winding_consistent:
        mesh.fix_normals(multibody=True)
    if mesh.volume < 0:
        mesh.invert()
    bodies = trimesh.graph.connected_components(mesh.face_adjacency, nodes=np.arange(len(mesh.faces)))
    if len(bodies) == 1:
        return
    corners = mesh.triangles
    signed = np.einsum("fi,fi->f", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0
    low = np.array([corners[body].min(axis=(0, 1)) for body in bodies])
    high = np.array([corners[body].max(axis=(0, 1)) for body in bodies])
    faces = np.array(mesh.faces)
    for i, body in enumerate(bodies):
        inside = np.all(low[i] > low, axis=1) & np.all(high[i] < high, axis=1)
        if signed[body].sum() < 0 and not inside.any():
            faces[body] = faces[body, ::-1]
    mesh.faces = faces
