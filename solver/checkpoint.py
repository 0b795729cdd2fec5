"""A search on disk, from which it goes on as if it had never stopped.

The file is an .npz archive of plain arrays (no pickles) with a checksum behind it.
"""

import dataclasses
import hashlib
import io
import json
import zipfile
from collections import deque
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import __version__
from ..errors import InputError
from ..files import write_bytes
from .box_worker import BoxWorker
from .configuration import Certificate, Configuration
from .proof import form_data
from .prune import Box
from .search import SearchState, Slice
from .state import State

__all__ = ["fingerprint", "read_checkpoint", "write_checkpoint"]

Arrays = dict[str, NDArray[Any]]
TaskState = SearchState[Box, Configuration]

_DIGEST_BYTES = 32
_NUMBERS = ("processed", "decided", "depth", "numbered")


def fingerprint(worker: BoxWorker) -> str:
    """Of everything that decides the result of a search: version, system, free joints, settings."""
    setup = worker.setup
    what = [
        __version__,
        form_data(worker.form),
        worker.formulation.system.names,
        worker.certifier.q_free.tolist(),
        setup.task.limits.tolist(),
        [setup.sigma, setup.seed, setup.pure, setup.order.value, setup.cover],
    ]
    return hashlib.sha256(json.dumps(what).encode()).hexdigest()


def write_checkpoint(
    path: Path, key: str, state: TaskState, counters: dict[str, float], covered: Sequence[Box] = ()
) -> None:
    """Writes where a search stands, whole or not at all.

    Args:
        path: the file.
        key: the search's fingerprint.
        state: of the search.
        counters: further numbers to keep.
        covered: further boxes to keep.
    """
    numbers = {name: getattr(state, name) for name in _NUMBERS}
    head = {"fingerprint": key, "state": numbers, "counters": counters}
    entries = sorted(state.frontier, key=lambda entry: entry[:2])
    arrays: Arrays = {
        "head": np.frombuffer(json.dumps(head).encode(), dtype=np.uint8),
        "frontier.priority": np.array([e[0] for e in entries], dtype=np.float64),
        "frontier.number": np.array([[e[1], e[2]] for e in entries], dtype=np.int64).reshape(-1, 2),
        "ahead.number": np.array([[s.depth, s.size, s.effort] for s in state.ahead], dtype=np.int64).reshape(
            -1, 3
        ),
        **_pack("frontier", Box, [e[3] for e in entries]),
        **_pack("ahead", Box, [s.region for s in state.ahead]),
        **_pack("undecided", Box, state.undecided),
        **_pack("covered", Box, covered),
        **_pack_configurations(state.solutions),
    }
    buffer = io.BytesIO()
    savez: Callable[..., None] = np.savez  # whose own options the names of the arrays don't meet
    savez(buffer, **arrays)
    data = buffer.getvalue()
    write_bytes(path, data + hashlib.sha256(data).digest())


def read_checkpoint(
    path: Path, key: str, state: TaskState, worker: BoxWorker
) -> tuple[dict[str, float], list[Box]]:
    """Puts what a file holds into a fresh state.

    Returns:
        The further numbers and boxes that were kept.

    Raises:
        InputError: the file can't be read, is damaged, or belongs to another search.
    """
    arrays, head = _read(path)
    if head["fingerprint"] != key:
        raise InputError(path, "", "is the checkpoint of another task, other settings or another version")
    for name in _NUMBERS:
        setattr(state, name, head["state"][name])
    boxes = _unpack("frontier", Box, arrays)
    numbers = arrays["frontier.number"].tolist()
    priorities = arrays["frontier.priority"].tolist()
    # A sorted list is a heap.
    state.frontier = [
        (priority, number, depth, box)
        for priority, (number, depth), box in zip(priorities, numbers, boxes, strict=True)
    ]
    state.ahead = deque(
        Slice(box, *numbers)
        for box, numbers in zip(_unpack("ahead", Box, arrays), arrays["ahead.number"].tolist(), strict=True)
    )
    state.undecided = _unpack("undecided", Box, arrays)
    state.solutions = _unpack_configurations(arrays, worker)
    return dict(head["counters"]), _unpack("covered", Box, arrays)


def _read(path: Path) -> tuple[Arrays, dict[str, Any]]:
    try:
        data = path.read_bytes()
    except OSError as error:
        raise InputError(path, "", error.strerror or "can't be read") from None
    data, digest = data[:-_DIGEST_BYTES], data[-_DIGEST_BYTES:]
    if hashlib.sha256(data).digest() != digest:
        raise InputError(path, "", "is no checkpoint, or a damaged one")
    try:
        with np.load(io.BytesIO(data), allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
        return arrays, json.loads(arrays["head"].tobytes())
    except (ValueError, KeyError, OSError, zipfile.BadZipFile):
        raise InputError(path, "", "is no checkpoint of holdfast") from None


def _pack(name: str, kind: type, items: Sequence[Any]) -> Arrays:
    """The fields of flat dataclasses, stacked, each with a mask of those that are not None."""
    arrays: Arrays = {f"{name}.count": np.array(len(items))}
    for field in dataclasses.fields(kind):
        values = [getattr(item, field.name) for item in items]
        given = np.array([value is not None for value in values], dtype=bool)
        arrays[f"{name}.{field.name}.given"] = given
        if given.any():
            arrays[f"{name}.{field.name}"] = np.array([value for value in values if value is not None])
    return arrays


def _unpack(name: str, kind: type, arrays: Arrays) -> list[Any]:
    columns = []
    for field in dataclasses.fields(kind):
        values = iter(arrays.get(f"{name}.{field.name}", ()))
        given = arrays[f"{name}.{field.name}.given"]
        columns.append([_plain(next(values)) if g else None for g in given])
    return [kind(*row) for row in zip(*columns, strict=True)]


def _plain(value: Any) -> Any:
    """Strings and numbers as Python has them; arrays as they are."""
    return value if isinstance(value, np.ndarray) else value.item()


def _pack_configurations(found: Sequence[Configuration]) -> Arrays:
    proofs = [c.certificate for c in found if c.certificate is not None]
    assert len(proofs) == len(found), "a search finds certified configurations only"
    return {
        **_pack("state", State, [c.state for c in found]),
        "found.residual": np.array([c.residual_m for c in found], dtype=np.float64),
        "found.lower": np.array([p.lower for p in proofs], dtype=np.float64),
        "found.upper": np.array([p.upper for p in proofs], dtype=np.float64),
        "found.fixed": np.array([[name in p.fixed for name in p.names] for p in proofs], dtype=bool),
    }


def _unpack_configurations(arrays: Arrays, worker: BoxWorker) -> list[Configuration]:
    names = worker.formulation.system.names
    found = []
    for row, state in enumerate(_unpack("state", State, arrays)):
        fixed = tuple(name for name, held in zip(names, arrays["found.fixed"][row], strict=True) if held)
        certificate = Certificate(names, arrays["found.lower"][row], arrays["found.upper"][row], fixed)
        residual_m = float(arrays["found.residual"][row])
        found.append(Configuration(worker.setup.task, state, residual_m, certificate))
    return found
