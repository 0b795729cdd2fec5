"""Reading a hand from its file, whichever of the three kinds it is."""

from difflib import get_close_matches
from pathlib import Path
from typing import Any

from ..errors import InputError
from ..files import parse
from ..yaml_file import read_yaml
from .builder import BuiltHandFile, build_file
from .hand import Hand
from .hand_file import HandFile, build_hand

__all__ = ["read_hand"]

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
    data = read_yaml(path)
    source = str(path)
    match _kind(data, source):
        case "links":
            return build_hand(parse(HandFile, data, path), source)
        case "fingers":
            return build_hand(build_file(parse(BuiltHandFile, data, path), source), source)
        case _:
            # MuJoCo takes half a second to import, which only imported hands need.
            from .import_file import ImportedHandFile, import_hand

            return import_hand(parse(ImportedHandFile, data, path), path)


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
