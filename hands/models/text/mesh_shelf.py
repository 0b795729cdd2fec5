"""The meshes of a model, found where published models have them and given plain names."""

import os
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

from ....base.files.file_paths import folders_open_to, real_path
from ....errors import InputError
from .mesh_files import MESH_SUFFIXES, STAND_IN, MissingMesh, mesh_places, readable_mesh
from .model_files import ModelFiles

__all__ = ["MeshShelf"]

# How many files below the folder of hand file or model are looked at for a mesh not where the model says.
_MOST_FILES = 20_000


class MeshShelf:
    """Meshes that were read, by the plain names under which the compiler finds them.

    Args:
        files: the model's.
        model: path of the model that the hand file names.

    Attributes:
        contents: of the mesh files.
        paths: where they lie.
        missing: those that can't be had; another body stands in for them.
    """

    def __init__(self, files: ModelFiles, model: Path):
        self._files, self._model = files, model
        self.contents: dict[str, bytes] = {}
        self.paths: dict[str, Path] = {}
        self.missing: dict[str, MissingMesh] = {}
        self._names: dict[Path, str] = {}
        self._all_meshes: list[Path] | None = None

    def take(self, name: str, meshdir: str, model: Path) -> str:
        """Reads a mesh file and returns its plain name.

        Where there is none that can be read another body stands in: the link may be one that is left out.

        Args:
            name: of the mesh, as the model gives it.
            meshdir: the model's folder of meshes.
            model: path of the model that names it.
        """
        is_known = Path(name).suffix.lower() in MESH_SUFFIXES
        path = self._find(name, meshdir, model) if is_known else None
        if path is None:
            plain = f"mesh_{len(self.contents)}.stl"
            self.contents[plain] = STAND_IN
            self.missing[plain] = MissingMesh(name, self._why_missing(name, meshdir, model))
            return plain
        if path not in self._names:
            data, suffix = readable_mesh(self._files.read_mesh(path, model), Path(name).suffix.lower(), path)
            plain = f"mesh_{len(self.contents)}{suffix}"
            self._names[path] = plain
            self.contents[plain], self.paths[plain] = data, path
        return self._names[path]

    def _why_missing(self, name: str, meshdir: str, model: Path) -> InputError:
        if Path(name).suffix.lower() not in MESH_SUFFIXES:
            known = ", ".join(MESH_SUFFIXES)
            return InputError(model, "mesh", f"{name[:200]!r} is none of the kinds that can be read: {known}")
        places = dict.fromkeys(self._places(name, meshdir, model))
        return InputError(
            model,
            f"mesh {name[:200]}",
            f"No such file: looked for from the model's folder at {', '.join(places)[:400]}; "
            "the hand file's folder must hold all of the hand's files",
        )

    def _places(self, name: str, meshdir: str, model: Path) -> Iterator[str]:
        return mesh_places(name, meshdir, self._files.open_above(model))

    def _find(self, name: str, meshdir: str, model: Path) -> Path | None:
        """The first of the places of a mesh where there is a file; None where there is none."""
        refusal: InputError | None = None
        for place in self._places(name, meshdir, model):
            try:
                path = self._files.below(model, place)
            except InputError as error:  # outside of the folder of the hand file: perhaps it is elsewhere too
                if ":/" not in place and self._leads_out(place, model):
                    raise
                refusal = refusal or error
                continue
            if path.is_file():
                return path
        alike = self._ending_with(name)
        if len(alike) == 1:
            return alike[0]
        if refusal is not None:
            raise refusal
        return None

    def _leads_out(self, place: str, model: Path) -> bool:
        """Whether a path stays below a folder that is open to the hand file, but for a link on its way."""
        written = Path(os.path.normpath(real_path(model).parent / place))
        return any(written.is_relative_to(folder) for folder in folders_open_to(self._files.hand_file))

    def _ending_with(self, name: str) -> list[Path]:
        """Meshes below the folder of hand file or model whose paths end like `name`, capitals or not.

        What begins at the root of a file system, someone else's, is looked for by the longest end that fits.
        """
        parts = [
            part.lower() for part in Path(name.partition("://")[2] or name).parts if part not in ("..", ".")
        ]
        if self._all_meshes is None:
            own = real_path(self._files.hand_file).parent
            folder = own if self._model.is_relative_to(own) else self._model.parent
            below = islice(folder.rglob("*"), _MOST_FILES)
            self._all_meshes = [
                path for path in below if path.suffix.lower() in MESH_SUFFIXES and not path.is_symlink()
            ]
        lower = {path: [part.lower() for part in path.parts] for path in self._all_meshes}
        for k in range(len(parts) if _is_from_root(name) else min(1, len(parts))):
            end = parts[k:]
            found = [path for path, own in lower.items() if own[-len(end) :] == end and path.is_file()]
            if found:
                return found
        return []


def _is_from_root(name: str) -> bool:
    return Path(name).is_absolute() or name.startswith("file:")
