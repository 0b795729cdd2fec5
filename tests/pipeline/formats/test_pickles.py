"""Our reader of pickles against Python's own, and what it refuses."""

import collections
import datetime
import os
import pickle
import random
import struct
from pathlib import Path

import numpy as np
import pytest
from holdfast.pipeline.formats.pickles import read_pickle

SHARED = np.arange(6.0).reshape(2, 3)
VALUES = {
    "array": SHARED,
    "same": SHARED,
    "list": [1, 2.5, (3, "x"), None, True, 2**70, b"raw"],
    "text": np.array(["ab", "c"]),
    "objects": np.array([{"a": 1}, None, np.eye(2)], dtype=object),
    "fortran": np.asfortranarray(np.arange(12.0).reshape(3, 4)),
    "big endian": np.arange(3, dtype=">i4"),
    "single": np.float32(0.5),
    "yes": np.bool_(True),
    "empty": np.zeros((0, 3)),
    "mapping": collections.OrderedDict(x=1),
}


def same(a, b) -> bool:
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, np.ndarray):
        is_alike = isinstance(b, np.ndarray) and a.shape == b.shape and a.dtype == b.dtype
        return is_alike and all(map(same, a.ravel().tolist(), b.ravel().tolist()))
    if isinstance(a, np.generic):
        return a.item() == b
    if isinstance(a, (list, tuple)):
        return type(a) is type(b) and len(a) == len(b) and all(map(same, a, b))
    return type(a) is type(b) and a == b


@pytest.mark.parametrize("protocol", range(6))
def test_plain_values_and_arrays_come_out_as_python_reads_them(protocol):
    assert same(VALUES, read_pickle(pickle.dumps(VALUES, protocol)))


@pytest.mark.parametrize("new, old", [("numpy._core", "numpy.core"), ("numpy._core.multiarray", None)])
def test_numpy_by_its_older_names(new, old):
    # In text, as protocol 0 is, names can be changed without lengths that no longer fit.
    data = pickle.dumps(SHARED, 0).replace(new.encode(), (old or "numpy.core._multiarray_umath").encode())
    assert same(SHARED, read_pickle(data))


def test_nothing_is_run_and_what_was_asked_for_is_said(tmp_path):
    class Evil:
        def __reduce__(self):
            return os.system, (f"touch {tmp_path / 'ran'}",)

    with pytest.raises(ValueError, match=r"asks for posix\.system"):
        read_pickle(pickle.dumps({"qpos": Evil()}))
    assert not (tmp_path / "ran").exists()


def text_pickle(module: str, name: str) -> bytes:
    return f"c{module}\n{name}\n(tR.".encode()


@pytest.mark.parametrize(
    "module, name",
    [
        ("torch._utils", "_rebuild_tensor_v2"),
        ("dill._dill", "_create_type"),
        ("pydrake.math", "RigidTransform"),
        ("numpy", "load"),
        ("numpy.core.multiarray", "fromfile"),
        ("builtins", "eval"),
        ("builtins", "getattr"),
    ],
)
def test_names_beyond_arrays_are_refused(module, name):
    with pytest.raises(ValueError, match=f"asks for {module}.{name}".replace(".", r"\.")):
        read_pickle(text_pickle(module, name))


@pytest.mark.parametrize("value", [datetime.date(2020, 1, 1), Path("x"), {1, 2}, 3j, np.float64, len])
def test_other_values_are_refused(value):
    for protocol in (0, 2, 4):
        with pytest.raises(ValueError, match="a pickle that"):
            read_pickle(pickle.dumps({"x": value}, protocol))


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b".",
        b"\x80\x04",
        b"(((((((",
        b"]" + b"q\x00h\x00a" * 3,  # a list in itself, without an end
        b"\x8e" + struct.pack("<Q", 2**62) + b"x.",  # bytes that aren't there
        b"]r\xff\xff\xff\x7f.",  # a place in memory that would cost 16 GiB to make
        pickle.dumps(SHARED)[:-20],
        pickle.dumps(SHARED, 2).replace(b"K\x02K\x03", b"K\x02K\x04"),  # more elements than bytes
        pickle.dumps(np.array([1, None], dtype=object), 2).replace(b"K\x02\x85", b"K\xff\x85"),
        b"I" + b"9" * 20_000 + b"\n.",
    ],
)
def test_damage_costs_a_value_error_and_nothing_else(data):
    try:
        read_pickle(data)
    except ValueError:
        return
    assert data.startswith(b"]r")  # a far place is no trouble where memory is a dictionary


def test_a_list_that_holds_itself_is_no_trap():
    inner: list = []
    inner.append(inner)
    found = read_pickle(pickle.dumps(inner))
    assert found[0] is found


def test_any_damage_is_a_value_error():
    rng = random.Random(0)
    good = [pickle.dumps(VALUES, protocol) for protocol in (0, 2, 4, 5)]
    refused = 0
    for _ in range(2000):
        data = bytearray(rng.choice(good))
        for _ in range(rng.randint(1, 4)):
            at = rng.randrange(len(data))
            match rng.randrange(3):
                case 0:
                    data[at] = rng.randrange(256)
                case 1:
                    del data[at : at + rng.randrange(9)]
                case _:
                    data[at:at] = data[rng.randrange(len(data)) :][: rng.randrange(20)]
        try:
            read_pickle(bytes(data))
        except ValueError:
            refused += 1
    assert 500 < refused < 2000
