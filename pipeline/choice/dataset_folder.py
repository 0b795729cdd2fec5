"""A data set on disk, as the environments and learning read it: `dataset.json` and `arrays.npz`."""

import io
import zipfile
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...base.files.json_file import read_json
from ...base.files.output_file import write_bytes
from ...errors import InputError
from .choice_data import SPLITS, ChoiceData
from .feature import Feature

__all__ = [
    "ARRAYS_FILE",
    "DATASET_FILE",
    "SCHEMA_VERSION",
    "SITUATIONS_FILE",
    "load_dataset",
    "read_head",
    "shipped_dataset",
    "write_arrays",
]

SCHEMA_VERSION = 1
DATASET_FILE = "dataset.json"
ARRAYS_FILE = "arrays.npz"
SITUATIONS_FILE = "situations.zip"
_SPLIT_NAMES = ("object", "hand", "task")
_LARGEST_BYTES = 2**31
# Kinds (as of NumPy's dtypes) and axes of the arrays.
_ARRAYS = {
    "features": ("f", 2),
    "object_features": ("f", 2),
    "group": ("i", 1),
    "object_index": ("i", 1),
    "object_ids": ("U", 1),
    "candidate_ids": ("U", 1),
    "hand": ("U", 1),
    "task": ("U", 1),
    "held": ("b", 3),
    "margin": ("f", 3),
    "conditions": ("f", 3),
    **{f"split_{name}": ("U", 1) for name in _SPLIT_NAMES},
}
_OF_CANDIDATES = (
    "features",
    "object_index",
    "candidate_ids",
    "hand",
    "task",
    "held",
    "margin",
    *(f"split_{name}" for name in _SPLIT_NAMES),
)


def shipped_dataset() -> Path:
    """Folder of the small data set that comes with the package."""
    return Path(str(files(__package__))) / "data" / "small"


def load_dataset(folder: str | Path | None = None) -> ChoiceData:
    """Reads a data set that `holdfast dataset` has made.

    Args:
        folder: where it lies; None for the small one that comes with the package.

    Raises:
        InputError: no such data set, one of another version of the format, or a damaged one.
    """
    path = shipped_dataset() if folder is None else Path(folder)
    head = read_head(path / DATASET_FILE)
    arrays = _read_arrays(path / ARRAYS_FILE)
    source = path / DATASET_FILE
    data = ChoiceData(
        features=arrays["features"],
        feature_specs=_features(head, "features", source),
        object_features=arrays["object_features"],
        object_specs=_features(head, "object_features", source),
        group=arrays["group"],
        object_index=arrays["object_index"],
        object_ids=arrays["object_ids"],
        candidate_ids=arrays["candidate_ids"],
        hand=arrays["hand"],
        task=arrays["task"],
        held=arrays["held"],
        margin=arrays["margin"],
        conditions=arrays["conditions"],
        condition_names=_names(head, "conditions", source),
        loads=_loads(head, source),
        splits={name: arrays[f"split_{name}"] for name in _SPLIT_NAMES},
    )
    _check(data, path / ARRAYS_FILE)
    return data


def write_arrays(path: Path, data: ChoiceData) -> None:
    """Writes the arrays of a data set, the same bytes for the same content.

    Raises:
        InputError: the file can't be written.
    """
    arrays: dict[str, NDArray[Any]] = {name: getattr(data, name) for name in _ARRAYS if hasattr(data, name)}
    arrays |= {f"split_{name}": data.splits[name] for name in _SPLIT_NAMES}
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in _ARRAYS:
            entry = io.BytesIO()
            np.lib.format.write_array(entry, np.ascontiguousarray(arrays[name]), allow_pickle=False)
            # A fixed date: NumPy's own writer would put the time of writing into the file.
            info = zipfile.ZipInfo(f"{name}.npy", (1980, 1, 1, 0, 0, 0))
            info.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(info, entry.getvalue())
    write_bytes(path, buffer.getvalue())


def read_head(path: Path) -> dict[str, Any]:
    """What `dataset.json` says.

    Raises:
        InputError: it is missing, of another version of the format, or no JSON.
    """
    if not path.exists():
        raise InputError(path.parent, "", f"is no data set: it has no {path.name}")
    head = read_json(path)
    version = head.get("schema_version")
    if version != SCHEMA_VERSION:
        raise InputError(path, "schema_version", f"must be {SCHEMA_VERSION}, not {version!r}")
    return head


def _read_arrays(path: Path) -> dict[str, NDArray[Any]]:
    if not path.exists():
        raise InputError(path.parent, "", f"is no whole data set: it has no {path.name}")
    found: dict[str, NDArray[Any]] = {}
    try:
        with zipfile.ZipFile(path) as archive:
            if sum(entry.file_size for entry in archive.infolist()) > _LARGEST_BYTES:
                raise InputError(path, "", f"holds more than {_LARGEST_BYTES // 2**30} GiB")
            for name, (kind, axes) in _ARRAYS.items():
                with archive.open(f"{name}.npy") as entry:
                    array = np.lib.format.read_array(entry, allow_pickle=False)
                if array.dtype.kind != kind or array.ndim != axes:
                    raise InputError(path, name, f"must be an array of {axes} axes of kind '{kind}'")
                found[name] = array
    except KeyError as error:
        raise InputError(path, "", f"lacks an array: {error.args[0]}") from None
    except (zipfile.BadZipFile, ValueError, OSError, EOFError):
        raise InputError(path, "", "is damaged") from None
    return found


def _features(head: dict[str, Any], field: str, source: Path) -> tuple[Feature, ...]:
    entries = head.get(field)
    if not isinstance(entries, list) or not all(isinstance(entry, dict) for entry in entries):
        raise InputError(source, field, "must be a list of features")
    return tuple(Feature.from_record(entry, str(source), f"{field}.{k}") for k, entry in enumerate(entries))


def _names(head: dict[str, Any], field: str, source: Path) -> tuple[str, ...]:
    entries = head.get(field)
    if not isinstance(entries, list) or not all(
        isinstance(entry, dict) and isinstance(entry.get("name"), str) for entry in entries
    ):
        raise InputError(source, field, "must be a list of entries with a name")
    return tuple(entry["name"] for entry in entries)


def _loads(head: dict[str, Any], source: Path) -> tuple[float, ...]:
    loads = head.get("loads")
    if not isinstance(loads, list) or not loads or not all(isinstance(load, (int, float)) for load in loads):
        raise InputError(source, "loads", "must be a list of numbers")
    return tuple(float(load) for load in loads)


def _check(data: ChoiceData, source: Path) -> None:
    """Whether the arrays fit each other, so that nothing that uses them need look again."""
    count = len(data.group)
    for name in _OF_CANDIDATES:
        array = data.splits[name.removeprefix("split_")] if name.startswith("split_") else getattr(data, name)
        if len(array) != count:
            raise InputError(source, name, f"must have {count} rows as group has, not {len(array)}")
    _check_group(data.group, source)
    shape = (count, data.conditions.shape[1], len(data.loads))
    wanted = {
        "features": (count, len(data.feature_specs)),
        "object_features": (len(data.object_ids), len(data.object_specs)),
        "held": shape,
        "margin": shape,
        "conditions": (int(data.group[-1]) + 1, shape[1], len(data.condition_names)),
    }
    for name, expected in wanted.items():
        if getattr(data, name).shape != expected:
            raise InputError(source, name, f"must be {expected}, not {getattr(data, name).shape}")
    if not (data.object_index.min() >= 0 and data.object_index.max() < len(data.object_ids)):
        raise InputError(source, "object_index", "names an object that is not there")
    for name in ("features", "object_features", "margin", "conditions"):
        if not np.isfinite(getattr(data, name)).all():
            raise InputError(source, name, "has values that are not finite")
    for name, parts in data.splits.items():
        if not np.isin(parts, SPLITS).all():
            raise InputError(source, f"split_{name}", f"must be {', '.join(SPLITS)}")


def _check_group(group: NDArray[np.int64], source: Path) -> None:
    if not len(group):
        raise InputError(source, "group", "is empty")
    steps = np.diff(group)
    if group[0] != 0 or not np.isin(steps, (0, 1)).all():
        raise InputError(source, "group", "must count up from 0, the rows of a group together")
