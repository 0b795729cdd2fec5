"""Reading meshes from people: one closed, outward surface, and nothing but the file itself is opened."""

import hashlib
import warnings
from io import BytesIO
from pathlib import Path

import numpy as np
import trimesh
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ...base.files.collada_file import read_collada
from ...base.files.file_suffixes import MESH_FORMATS
from ...base.files.input_file import read_input
from ...base.files.mesh_guard import READER_ERRORS
from ...base.files.mesh_mend import checked_mesh
from ...base.files.threemf_file import read_3mf
from ...base.text.plain_text import counted
from ...errors import InputError
from .manifold import from_manifold, to_manifold
from .mesh_repair import find_fault, repair, separate_bodies
from .rebuild import Rebuilt, rebuild
from .union import unite

__all__ = ["MAX_BYTES", "MAX_FACES", "MESH_FORMATS", "closed_mesh", "looks_like_mesh", "read_mesh"]

# Of shapes too, but not read: whoever names such a file is told so, and not that no object has its name.
_OTHER_FORMATS = (
    ".gltf",
    ".fbx",
    ".3ds",
    ".blend",
    ".step",
    ".stp",
    ".iges",
    ".igs",
    ".usd",
    ".usdz",
)
MAX_BYTES = 64 * 1024 * 1024
MAX_FACES = 1_000_000
# More triangles only cost time: they are made fewer, which moves the surface by this share of its size.
_MANY_FACES = 100_000
_NEAR = 1e-4
_NO_INSIDE = "what has no inside can't be held: close it, or give its walls a thickness"
# Wide enough for a file in millimetres, which gets a hint of its own once its size is known.
_MAX_COORDINATE = 1e5
# A run reads a mesh from where it is, and from its copy beside the task files: repairs may take seconds.
_MOST_RECENT = 2
_recent: dict[tuple[bytes, str, float], tuple[trimesh.Trimesh, tuple[str, ...]]] = {}
# Of the cube of its size: less is the rounding of a flat thing.
_SMALLEST_VOLUME = 1e-12


def looks_like_mesh(name: str) -> bool:
    """Whether a name is that of a file of a shape, be it of a format that is read or not."""
    return name.lower().endswith((*MESH_FORMATS, *_OTHER_FORMATS))


def read_mesh(
    path: Path, source: str, field: str, *, unit_m: float = 1.0
) -> tuple[trimesh.Trimesh, tuple[str, ...]]:
    """Reads a mesh file as one closed surface in m; its colours are read by `read_paint`.

    Several geometries in a file are merged, with the poses that the file gives them. A surface that is inside
    out is turned, small faults are repaired.

    Args:
        path: the mesh file.
        source: the file that names it, for error messages.
        field: where in that file.
        unit_m: metres for each unit of its coordinates.

    Returns:
        The surface, and what was repaired, in words.

    Raises:
        InputError: not a mesh, or one that is not closed.
    """
    if path.suffix.lower() not in MESH_FORMATS:
        raise InputError(
            source, field, f"{path.name!r} is no mesh that is read: export it as {', '.join(MESH_FORMATS)}"
        )
    data = read_input(path, MAX_BYTES, source=source, field=field)
    key = (hashlib.sha256(data).digest(), path.suffix.lower(), unit_m)
    if key not in _recent:
        mesh = _load(data, path, source, field)
        mesh.vertices *= unit_m
        closed = closed_mesh(mesh, repr(path.name), source, field)
        while len(_recent) >= _MOST_RECENT:
            del _recent[next(iter(_recent))]
        _recent[key] = closed
    mesh, repairs = _recent[key]
    return mesh.copy(), repairs


def closed_mesh(
    mesh: trimesh.Trimesh, name: str, source: str, field: str
) -> tuple[trimesh.Trimesh, tuple[str, ...]]:
    """The mesh, repaired in place or rebuilt, as one closed surface in m, and what was repaired, in words.

    Args:
        mesh: triangles.
        name: what they are called in error messages.
        source: what asked for them.
        field: where in that.

    Raises:
        InputError: not a closed surface, or one that can't be.
    """
    if len(mesh.faces) > MAX_FACES:
        raise InputError(
            source,
            field,
            f"{name} has {len(mesh.faces)} triangles, and {MAX_FACES} at most are read: decimate it first, "
            f"say to {_MANY_FACES}",
        )
    if len(mesh.faces) == 0:
        raise InputError(source, field, f"{name} holds no triangles")
    _check_finite(mesh, name, source, field)
    if np.abs(mesh.vertices).max() > _MAX_COORDINATE:
        raise InputError(source, field, f"{name} has coordinates beyond {_MAX_COORDINATE:g} m")
    repairs = repair(mesh)
    if not (fault := find_fault(mesh)):
        separate_bodies(mesh)
        fault = find_fault(mesh, is_final=True)
    if fault:
        rebuilt = rebuild(mesh)
        if rebuilt is None:
            raise InputError(source, field, f"{name} is not closed: {fault}; {_NO_INSIDE}")
        mesh = rebuilt.mesh
        repairs.append(_in_words(rebuilt, fault))
    _turn_outwards(mesh)
    if lighter := _lightened(mesh):
        mesh, said = lighter
        repairs.append(said)
    mesh, united = unite(mesh)
    repairs += united
    if fault := find_fault(mesh, is_final=True):
        raise InputError(source, field, f"{name} is not closed: {fault}")
    least = _SMALLEST_VOLUME * float(mesh.scale) ** 3
    if not mesh.is_winding_consistent or _signed_volumes(mesh.triangles).sum() <= least:
        raise InputError(source, field, f"{name} encloses no volume; {_NO_INSIDE}")
    return mesh, tuple(repairs)


def _check_finite(mesh: trimesh.Trimesh, name: str, source: str, field: str) -> None:
    """Scanners leave corners that no triangle has without coordinates: these go, in place."""
    if np.isfinite(mesh.vertices).all():
        return
    mesh.remove_unreferenced_vertices()
    wrong = np.flatnonzero(~np.isfinite(mesh.vertices).all(axis=1))
    if len(wrong):
        torn = int(np.isin(mesh.faces, wrong).any(axis=1).sum())
        raise InputError(
            source,
            field,
            f"{name} has {counted(len(wrong), 'corner')} whose coordinates are not finite numbers, in "
            f"{torn} of its {len(mesh.faces)} triangles: leave these triangles out, and the hole is closed",
        )


def _in_words(rebuilt: Rebuilt, fault: str) -> str:
    said = f"rebuilt the surface, which moved by up to {1e3 * rebuilt.moved_m:.2g} mm"
    if rebuilt.missing_m > rebuilt.moved_m:
        said += f", and lies up to {1e3 * rebuilt.missing_m:.2g} mm from any triangle where there were none"
    return f"{said}: {fault}"


def _lightened(mesh: trimesh.Trimesh) -> tuple[trimesh.Trimesh, str] | None:
    """A surface with fewer triangles very near to one that has very many, and what was done, in words."""
    solid = to_manifold(mesh) if len(mesh.faces) > _MANY_FACES else None
    if solid is None:
        return None
    near_m = _NEAR * float(mesh.scale)
    lighter = from_manifold(solid.simplify(near_m))
    if len(lighter.faces) == len(mesh.faces) or find_fault(lighter, is_final=True):
        return None
    said = (
        f"made {len(lighter.faces)} triangles of {len(mesh.faces)}, at most {1e3 * near_m:.2g} mm from these"
    )
    return lighter, said


def _load(data: bytes, path: Path, source: str, field: str) -> trimesh.Trimesh:
    kind = path.suffix.lower()[1:]
    try:
        data = checked_mesh(data, kind, largest=MAX_FACES)
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            # From memory and without a resolver, so that no other file is found by what this one says.
            if kind == "dae":
                mesh = read_collada(data)
            elif kind == "3mf":
                mesh = read_3mf(data, largest=MAX_FACES)
            else:
                scene = trimesh.load_scene(BytesIO(data), file_type=kind, process=False, skip_materials=True)
                mesh = scene.to_mesh()
            vertices, faces = np.array(mesh.vertices, dtype=float), np.array(mesh.faces, dtype=np.int64)
            if len(faces) and not 0 <= faces.min() <= faces.max() < len(vertices):
                raise ValueError("a face names a vertex that does not exist")
            return trimesh.Trimesh(vertices.reshape(-1, 3), faces.reshape(-1, 3), process=False)
    except READER_ERRORS as error:
        raise InputError(
            source, field, f"{path.name!r} can't be read as a mesh: {str(error)[:200]}"
        ) from None


def _turn_outwards(mesh: trimesh.Trimesh) -> None:
    """Turns what is inside out: a closed surface can be turned without guessing, a cavity stays one."""
    if not mesh.is_winding_consistent:
        _make_winding_consistent(mesh)
    signed = _signed_volumes(mesh.triangles)
    faces = np.array(mesh.faces)
    if signed.sum() < 0:
        signed, faces = -signed, faces[:, ::-1]
    bodies = trimesh.graph.connected_components(mesh.face_adjacency, nodes=np.arange(len(faces)))
    low = np.array([mesh.triangles[body].min(axis=(0, 1)) for body in bodies])
    high = np.array([mesh.triangles[body].max(axis=(0, 1)) for body in bodies])
    for i, body in enumerate(bodies):
        is_inside = np.any(np.all(low[i] > low, axis=1) & np.all(high[i] < high, axis=1))
        if signed[body].sum() < 0 and not is_inside:
            faces[body] = faces[body, ::-1]
    mesh.faces = faces


def _make_winding_consistent(mesh: trimesh.Trimesh) -> None:
    """Turns single triangles until neighbours agree; a one-sided surface is left as it is.

    Every triangle stands twice in a graph, as it is and turned, and edges join what agrees. An orientable
    body is then two components, one the reverse of the other, of which either will do.
    """
    faces = np.array(mesh.faces)
    n = len(faces)
    first, second = mesh.face_adjacency.T
    tail, head = mesh.face_adjacency_edges.T

    def runs_along(face: NDArray[np.int64]) -> NDArray[np.bool_]:
        corners = faces[face]
        return np.any((corners == tail[:, None]) & (np.roll(corners, -1, axis=1) == head[:, None]), axis=1)

    differ = (runs_along(first) == runs_along(second)).astype(np.int64)
    rows, columns = (
        np.concatenate([first, first + n]),
        np.concatenate([second + n * differ, second + n * (1 - differ)]),
    )
    graph = coo_array((np.ones(len(rows)), (rows, columns)), shape=(2 * n, 2 * n))
    _, label = connected_components(graph, directed=False)
    turned = label[:n] > label[n:]
    faces[turned] = faces[turned, ::-1]
    mesh.faces = faces


def _signed_volumes(triangles: NDArray[np.float64]) -> NDArray[np.float64]:
    """Volumes (n,) between each triangle and the origin; their sum is the volume of a closed surface."""
    return np.einsum("fi,fi->f", triangles[:, 0], np.cross(triangles[:, 1], triangles[:, 2])) / 6.0
