"""An object that is given as a mesh, and the files that are made of it: mesh, object file and task files."""

import shutil
from dataclasses import dataclass
from pathlib import Path

import yaml

from ...errors import InputError
from ...files import write_text
from ...hands import HAND_SUFFIXES, Hand, load_hand
from ...objects import MESH_FORMATS, ObjectModel, load_object, with_hand
from ..suggest import Suggestion, task_text

__all__ = ["GraspRequest", "ObjectFiles"]

# Names that models keep for bodies of their own.
_RESERVED = ("object", "stand", "world", "main")


@dataclass(frozen=True)
class GraspRequest:
    """What is to be grasped, and with what.

    Attributes:
        mesh: a mesh file.
        hand: name of a built-in hand, or path of a hand file.
        mass_kg: of the object; that of 500 kg/m^3 unless given.
        friction: of the object; 0.6 unless given.
        scale: factor on the mesh's coordinates.
        units: unit of the mesh's coordinates, `m` unless given.
        contacts: pairs of regions in a task; two and three, in turn, unless given.
    """

    mesh: Path
    hand: str = "sa"
    mass_kg: float | None = None
    friction: float | None = None
    scale: float | None = None
    units: str | None = None
    contacts: int | None = None

    def load_hand(self) -> Hand:
        """The hand.

        Raises:
            InputError: there is none, or its file can't be used.
        """
        return load_hand(self.hand, source="run", field="--hand")

    def load(self) -> ObjectModel:
        """The object as the mesh alone gives it.

        Raises:
            InputError: no mesh file, one that bounds no solid, or a mass or friction that can't be.
        """
        if self.mesh.suffix.lower() not in MESH_FORMATS:
            raise InputError("run", str(self.mesh), f"is no mesh file ({', '.join(MESH_FORMATS)})")
        return load_object(
            self.mesh,
            mass_kg=self.mass_kg,
            friction=self.friction,
            scale=self.scale,
            units=self.units,
            source="run",
        )


class ObjectFiles:
    """The files of an object and its tasks, in one folder: a copy of the mesh, an object file, task files.

    Args:
        request: what they are made of.
        folder: where they are written.

    Attributes:
        object: the object as it is read from its file.

    Raises:
        InputError: see `GraspRequest.load`.
    """

    def __init__(self, request: GraspRequest, folder: Path):
        given = request.load()
        self.folder = folder
        self._request = request
        folder.mkdir(parents=True, exist_ok=True)
        mesh = folder / f"{given.name}{request.mesh.suffix.lower()}"
        if not (mesh.exists() and mesh.samefile(request.mesh)):
            shutil.copyfile(request.mesh, mesh)
        self._file = folder / f"{given.name}.yaml"
        described = {
            "name": f"{given.name}_mesh" if given.name in _RESERVED else given.name,
            "mesh": mesh.name,
            **{name: value for name in ("scale", "units") if (value := getattr(request, name)) is not None},
            "mass": float(f"{given.inertia.mass:.6g}"),
            "friction": given.friction,
        }
        sources = {name: text for name, text in given.sources.items() if name != "mesh"}
        if sources:
            described["sources"] = sources
        write_text(self._file, yaml.safe_dump(described, sort_keys=False, allow_unicode=True))
        self.object = load_object(self._file)

    def write_task(self, suggestion: Suggestion, number: int) -> tuple[Path, str]:
        """Writes a suggestion as a task file; the file, and the reference that loads it with the hand."""
        name = f"{suggestion.task.name}_{number}"
        file = self.folder / f"{name}.yaml"
        is_file = self._request.hand.lower().endswith(HAND_SUFFIXES)
        hand = Path(self._request.hand).name if is_file else self._request.hand
        write_text(file, task_text(suggestion, name, hand, self._file.name))
        return file, with_hand(str(file), self._request.hand if is_file else None)
