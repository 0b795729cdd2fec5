"""Ways to damage an input: bytes, words, structure, and what stands in the place of the file."""

import gzip
import hashlib
import io
import json
import os
import random
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

__all__ = ["damaged", "put_instead"]

WORDS = [
    *b"null .nan -.inf inf nan 1e400 -1e308 1e-320 -1 0 -0.0 true [] {} 1e12 9999999999 ../x *a".split(),
    *(
        b'""',
        b"[[[[",
        b"\xff\xfe",
        b"\x00",
        b"\x1b[31m",
        "\u202e\u2066x".encode(),
        b"x" * 5000,
        b"1/0",
        b"0x10",
        b"007",
    ),
]
VALUES: list[Any] = [
    *(
        None,
        True,
        False,
        0,
        -1,
        1e308,
        -1e308,
        5e-324,
        10**400,
        2**63,
        "",
        "x" * 3000,
        "\u202eabc\x1b[2J",
        "../../x",
    ),
    *([], {}, [[]], [None], {"": None}, "nan", [0.0] * 50, {"x": {"y": {"z": []}}}),
]


def damaged(good: bytes, rng: random.Random) -> bytes:
    """The input with one to three things wrong with it."""
    if good[:2] == b"PK" and rng.random() < 0.8:
        return _other_arrays(good, rng)
    if good[:2] == b"\x1f\x8b" and rng.random() < 0.5:
        return _other_records(good, rng)
    is_packed = good[:2] == b"\x1f\x8b"
    data = gzip.decompress(good) if is_packed and rng.random() < 0.8 else good
    unpacked = data is not good
    for _ in range(rng.randint(1, 3)):
        data = _once(data, rng)
    return gzip.compress(data, 1) if unpacked else data


def _other_arrays(good: bytes, rng: random.Random) -> bytes:
    """A checkpoint whose checksum is right and one of whose arrays is nonsense."""
    with np.load(io.BytesIO(good[:-32]), allow_pickle=False) as archive:
        arrays = {name: archive[name] for name in archive.files}
    name = rng.choice(sorted(arrays))
    array = arrays[name]
    match rng.randrange(7):
        case 0:
            del arrays[name]
        case 1:
            arrays[name] = array[: len(array) // 2]
        case 2:
            arrays[name] = np.full(array.shape, rng.choice([np.nan, np.inf, -1e308, 1e18]))
        case 3:
            arrays[name] = np.concatenate([array, array])
        case 4:
            arrays[name] = array.astype(str)
        case 5:
            arrays[name] = array[..., None]
        case _:
            arrays["head"] = np.frombuffer(damaged(arrays["head"].tobytes(), rng), np.uint8)
    buffer = io.BytesIO()
    np.savez(buffer, **arrays)
    data = buffer.getvalue()
    return data + hashlib.sha256(data).digest()


def _other_records(good: bytes, rng: random.Random) -> bytes:
    """A proof log with some of its records damaged, and counts and checksum to match."""
    *lines, _ = gzip.decompress(good).splitlines()
    for _ in range(rng.randint(1, 3)):
        i = rng.randrange(len(lines))
        lines[i] = _once(lines[i], rng).replace(b"\n", b" ")
    body = b"".join(line + b"\n" for line in lines)
    counts = {"boxes": sum(b'{"box"' in line for line in lines), "steps": sum(map(_steps, lines))}
    end = {"end": {**counts, "sha256": hashlib.sha256(body).hexdigest()}}
    return gzip.compress(body + json.dumps(end).encode() + b"\n", 1)


def _steps(line: bytes) -> int:
    """The number of steps in a record; 0 where they can't be read."""
    try:
        return len(json.loads(line)["steps"])
    except (ValueError, KeyError, TypeError, RecursionError):
        return 0


def _once(data: bytes, rng: random.Random) -> bytes:
    if data[:1] == b"{" and b"\n{" not in data and rng.random() < 0.6:
        try:
            return _other_value(data, rng)
        except ValueError:
            pass
    return rng.choice(_WAYS)(data, rng)


def _other_value(data: bytes, rng: random.Random) -> bytes:
    """A value of JSON, anywhere in its tree, becomes another, goes, or gets a neighbour."""
    tree = json.loads(data)
    places: list[tuple[Any, Any]] = []

    def walk(node: Any) -> None:
        items = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
        for key, value in items:
            places.append((node, key))
            walk(value)

    walk(tree)
    if not places:
        return data
    node, key = rng.choice(places)
    match rng.randrange(4):
        case 0:
            del node[key]
        case 1 if isinstance(node, list):
            node.insert(key, node[key])
        case 1:
            node[rng.choice(["extra", "\x1b]0;x\x07", "\u202e", "x" * 500])] = node[key]
        case _:
            node[key] = rng.choice(VALUES)
    return json.dumps(tree).encode()


def _byte(data: bytes, rng: random.Random) -> bytes:
    i = rng.randrange(len(data) or 1)
    return data[:i] + bytes([rng.randrange(256)]) + data[i + 1 :]


def _word(data: bytes, rng: random.Random) -> bytes:
    words = [m.span() for m in re.finditer(rb"-?\d+\.?\d*|\w+", data)]
    start, end = rng.choice(words) if words else (0, 0)
    return data[:start] + rng.choice(WORDS) + data[end:]


def _cut(data: bytes, rng: random.Random) -> bytes:
    return data[: rng.randrange(len(data) + 1)]


def _twice(data: bytes, rng: random.Random) -> bytes:
    a, b = sorted(rng.randrange(len(data) + 1) for _ in range(2))
    return data[:b] + data[a:b] * rng.choice([1, 1, 50]) + data[b:]


def _gone(data: bytes, rng: random.Random) -> bytes:
    a, b = sorted(rng.randrange(len(data) + 1) for _ in range(2))
    return data[:a] + data[b:]


def _noise(data: bytes, rng: random.Random) -> bytes:
    return data[: rng.randrange(64)] + rng.randbytes(rng.randrange(200))


_WAYS: list[Callable[[bytes, random.Random], bytes]] = [
    _byte,
    _word,
    _word,
    _word,
    _cut,
    _twice,
    _gone,
    _noise,
]


def put_instead(path: Path, rng: random.Random) -> None:
    """Puts something that is no regular file, or a strange one, in the place of an input."""
    path.unlink(missing_ok=True)
    match rng.randrange(7):
        case 0:
            os.mkfifo(path)
        case 1:
            path.symlink_to(rng.choice(["/dev/zero", "/dev/null", "/dev/urandom", "/dev/full"]))
        case 2:
            path.mkdir()
        case 3:
            path.symlink_to(path.name)
        case 4:
            with path.open("wb") as file:
                file.truncate(3 * 1024**3)  # takes no room on the disk
        case 5:
            path.symlink_to("/proc/self/mem")
        case _:
            pass
