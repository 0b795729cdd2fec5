"""An object that is given as a mesh, and the files that are made of it: mesh, object file and task files."""

from dataclasses import dataclass
from functools import cached_property
from itertools import count
from pathlib import Path

import yaml

from ...base.files.output_file import make_folder, write_bytes, write_text
from ...errors import InputError
from ...hands import HAND_SUFFIXES, Hand, load_hand
from ...objects import ObjectModel, load_object, looks_like_mesh, paint_files, with_hand
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
        contacts: pairs of regions in a task; as few as can carry the object, and one more, in turn, unless
            given.
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

    def load(self, *, cut_within_s: float | None = None) -> ObjectModel:
        """The object as the mesh alone gives it.

        Args:
            cut_within_s: time after which cutting it into convex pieces ends, in s; see `load_object`.

        Raises:
            InputError: no mesh file, one that bounds no solid, or a mass or friction that can't be.
        """
        if not looks_like_mesh(self.mesh.name):
            raise InputError("run", str(self.mesh), "is no mesh file")
        return load_object(
            self.mesh,
            mass_kg=self.mass_kg,
            friction=self.friction,
            scale=self.scale,
            units=self.units,
            cut_within_s=cut_within_s,
            source="run",
        )


class ObjectFiles:
    """The files of an object and its tasks, in one folder: a copy of the mesh, an object file, task files.

    Files that someone has edited stay as they are: task files get the next free number, anything else is
    refused.

    Args:
        request: what they are made of.
        folder: where they are written.
        given: what the request loads, where that was done already.
        force: write over files that were edited, too.

    Raises:
        InputError: see `GraspRequest.load`; or a file of the folder differs from what is to be written.
    """

    def __init__(
        self, request: GraspRequest, folder: Path, *, given: ObjectModel | None = None, force: bool = False
    ):
        given = given or request.load()
        self.folder = folder
        self._request, self._force = request, force
        make_folder(folder)
        mesh = folder / f"{given.name}{request.mesh.suffix.lower()}"
        if not (mesh.exists() and mesh.samefile(request.mesh)):
            self._check_same(mesh, request.mesh.read_bytes())
            write_bytes(mesh, request.mesh.read_bytes())
            self._copy_paint()
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
        text = yaml.safe_dump(described, sort_keys=False, allow_unicode=True)
        self._check_same(self._file, text.encode())
        write_text(self._file, text)

    @cached_property
    def object(self) -> ObjectModel:
        """The object as it is read from its file."""
        return load_object(self._file)

    def _copy_paint(self) -> None:
        """Materials and textures go with the mesh, but over no other file; without them it is drawn plain."""
        for name, data in paint_files(self._request.mesh).items():
            file = self.folder / name
            if not file.exists():
                make_folder(file.parent)
                write_bytes(file, data)

    def write_task(self, suggestion: Suggestion, number: int) -> Path:
        """Writes a suggestion as a task file, with a later number where a file of this one says otherwise."""
        hand = Path(self._request.hand).name if self._is_hand_file else self._request.hand
        for free in count(number):
            name = f"{suggestion.task.name}_{free}"
            file = self.task_file(name)
            text = task_text(suggestion, name, hand, self._file.name)
            if self._force or _is_free_for(file, text.encode()):
                break
        write_text(file, text)
        return file

    def task_file(self, name: str) -> Path:
        """The file of a task of this name."""
        return self.folder / f"{name}.yaml"

    def reference(self, task_file: Path) -> str:
        """The reference that loads a task file with the hand, which may lie elsewhere."""
        return with_hand(str(task_file), self._request.hand if self._is_hand_file else None)

    @property
    def _is_hand_file(self) -> bool:
        return self._request.hand.lower().endswith(HAND_SUFFIXES)

    def _check_same(self, path: Path, data: bytes) -> None:
        if not self._force and not _is_free_for(path, data):
            raise InputError(
                "run",
                str(path),
                "is there and differs from what would be written: name another folder, or remove the file "
                "(`run --force` replaces it)",
            )


def _is_free_for(path: Path, data: bytes) -> bool:
    """Whether nothing is lost where data is written to a path."""
    return not path.exists() or (path.is_file() and path.read_bytes() == data)
