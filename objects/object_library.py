"""Built-in objects, and objects by path."""

import re
from pathlib import Path
from typing import TypeAlias

import trimesh

from ..base.files.file_suffixes import MESH_FORMATS
from ..base.files.library import Library
from ..errors import InputError
from ..geometry.solids import looks_like_mesh
from .families import family_object, is_family
from .mesh_object import object_from_mesh
from .object_file import is_object_file, read_object
from .object_model import ObjectModel
from .size import metres

__all__ = ["ObjectSource", "builtin_objects", "load_object", "names_object"]

ObjectSource: TypeAlias = str | Path | trimesh.Trimesh | tuple[object, object]
"""What an object can be loaded from; see `load_object`."""

_PATHS = f"family:FAMILY:SEED, or the path of an object file (.yaml) or of a mesh ({', '.join(MESH_FORMATS)})"
_LIBRARY = Library(__package__, "object", read_object, _PATHS)


def builtin_objects() -> tuple[str, ...]:
    """Names of the built-in objects, sorted."""
    return _LIBRARY.names()


def names_object(name: str) -> bool:
    """Whether a text names an object, not a task: a built-in one, a mesh file, or the file of an object.

    Members of families are tasks as well.
    """
    return name in builtin_objects() or looks_like_mesh(name) or is_object_file(Path(name))


def load_object(
    what: ObjectSource,
    *,
    mass_kg: float | None = None,
    friction: float | None = None,
    scale: float | None = None,
    units: str | None = None,
    cut_within_s: float | None = None,
    source: str = "object",
    field: str = "",
) -> ObjectModel:
    """Loads an object.

    Args:
        what: a name from `builtin_objects()`, `family:<family>:<seed>`, the path of an object file (.yaml,
            .yml) or of a mesh file, a trimesh, or a pair of vertices (n, 3) and faces (m, 3).
        mass_kg: of an object from a mesh; that of 500 kg/m^3 unless given.
        friction: of an object from a mesh; 0.6 unless given.
        scale: factor on the coordinates of a mesh.
        units: unit of the coordinates of a mesh, `m` unless given; `cm`, `mm`, `in` or `ft`.
        cut_within_s: time from now after which cutting a mesh into convex pieces ends, in s; None gives it a
            minute of an idle machine. Pieces that were kept are taken, unless they had less time.
        source: what asked for the object, for the error message.
        field: field of `source` that names the object.

    Raises:
        InputError: no such object, a file that can't be used, or a mass, friction, scale or units of an
            object that has its own.
    """
    if isinstance(what, str | Path) and not looks_like_mesh(str(what)):
        given = {"mass": mass_kg, "friction": friction, "scale": scale, "units": units}
        for name, value in given.items():
            if value is not None:
                raise InputError(source, field, f"{what} has {name} of its own; it can be given for a mesh")
        text = str(what)
        if is_family(text):
            return family_object(text, source=source, field=field)
        return _LIBRARY.load(text, source, field)
    mesh = Path(what) if isinstance(what, str) else what
    name = _name_of(mesh) if isinstance(mesh, Path) else "object"
    return object_from_mesh(
        mesh,
        name=name,
        mass_kg=mass_kg,
        friction=friction,
        unit_m=metres(scale, units),
        cut_within_s=cut_within_s,
        source=source,
        field=field,
    )


def _name_of(path: Path) -> str:
    """A name for the object of a mesh file, which files and models can carry."""
    return re.sub(r"[^A-Za-z0-9_-]+", "_", path.stem).strip("-_")[:64] or "object"
