"""Built-in files damaged at random load or are refused in one line; nothing else ever happens."""

import re
from pathlib import Path

import holdfast
import numpy as np
import pytest
from holdfast.errors import InputError
from holdfast.hands import load_hand
from holdfast.objects import load_object, load_task

ROOT = Path(holdfast.__file__).parent
TOKENS = [
    *(b"null .nan -.inf 1e400 1e-400 -1 0 -0.0 true [] {} 1e12 1e-12 ../x !!str &a *a".split()),
    *(b'"x"', b"[[[[", b"\xff", b"\x00", b"[0, 0, 0]", b"{[1]: 2}"),
]


def damage(text: bytes, rng: np.random.Generator) -> bytes:
    match rng.integers(4):
        case 0 | 1:  # a word or number becomes something else
            words = [m.span() for m in re.finditer(rb"-?\d+\.?\d*|\w+", text)]
            start, end = words[rng.integers(len(words))]
            return text[:start] + TOKENS[rng.integers(len(TOKENS))] + text[end:]
        case 2:  # a byte changes
            i = rng.integers(len(text))
            return text[:i] + bytes([rng.integers(256)]) + text[i + 1 :]
        case _:  # a line is lost or stands twice
            lines = text.split(b"\n")
            i = rng.integers(len(lines))
            return b"\n".join(lines[:i] + [lines[i]] * (2 * rng.integers(2)) + lines[i + 1 :])


@pytest.mark.parametrize(
    ("file", "load", "count"),
    [
        ("hands/data/sa.yaml", load_hand, 40),
        ("objects/data/scalpel.yaml", load_object, 200),
        ("objects/data/tasks/upholding.yaml", load_task, 200),
    ],
)
def test_damage_is_refused_or_harmless(tmp_path, file, load, count):
    rng = np.random.default_rng(0)
    good = (ROOT / file).read_bytes()
    path = tmp_path / "file.yaml"
    refused = 0
    for _ in range(count):
        path.write_bytes(damage(good, rng))
        try:
            load(path)
        except InputError as error:
            assert "\n" not in str(error)
            refused += 1
    assert refused > count / 2
