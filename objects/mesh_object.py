"""Objects from a mesh alone: a file of its own, a trimesh, or vertices and faces."""

import time
from pathlib import Path

import numpy as np
import trimesh

from ..arguments import number_or_nan
from ..errors import InputError
from ..geometry.solids import closed_mesh, convex_pieces, read_mesh, read_paint, solid_inertia
from .object_model import ObjectModel, Part
from .size import check_size

__all__ = ["DEFAULT_FRICTION", "object_from_mesh"]

DEFAULT_FRICTION = 0.6
"""Coulomb coefficient of an object of which none is known: that of DexGraspBench and Dexonomy."""

_DEFAULT_DENSITY_KG_M3 = 500.0  # between a hollow thing of plastic and a solid one
_MASS_RANGE_KG = (1e-6, 1e3)
_FRICTION_RANGE = (0.0, 10.0)


def object_from_mesh(
    mesh: "trimesh.Trimesh | tuple[object, object] | Path",
    *,
    name: str = "object",
    mass_kg: float | None = None,
    friction: float | None = None,
    unit_m: float = 1.0,
    cut_within_s: float | None = None,
    source: str = "object",
    field: str = "",
) -> ObjectModel:
    """An object of uniform density, without contact regions.

    Args:
        mesh: a mesh file, a trimesh, or vertices (n, 3) and faces (m, 3).
        name: what it is called.
        mass_kg: its mass; that of 500 kg/m^3 unless given, which its sources say.
        friction: Coulomb coefficient against the hand's skin; 0.6 unless given, which its sources say.
        unit_m: metres for each unit of the mesh's coordinates.
        cut_within_s: time from now after which cutting it into convex pieces ends, in s; see `load_object`.
        source: what asked for it, for error messages.
        field: field of `source` that names it.

    Raises:
        InputError: not a closed body, one of a size that no hand holds, or a mass or friction that can't be.
    """
    started_s = time.monotonic()
    if isinstance(mesh, Path):
        surface, repairs = read_mesh(mesh, source, field, unit_m=unit_m)
        paint = read_paint(mesh, source, field, unit_m=unit_m)
    else:
        given = _as_trimesh(mesh, source, field)
        given.vertices *= unit_m
        surface, repairs = closed_mesh(given, "the mesh", source, field)
        paint = None
    where = (str(mesh), "") if isinstance(mesh, Path) else (source, field)
    check_size(surface, *where, unit_m=unit_m)
    _check_range("mass_kg", mass_kg, _MASS_RANGE_KG)
    _check_range("friction", friction, _FRICTION_RANGE)
    sources = {"mesh": f"repaired: {'; '.join(repairs)}"} if repairs else {}
    density = _DEFAULT_DENSITY_KG_M3
    if mass_kg is None:
        sources["mass"] = f"assumed: {density:g} kg/m^3 throughout"
    else:
        density = mass_kg / float(surface.volume)
    if friction is None:
        sources["friction"] = f"assumed: {DEFAULT_FRICTION:g}, as DexGraspBench and Dexonomy do"
    left_s = None if cut_within_s is None else cut_within_s - (time.monotonic() - started_s)
    made = convex_pieces(surface, within_s=left_s)
    if made.note:
        sources["pieces"] = made.note
    # Named for what it is, as the name of a file may be one that models reserve.
    inertia = solid_inertia(surface, density)
    part = Part("mesh", surface, made.pieces, inertia, closeness=made.closeness, paint=paint)
    return ObjectModel(
        name=name,
        parts=(part,),
        friction=DEFAULT_FRICTION if friction is None else friction,
        regions={},
        sources=sources,
    )


def _as_trimesh(mesh: object, source: str, field: str) -> trimesh.Trimesh:
    """A mesh of our own, so that nothing done to it reaches the caller's."""
    if isinstance(mesh, trimesh.Trimesh):
        vertices, faces = mesh.vertices, mesh.faces
    elif isinstance(mesh, tuple | list) and len(mesh) == 2:
        vertices, faces = mesh
    else:
        raise InputError(source, field, "must be a name, a path, a trimesh, or a pair of vertices and faces")
    try:
        v, f = np.array(vertices, dtype=float), np.array(faces, dtype=np.int64)
    except (TypeError, ValueError, OverflowError):
        raise InputError(
            source, field, "vertices must be numbers (n, 3), faces whole numbers (m, 3)"
        ) from None
    if v.ndim != 2 or v.shape[1] != 3 or f.ndim != 2 or f.shape[1] != 3:
        raise InputError(
            source, field, f"needs vertices (n, 3) and faces (m, 3), not {v.shape} and {f.shape}"
        )
    if len(f) and not 0 <= f.min() <= f.max() < len(v):
        raise InputError(source, field, "a face names a vertex that does not exist")
    return trimesh.Trimesh(v, f, process=False)


def _check_range(name: str, value: object, allowed: tuple[float, float]) -> None:
    lower, upper = allowed
    if value is None:
        return
    # Compared this way round, NaN fails too.
    if not lower < number_or_nan(value) <= upper:
        raise InputError("object", name, f"must be above {lower:g} and at most {upper:g}, not {value!r}")
