"""What is put together of all parts: arrays, tables, grasps to be tried again, and what describes them."""

import io
import json
import zipfile
from collections.abc import Sequence
from datetime import date
from importlib.util import find_spec
from pathlib import Path

from ...base.files.output_file import write_bytes, write_json, write_text
from ...base.text.console import Console
from ...errors import MissingBackend
from ...hands import load_hand
from ..choice import ARRAYS_FILE, DATASET_FILE, SITUATIONS_FILE, write_arrays
from .assemble import assemble, usable
from .card import card_text
from .croissant import croissant
from .head import head_of
from .minari import to_minari
from .part import Part
from .plan import DatasetPlan
from .tables import write_tables

__all__ = ["check_packages", "collect"]

_CARD_FILE, _CROISSANT_FILE = "README.md", "croissant.json"
# Every file of an archive bears a date; this one, so that the same content makes the same bytes.
_DATE = (1980, 1, 1, 0, 0, 0)


def check_packages(minari: str) -> None:
    """Looks whether what is needed beside the core is installed, before hours of work.

    Raises:
        MissingBackend: it is not.
    """
    needed = {"pyarrow": "data", **({"minari": "minari"} if minari else {})}
    for package, extra in needed.items():
        if find_spec(package) is None:
            raise MissingBackend(f"a data set needs the package {package}: pip install 'holdfast[{extra}]'")


def collect(
    parts: Sequence[Part],
    plan: DatasetPlan,
    folder: Path,
    *,
    licence: str,
    command: str,
    published: date,
    minari: str,
    console: Console,
) -> None:
    """Writes what follows from the parts; the same for the same parts.

    Args:
        parts: all parts, in the order of the plan.
        plan: what was asked for.
        folder: where it is written.
        licence: of the data.
        command: by which it was made.
        published: when its last part was made.
        minari: name among Minari's data sets; empty for none.
        console: where progress goes.

    Raises:
        InputError: no part has two candidates, or a file can't be written.
    """
    kept = usable(parts)
    hands = [load_hand(hand).name for hand in plan.hands]
    data = assemble(kept, plan, hands)
    console.say(f"writing {len(data)} candidates")
    write_arrays(folder / ARRAYS_FILE, data)
    _write_situations(folder / SITUATIONS_FILE, kept)
    tables = write_tables(folder, kept, data)
    head = head_of(data, parts, plan, licence=licence, command=command)
    write_json(folder / DATASET_FILE, head)
    write_text(folder / _CARD_FILE, card_text(data, head))
    files = [ARRAYS_FILE, SITUATIONS_FILE, DATASET_FILE, *(table.file for table in tables)]
    write_json(folder / _CROISSANT_FILE, croissant(folder, files, tables, head, published))
    if minari:
        console.say(f"handing it to Minari as {minari}")
        to_minari(data, minari, licence)


def _write_situations(path: Path, parts: Sequence[Part]) -> None:
    """Candidates with all that a test needs, a file for each group."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for k, part in enumerate(parts):
            content = part.model_dump(mode="json", include={"situation", "candidates"})
            info = zipfile.ZipInfo(f"{k:05d}.json", _DATE)
            info.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(info, json.dumps(content, separators=(",", ":"), allow_nan=False))
    write_bytes(path, buffer.getvalue())
