"""Which format a file has, by what it holds, and its grasps."""

import io
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any
from xml.parsers import expat

import numpy as np

from ...base.files.array_file import array_from, array_header, array_members
from ...base.files.input_file import read_input
from ...base.files.json_file import read_json_value
from ...base.files.xml_file import parse_xml
from ...base.files.yaml_file import read_yaml
from ...errors import InputError
from .acronym import read_acronym
from .bare import is_bare, is_billion, read_bare, read_billion
from .dexgraspbench import is_dexgraspbench, read_dexgraspbench
from .dexgraspnet import is_dexgraspnet, read_dexgraspnet
from .dexgraspnet2 import is_dexgraspnet2, read_dexgraspnet2
from .grasp_file import GraspFile
from .graspgen import is_graspgen, read_graspgen
from .graspit import read_graspit
from .isaac_grasp import is_isaac_grasp, read_isaac_grasp
from .multigripper import is_multigripper, read_multigripper
from .own import is_own, read_own
from .pickles import read_pickle
from .simox import is_simox, read_simox

__all__ = ["FORMATS", "read_grasps"]

FORMATS = {
    "isaac_grasp": "isaac_grasp YAML",
    "graspgen": "GraspGen JSON",
    "multigrippergrasp": "MultiGripperGrasp JSON",
    "acronym": "ACRONYM HDF5",
    "dexgraspnet": "DexGraspNet and UniDexGrasp .npy and .npz",
    "dexgraspbench": "DexGraspBench, BODex and Dexonomy .npy",
    "graspit": "GraspIt! world XML",
    "simox": "Simox grasp sets XML",
    "graspnet1billion": "graspnet-1Billion rows",
    "bare": "matrices alone",
    "holdfast": "grasps and runs of Holdfast",
}
"""The formats that are read, with their names in words."""

_MIB = 1 << 20
_LARGEST_BYTES = 256 * _MIB
_LARGEST_PICKLE, _LARGEST_YAML, _LARGEST_XML, _LARGEST_NUMBERS = 64 * _MIB, 16 * _MIB, 16 * _MIB, 64 * _MIB
_COMMENT = re.compile(rb"#[^\n]*")
_NUMBERS = re.compile(rb"\s*[-+(0-9][-+0-9.eE,;\snaifNAIF\[\]()]*")
_Reader = Callable[[Any, Path], GraspFile]
# In this order: what asks for more comes before what asks for less.
_READERS: list[tuple[Callable[[Any], bool], _Reader]] = [
    (is_own, read_own),
    (is_isaac_grasp, read_isaac_grasp),
    (is_graspgen, read_graspgen),
    (is_multigripper, read_multigripper),
    (is_dexgraspbench, read_dexgraspbench),
    (is_dexgraspnet, read_dexgraspnet),
    (is_dexgraspnet2, read_dexgraspnet2),
    (is_billion, read_billion),
    (is_bare, read_bare),
]


def read_grasps(path: Path) -> GraspFile:
    """The grasps of a file, as they are written.

    Raises:
        InputError: it can't be read, is damaged, or is none of `FORMATS`; with the field and what is allowed.
        MissingBackend: its format needs a package that is not installed.
    """
    data = read_input(path, _LARGEST_BYTES)
    if data[:8] == b"\x89HDF\r\n\x1a\n":
        return read_acronym(data, path)
    if (start := data.lstrip(b"\xef\xbb\xbf \t\r\n")[:1]) == b"<":
        return _read_xml(data, path)
    content, kind = _content(data, start, path)
    for is_one, read in _READERS:
        if is_one(content):
            return read(content, path)
    raise _unknown(path, f"{kind} with {_described(content)}")


def _content(data: bytes, start: bytes, path: Path) -> tuple[Any, str]:
    """What a file holds, and in which kind of file."""
    try:
        if data[:6] == b"\x93NUMPY":
            return _read_array(data), "a numpy array"
        if data[:4] == b"PK\x03\x04":
            return _read_archive(data), "a numpy archive"
        if data[:1] == b"\x80" or data[:2] in (b"(d", b"(l", b"cn", b"c_"):
            return _unpickled(data), "a pickle"
    except ValueError as error:
        raise InputError(path, "", str(error)) from None
    if start in (b"{", b"["):
        return read_json_value(path, not_numbers=True), "JSON"
    if _NUMBERS.fullmatch(_COMMENT.sub(b"", data[:4096])):
        return _read_numbers(data, path), "numbers"
    if b"\0" in data[:4096] or b"grasp" not in data:
        raise _unknown(path, "something else than arrays, JSON, YAML or XML")
    return read_yaml(path, largest=_LARGEST_YAML, aliases=True), "YAML"


def _unknown(path: Path, what: str) -> InputError:
    return InputError(
        path, "", f"holds {what}: no grasps that are known; read are {', '.join(FORMATS.values())}"
    )


def _described(content: Any) -> str:
    content = _single(content)
    if isinstance(content, Mapping):
        return f"the fields {', '.join(str(key)[:40] for key in list(content)[:12]) or '(none)'}"
    if isinstance(content, np.ndarray):
        return f"elements of {content.dtype} in shape {content.shape}"
    return (
        f"a list of {len(content)}" if isinstance(content, (list, tuple)) else f"a {type(content).__name__}"
    )


def _read_array(data: bytes) -> Any:
    header = array_header(data)
    if not header.dtype.hasobject:
        if header.dtype.kind not in "biufUS":
            raise ValueError("an array of records or of other things than numbers")
        return array_from(data, header)
    if header.dtype != np.dtype(object):
        raise ValueError("an array of records")
    content = _unpickled(data[header.start :])
    if not isinstance(content, np.ndarray) or content.shape != header.shape:
        raise ValueError("an array that is not what its head says")
    return content


def _read_archive(data: bytes) -> dict[str, Any]:
    members = array_members(data, largest=_LARGEST_BYTES)
    strange = [name for name, member in members.items() if member[:6] != b"\x93NUMPY"]
    if any(name.endswith("data.pkl") for name in strange):
        raise ValueError("a file of PyTorch, which is not read: save its tensors as numpy arrays")
    if strange:
        raise ValueError(f"an archive of other things than arrays, such as {strange[0][:80]!r}")
    arrays = {name: _single(_read_array(member)) for name, member in members.items()}
    only = arrays.get("arr_0")
    # A dictionary that was saved as the only thing in an archive.
    return dict(only) if len(arrays) == 1 and isinstance(only, dict) else arrays


def _single(value: Any) -> Any:
    """What a single element of an array of objects is."""
    return (
        value.item()
        if isinstance(value, np.ndarray) and value.dtype == object and value.shape == ()
        else value
    )


def _unpickled(data: bytes) -> Any:
    if len(data) > _LARGEST_PICKLE:
        raise ValueError(f"a pickle of more than {_LARGEST_PICKLE // _MIB} MiB")
    return read_pickle(data)


def _read_xml(data: bytes, path: Path) -> GraspFile:
    if len(data) > _LARGEST_XML:
        raise InputError(path, "", f"is larger than {_LARGEST_XML // _MIB} MiB")
    try:
        root = parse_xml(data)
    except (expat.ExpatError, ValueError, LookupError, RecursionError) as error:
        raise InputError(path, "", f"not valid XML: {error}") from None
    if root.tag == "world":
        return read_graspit(root, path)
    if is_simox(root):
        return read_simox(root, path)
    raise _unknown(path, f"XML with the root {root.tag[:40]!r}")


def _read_numbers(data: bytes, path: Path) -> Any:
    """The numbers of a text file: matrices of four lines each, or a row a grasp."""
    if len(data) > _LARGEST_NUMBERS:
        raise InputError(path, "", f"is larger than {_LARGEST_NUMBERS // _MIB} MiB")
    text = re.sub(r"[,;\[\]()]", " ", data.decode("ascii", "replace"))
    lines = (line.partition("#")[0].split() for line in io.StringIO(text))
    rows = [row for row in lines if row]
    widths = {len(row) for row in rows}
    if len(widths) != 1:
        raise InputError(path, "", f"has lines of different numbers of values: {sorted(widths)[:5]}")
    try:
        array = np.array(rows, dtype=float)
    except ValueError:
        raise InputError(path, "", "must be numbers alone") from None
    width = widths.pop()
    if width == 4 and len(array) % 4 == 0:
        return array.reshape(-1, 4, 4)
    return array.reshape(-1, 3, 4) if width == 12 else array
