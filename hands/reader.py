"""Reading a hand from its file, whichever of the three kinds it is."""

import re
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from ..base.files.file_model import parse
from ..base.files.file_paths import folders_open_to, real_path
from ..base.files.file_suffixes import MODEL_SUFFIXES
from ..base.files.input_file import open_input
from ..base.files.yaml_file import read_yaml
from ..errors import InputError
from .builder import BuiltHandFile, build_file
from .hand import Hand
from .hand_file import HandFile, build_hand
from .mirror import mirrored

__all__ = ["model_root", "read_hand"]

"""What the path of a model ends in that is a hand without a hand file. The last two are known, not read."""

# Folders of a package in which models lie, beside those of the meshes.
_MODEL_FOLDERS = ("urdf", "mjcf", "xml", "models", "robots", "model")
_PACKAGE_LEVELS = 3
_ABOVE = re.compile(rb"""(?:meshdir|assetdir|filename|file)\s*=\s*["']((?:\./)?(?:\.\./)+)""")
_MOST_BYTES = 16 * 1024 * 1024
_KINDS = {
    "links": "written out",
    "fingers": "built from finger structures",
    "import": "read from MJCF or URDF",
}


def read_hand(path: Path) -> Hand:
    """Reads a hand file: written out, built from finger structures, or with an MJCF or URDF model beside it.

    Raises:
        InputError: naming the file, the field and what is allowed.
    """
    if path.suffix.lower() in MODEL_SUFFIXES:
        root = model_root(path)
        return _read_model({"import": real_path(path).relative_to(root).as_posix()}, path, root)
    data = read_yaml(path)
    source = str(path)
    match _kind(data, source):
        case "links":
            written = parse(HandFile, data, path)
            return _turned(build_hand(written, source), mirror=written.mirror)
        case "fingers":
            built = parse(BuiltHandFile, data, path)
            return _turned(build_hand(build_file(built, source), source), mirror=built.mirror)
        case _:
            return _read_model(data, path, path.parent)


def _read_model(data: dict[str, Any], path: Path, root: Path) -> Hand:
    """A hand from a model below the folder `root`."""
    # MuJoCo takes half a second to import, which only imported hands need.
    from .models import ImportedHandFile, import_hand

    spec = parse(ImportedHandFile, data, path)
    return _turned(import_hand(spec, path, root), mirror=spec.mirror)


def _turned(hand: Hand, *, mirror: bool) -> Hand:
    return mirrored(hand) if mirror else hand


def _names_above(path: Path) -> int:
    """How many folders above its own a model names files; 0 for one that can't be read, as is said later."""
    try:
        with open_input(path) as file:
            text = file.read(_MOST_BYTES)
    except InputError:
        return 0
    names = _ABOVE.findall(text)
    return max((name.count(b"../") for name in names), default=0)


def model_root(path: Path) -> Path:
    """The folder that holds all files of a model: the highest of its package and of what it names there.

    A model that names files above its own folder, as `../meshes/palm.stl`, and lies in no package is followed
    only as far as any file that names others (see `files.folders_open_to`): it may come from anybody.
    """
    folder = real_path(path).parent
    for above in (folder, *list(folder.parents)[:_PACKAGE_LEVELS]):
        if (above / "package.xml").is_file():
            return above
    own = folder.parent if folder.name.lower() in _MODEL_FOLDERS else folder
    named = folder
    for _ in range(min(_names_above(path), _PACKAGE_LEVELS)):
        named = named.parent
    is_open = any(named.is_relative_to(other) for other in folders_open_to(path))
    return named if is_open and own.is_relative_to(named) else own


def _kind(data: dict[str, Any], source: str) -> str:
    given = [key for key in _KINDS if key in data]
    if len(given) == 1:
        return given[0]
    ways = ", ".join(f"{key} ({what})" for key, what in _KINDS.items())
    if given:
        raise InputError(source, given[1], f"a hand file has exactly one of {ways}")
    for key in data:
        # Close only: `limits` is no misspelt `links`.
        close = get_close_matches(key[:20], _KINDS, n=1, cutoff=0.8)
        if close:
            raise InputError(source, key, f"unknown field; did you mean {close[0]!r}?")
    raise InputError(source, "links", f"is required: a hand file has exactly one of {ways}")
