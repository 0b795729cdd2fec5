"""An object that has no task, and the files that are made of it: mesh, object file and task files."""

from dataclasses import dataclass
from functools import cached_property
from itertools import count
from pathlib import Path
from typing import Any

import yaml

from ...base.files.file_paths import name_from, resolve_beside
from ...base.files.library import FILE_SUFFIXES
from ...base.files.output_file import make_folder, write_bytes, write_text
from ...base.files.yaml_file import read_yaml
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
        object: a mesh file or an object file, or the name of a built-in object.
        hand: name of a built-in hand, or path of a hand file.
        mass_kg: of a mesh; that of 500 kg/m^3 unless given.
        friction: of a mesh; 0.6 unless given.
        scale: factor on a mesh's coordinates.
        units: unit of a mesh's coordinates, `m` unless given.
        contacts: pairs of regions in a task; as few as can carry the object, and one more, in turn, unless
            given.
    """

    object: str
    hand: str = "sa"
    mass_kg: float | None = None
    friction: float | None = None
    scale: float | None = None
    units: str | None = None
    contacts: int | None = None

    @property
    def is_mesh(self) -> bool:
        """Whether the object is a mesh, of which an object file is made."""
        return looks_like_mesh(self.object)

    @property
    def name(self) -> str:
        """What folders of its runs are called, unless others are named."""
        return f"{Path(self.object).stem}_{Path(self.hand).stem}"

    def load_hand(self) -> Hand:
        """The hand.

        Raises:
            InputError: there is none, or its file can't be used.
        """
        return load_hand(self.hand)

    def load(self, *, cut_within_s: float | None = None) -> ObjectModel:
        """The object.

        Args:
            cut_within_s: time after which cutting a mesh into convex pieces ends, in s; see `load_object`.

        Raises:
            InputError: there is none; a mesh that bounds no solid, a mass or friction that can't be, or one
                of an object that has its own.
        """
        return load_object(
            self.object,
            mass_kg=self.mass_kg,
            friction=self.friction,
            scale=self.scale,
            units=self.units,
            cut_within_s=cut_within_s,
        )


class ObjectFiles:
    """The files of an object and its tasks, in one folder: task files; of a mesh a copy and an object file.

    Of an object file that task files there have no path to there is a copy, too.

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
        self._request, self._force, self._given = request, force, given
        make_folder(folder)
        self._object_name = self._write_object() if request.is_mesh else self._named_object()

    @cached_property
    def object(self) -> ObjectModel:
        """The object as task files have it: of a mesh, as it is read from the object file."""
        return load_object(self.folder / self._object_name) if self._request.is_mesh else self._given

    def _named_object(self) -> str:
        """How a task file names an object that has a name or a file of its own."""
        name = self._request.object
        if not name.lower().endswith(FILE_SUFFIXES):
            return name
        return name_from(self.folder, Path(name)) or self._copy_object(Path(name))

    def _copy_object(self, source: Path) -> str:
        """A copy of an object file that task files have no path to, with its meshes; returns its name."""
        fields, name = read_yaml(source), self._given.name
        for part, body in {"": fields, **(fields.get("parts") or {})}.items():
            if "mesh" in body:
                mesh = resolve_beside(source, body["mesh"], "mesh")
                body["mesh"] = self._copy_mesh(mesh, f"{name}_{part}" if part else name)
        return self._write_yaml(name, {**fields, "name": name})

    def _write_object(self) -> str:
        """Writes the files of an object that is a mesh; returns the name of its object file."""
        request, given = self._request, self._given
        described = {
            "name": f"{given.name}_mesh" if given.name in _RESERVED else given.name,
            "mesh": self._copy_mesh(Path(request.object), given.name),
            **{name: value for name in ("scale", "units") if (value := getattr(request, name)) is not None},
            "mass": float(f"{given.inertia.mass:.6g}"),
            "friction": given.friction,
        }
        sources = {name: text for name, text in given.sources.items() if name != "mesh"}
        if sources:
            described["sources"] = sources
        return self._write_yaml(given.name, described)

    def _write_yaml(self, name: str, fields: dict[str, Any]) -> str:
        file = self.folder / f"{name}.yaml"
        text = yaml.safe_dump(fields, sort_keys=False, allow_unicode=True)
        self._check_same(file, text.encode())
        write_text(file, text)
        return file.name

    def _copy_mesh(self, source: Path, name: str) -> str:
        """A copy of a mesh, with what it is painted with; returns its name."""
        mesh = self.folder / f"{name}{source.suffix.lower()}"
        if not (mesh.exists() and mesh.samefile(source)):
            self._check_same(mesh, source.read_bytes())
            write_bytes(mesh, source.read_bytes())
            self._copy_paint(source)
        return mesh.name

    def _copy_paint(self, mesh: Path) -> None:
        """Materials and textures go with the mesh, but over no other file; without them it is drawn plain."""
        for name, data in paint_files(mesh).items():
            file = self.folder / name
            if not file.exists():
                make_folder(file.parent)
                write_bytes(file, data)

    def write_task(self, suggestion: Suggestion, number: int) -> Path:
        """Writes a suggestion as a task file, with a later number where a file of this one says otherwise."""
        hand = self._hand_name or Path(self._request.hand).name
        for free in count(number):
            name = f"{suggestion.task.name}_{free}"
            file = self.task_file(name)
            text = task_text(suggestion, name, hand, self._object_name)
            if self._force or _is_free_for(file, text.encode()):
                break
        write_text(file, text)
        return file

    def task_file(self, name: str) -> Path:
        """The file of a task of this name."""
        return self.folder / f"{name}.yaml"

    def reference(self, task_file: Path) -> str:
        """The reference that loads a task file with the hand, which may lie elsewhere."""
        return with_hand(str(task_file), None if self._hand_name else self._request.hand)

    @cached_property
    def _hand_name(self) -> str | None:
        """How a task file names the hand; None for the file of one that it has no path to."""
        hand = self._request.hand
        return name_from(self.folder, Path(hand)) if hand.lower().endswith(HAND_SUFFIXES) else hand

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
