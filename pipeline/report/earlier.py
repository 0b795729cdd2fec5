"""Sets of contacts that were run before this one and did not hold: what the page says of them."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field

from ...base.files.fields import Name, Text
from ...base.files.file_model import FileModel, parse
from ...base.files.json_file import read_json
from ...base.files.output_file import write_bytes, write_json
from ...errors import InputError
from .embed import embed_picture
from .pictures import picture_bytes

__all__ = ["EarlierSet", "earlier_sets", "write_earlier"]

_FILE = "earlier.json"
_MOST = 1000


@dataclass(frozen=True)
class EarlierSet:
    """A set of contacts that did not hold.

    Attributes:
        task: name of its task.
        words: what came of it.
        picture: of the grasp that came farthest; None where there is none.
    """

    task: str
    words: str
    picture: Path | None = None


class _Entry(FileModel):
    task: Name
    words: Text


class _File(FileModel):
    sets: Annotated[list[_Entry], Field(max_length=_MOST)]


def write_earlier(media: Path, sets: tuple[EarlierSet, ...]) -> None:
    """Keeps them with the pictures of a run."""
    for number, one in enumerate(sets):
        picture = None if one.picture is None else picture_bytes(one.picture)
        if picture is not None:
            write_bytes(_picture(media, number), picture)
    entries = [_Entry(task=one.task, words=one.words[:2000]) for one in sets]
    write_json(media / _FILE, _File(sets=entries).model_dump(mode="json"))


def earlier_sets(media: Path) -> list[dict[str, Any]]:
    """What the page shows of them: name, words, and the picture where there is one."""
    path = media / _FILE
    try:
        found = parse(_File, read_json(path), path).sets if path.is_file() else []
    except InputError:
        return []
    return [
        {"task": one.task, "words": one.words, "picture": embed_picture(_picture(media, number))}
        for number, one in enumerate(found)
    ]


def _picture(media: Path, number: int) -> Path:
    return media / f"earlier_{number + 1}.png"
