"""What a file or name on the command line is, whatever it was given as."""

import gzip
import zlib
from pathlib import Path

from ...base.files.file_suffixes import MESH_FORMATS, MODEL_SUFFIXES
from ...base.files.input_file import open_input
from ...base.files.json_file import read_json
from ...base.files.yaml_file import read_yaml
from ...errors import InputError
from .catalogue import KINDS, entries

__all__ = ["KIND_WORDS", "kind_of"]

KIND_WORDS = {
    "task": "a task",
    "hand": "a hand",
    "object": "an object",
    "mesh": "a mesh",
    "model": "a robot model",
    "grasp": "a grasp file",
    "run": "a run folder",
    "record": "the record of a run",
    "result": "a result of `holdfast solve --json`",
    "system": "a polynomial system",
    "proof": "a proof log",
    "report": "a page in HTML",
    "picture": "a picture",
}
"""The kinds, in words."""

_SUFFIXES = {
    **dict.fromkeys(MESH_FORMATS, "mesh"),
    **dict.fromkeys((".png", ".jpg", ".gif", ".webp", ".mp4"), "picture"),
    **dict.fromkeys((".html", ".htm"), "report"),
    **dict.fromkeys(MODEL_SUFFIXES, "model"),
}
# Fields that a file of each kind has and no other.
_JSON_FIELDS = {
    "grasp": {"joints", "parameters", "contacts"},
    "record": {"task", "seed", "settings", "grasps"},
    "result": {"verdict", "solutions", "seconds"},
    "system": {"variables", "equations"},
}
_HAND_FIELDS = {"links", "fingers", "import"}
_OBJECT_FIELDS = {"regions", "box", "cylinder", "sphere", "mesh", "parts", "generator", "friction", "mass"}
_LOG_HEADS = (b'"holdfast_proof"', b'"holdfast_statics"')
_HEAD_BYTES = 4096


def kind_of(name: str) -> str | None:
    """The kind (a key of `KIND_WORDS`) of a path or of something built in; None where that is not clear."""
    path = Path(name)
    try:
        if path.is_dir():
            return "run" if (path / "run.json").is_file() else None
        if not path.is_file():
            return _built_in(name)
        return _SUFFIXES.get(path.suffix.lower()) or _by_content(path)
    except (InputError, OSError, ValueError):
        return None


def _built_in(name: str) -> str | None:
    name = name.partition("@")[0]
    return next((kind for kind in KINDS if name in {entry.name for entry in entries(kind)}), None)


def _by_content(path: Path) -> str | None:
    if path.suffix.lower() in (".yaml", ".yml"):
        fields = set(read_yaml(path))
        if "contacts" in fields:
            return "task"
        if fields & _HAND_FIELDS:
            return "hand"
        return "object" if fields & _OBJECT_FIELDS else None
    if _is_log(path):
        return "proof"
    if path.suffix.lower() == ".json":
        fields = set(read_json(path))
        return next((kind for kind, own in _JSON_FIELDS.items() if own <= fields), None)
    return None


def _is_log(path: Path) -> bool:
    try:
        with open_input(path) as packed, gzip.GzipFile(fileobj=packed) as file:
            head = file.read(_HEAD_BYTES)
    except (EOFError, gzip.BadGzipFile, zlib.error):
        return False
    return any(mark in head for mark in _LOG_HEADS)
