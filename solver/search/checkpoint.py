"""A search on disk, from which it goes on as if it had never stopped.

The file is an .npz archive of plain arrays (no pickles) with a checksum behind it.
"""

import dataclasses
import hashlib
import io
import json
import time
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from ...base.files.array_file import load_arrays
from ...base.files.input_file import read_input
from ...base.files.output_file import remove_parts, write_bytes
from ...errors import InputError
from .branch_and_prune import SearchState, Subtree

__all__ = ["Arrays", "Checkpoint", "Snapshot", "is_part", "pack", "pack_state", "unpack", "unpack_state"]

Arrays = dict[str, NDArray[Any]]
RegionT = TypeVar("RegionT")
ItemT = TypeVar("ItemT")

_DIGEST_BYTES = 32
_LARGEST_BYTES = 512 * 1024 * 1024
# What comes of a file whose checksum is right and whose content is not.
_NONSENSE = (ValueError, KeyError, TypeError, IndexError, AttributeError, OverflowError, StopIteration)
# Of the numbers and arrays in a file: with another version it is refused.
_FORMAT = 2
_NUMBERS = ("processed", "decided", "depth", "numbered")
# Checkpoints are this far apart, and take at most a twentieth of the time.
_APART_S, _LEAST_TIMES_ITS_COST = 2.0, 20.0


@dataclass(frozen=True, eq=False)
class Snapshot:
    """What a file holds.

    Attributes:
        numbers: anything that JSON can hold.
        arrays: by name.
    """

    numbers: dict[str, Any]
    arrays: Arrays


class Checkpoint:
    """The file of a search.

    Args:
        path: the file.
        what: what is searched, in a word.
        key: of everything that decides the result of the search: a file with another key is refused.
        save: what to write.
        restore: takes up what was read.
    """

    def __init__(
        self,
        path: str | Path,
        what: str,
        key: str,
        save: Callable[[], Snapshot],
        restore: Callable[[Snapshot], None],
    ):
        self._path, self._what, self._key = Path(path), what, f"{_FORMAT}:{key}"
        self._save, self._restore = save, restore
        self._next_s = 0.0

    def open(self, resume: bool) -> None:
        """Reads the file where there is one to go on from; else writes it, to see that that is possible.

        Raises:
            InputError: the file exists and is not to be resumed, is damaged, belongs to another search, or
                can't be written.
        """
        if not self._path.exists():
            self.write()
        elif resume:
            key, snapshot = _read(self._path)
            if key != self._key:
                hint = f"is the checkpoint of another {self._what}, other settings or another version"
                raise InputError(self._path, "", hint)
            remove_parts(self._path)
            try:
                self._restore(snapshot)
            except _NONSENSE:
                raise InputError(self._path, "", f"holds no search of this {self._what}") from None
        else:
            raise InputError(self._path, "", "exists; resume it, or delete it to begin anew")

    def write_in_time(self) -> None:
        """Writes if the last time is long enough ago."""
        if time.perf_counter() >= self._next_s:
            self.write()

    def write(self) -> None:
        """Writes where the search stands, whole or not at all."""
        begun = time.perf_counter()
        _write(self._path, self._key, self._save())
        ended = time.perf_counter()
        self._next_s = ended + max(_APART_S, _LEAST_TIMES_ITS_COST * (ended - begun))


def _write(path: Path, key: str, snapshot: Snapshot) -> None:
    head = json.dumps({"fingerprint": key, "numbers": snapshot.numbers}).encode()
    buffer = io.BytesIO()
    savez: Callable[..., None] = np.savez  # whose own options the names of the arrays don't meet
    savez(buffer, head=np.frombuffer(head, dtype=np.uint8), **snapshot.arrays)
    data = buffer.getvalue()
    write_bytes(path, data + hashlib.sha256(data).digest())


def _read(path: Path) -> tuple[str, Snapshot]:
    data = read_input(path, _LARGEST_BYTES)
    data, digest = data[:-_DIGEST_BYTES], data[-_DIGEST_BYTES:]
    if hashlib.sha256(data).digest() != digest:
        raise InputError(path, "", "is no checkpoint, or a damaged one")
    try:
        arrays = load_arrays(data, largest=_LARGEST_BYTES)
        head = json.loads(arrays.pop("head").tobytes())
        return str(head["fingerprint"]), Snapshot(head["numbers"], arrays)
    except (*_NONSENSE, RecursionError):
        raise InputError(path, "", "is no checkpoint of holdfast") from None


def pack_state(state: SearchState[RegionT, Any], kind: type[RegionT]) -> Snapshot:
    """A search without its solutions; `kind` is the flat dataclass of its regions."""
    entries = sorted(state.frontier, key=lambda entry: entry[:2])
    ahead = [[s.depth, s.size, s.context] for s in state.ahead]
    arrays: Arrays = {
        "frontier.priority": np.array([e[0] for e in entries], dtype=np.float64),
        "frontier.number": np.array([[e[1], e[2]] for e in entries], dtype=np.int64).reshape(-1, 2),
        "ahead.number": np.array(ahead, dtype=np.int64).reshape(-1, 3),
        **pack("frontier", kind, [e[3] for e in entries]),
        **pack("ahead", kind, [s.region for s in state.ahead]),
        **pack("undecided", kind, state.undecided),
    }
    return Snapshot({name: getattr(state, name) for name in _NUMBERS}, arrays)


def unpack_state(snapshot: Snapshot, kind: type[RegionT], state: SearchState[RegionT, Any]) -> None:
    """Puts what `pack_state` took into a fresh state; nonsense raises one error or another."""
    arrays = snapshot.arrays
    for name in _NUMBERS:
        setattr(state, name, snapshot.numbers[name])
    numbers, priorities = arrays["frontier.number"].tolist(), arrays["frontier.priority"].tolist()
    # A sorted list is a heap.
    state.frontier = [
        (priority, number, depth, region)
        for priority, (number, depth), region in zip(
            priorities, numbers, unpack("frontier", kind, arrays), strict=True
        )
    ]
    state.ahead = deque(
        Subtree(region, *row)
        for region, row in zip(unpack("ahead", kind, arrays), arrays["ahead.number"].tolist(), strict=True)
    )
    state.undecided = unpack("undecided", kind, arrays)


def is_part(region: Any, domain: Any) -> bool:
    """Whether a box, with arrays `lower` and `upper`, lies in another; one with NaN lies nowhere."""
    if len({np.shape(end) for end in (region.lower, region.upper, domain.lower)}) > 1:
        return False
    ordered = (domain.lower <= region.lower) & (region.lower <= region.upper) & (region.upper <= domain.upper)
    return bool(ordered.all())


def pack(name: str, kind: type[ItemT], items: Sequence[ItemT]) -> Arrays:
    """The fields of flat dataclasses, stacked, each with a mask of those that are not None."""
    arrays: Arrays = {}
    for field in dataclasses.fields(kind):  # type: ignore[arg-type]
        values = [getattr(item, field.name) for item in items]
        given = np.array([value is not None for value in values], dtype=bool)
        arrays[f"{name}.{field.name}.given"] = given
        if given.any():
            arrays[f"{name}.{field.name}"] = np.array([value for value in values if value is not None])
    return arrays


def unpack(name: str, kind: type[ItemT], arrays: Arrays) -> list[ItemT]:
    """The dataclasses whose fields `pack` stacked."""
    columns = []
    for field in dataclasses.fields(kind):  # type: ignore[arg-type]
        values = iter(arrays.get(f"{name}.{field.name}", ()))
        given = arrays[f"{name}.{field.name}.given"]
        columns.append([_plain(next(values)) if g else None for g in given])
    return [kind(*row) for row in zip(*columns, strict=True)]


def _plain(value: Any) -> Any:
    """Strings and numbers as Python has them; arrays as they are."""
    return value if isinstance(value, np.ndarray) else value.item()
