"""Files that are damaged, or no proof logs at all."""

import gzip

import numpy as np
import pytest
from holdfast.check_proof import check_proof
from holdfast.errors import InputError

from .logs import boxes_of, check, sealed, write


def test_truncated_files_are_not_accepted(proved, tmp_path):
    data = proved[1].read_bytes()
    path = tmp_path / "cut.proof"
    for size in [0, 1, 10, *range(100, len(data), len(data) // 25), len(data) - 9, len(data) - 1]:
        path.write_bytes(data[:size])
        try:
            assert not check_proof(path).accepted
        except InputError as error:
            assert size < 500 and "\n" not in str(error)
    text = gzip.decompress(data)
    for part in (text[: len(text) // 2], text[:-1], text[: text.rindex(b'{"end"')]):
        path.write_bytes(gzip.compress(part))
        assert not check_proof(path).accepted


def test_bytes_that_flip_are_not_accepted(proved, tmp_path):
    text = bytearray(gzip.decompress(proved[1].read_bytes()))
    path, rng = tmp_path / "flipped.proof", np.random.default_rng(2)
    for at in rng.integers(100, len(text), 60).tolist():
        changed = bytearray(text)
        changed[at] ^= 1 << int(rng.integers(8))
        path.write_bytes(gzip.compress(changed, 1))
        assert not check_proof(path).accepted


def _packed(text: bytes) -> bytes:
    # The time inside a gzip header would give the test another name in each process that collects it.
    return gzip.compress(text, mtime=0)


@pytest.mark.parametrize(
    "content",
    [
        pytest.param(b"", id="nothing"),
        pytest.param(b"not a log\n", id="text"),
        pytest.param(_packed(b""), id="packed nothing"),
        pytest.param(_packed(b"\xff\xfe\x00"), id="not UTF-8"),
        pytest.param(_packed(b"[1, 2]\n"), id="a list"),
        pytest.param(_packed(b'{"grasp": 1}\n'), id="other fields"),
        pytest.param(_packed(b'{"holdfast_proof": 99}\n'), id="another version"),
        pytest.param(_packed(b"[" * 100_000 + b"\n"), id="nested too deep"),
        pytest.param(_packed(b'{"holdfast_proof": 4}'), id="no end of line"),
    ],
)
def test_other_files_are_bad_input(content, tmp_path):
    path = tmp_path / "other"
    path.write_bytes(content)
    with pytest.raises(InputError) as error:
        check_proof(path)
    assert str(error.value).count("\n") == 0 and "other" in str(error.value)


@pytest.mark.parametrize(("version", "advice"), [(2, "write it anew"), (99, "a newer Holdfast wrote it")])
def test_logs_of_other_versions_are_refused(records, version, advice, tmp_path):
    records[0]["holdfast_proof"] = version
    with pytest.raises(InputError, match=f"version {version}, where 3 and 4 can be checked: {advice}"):
        check_proof(write(tmp_path / "other.proof", sealed(records)))


def test_logs_of_the_version_before_are_still_read(records, tmp_path):
    """It had no cosines and sines, and a system without them is written as it was."""
    assert records[0]["holdfast_proof"] == 4 and "trig" not in records[1]["form"]
    records[0]["holdfast_proof"] = 3
    assert check_proof(write(tmp_path / "before.proof", sealed(records))).accepted


def test_a_missing_file_and_a_folder_are_bad_input(tmp_path):
    for path in (tmp_path, tmp_path / "missing"):
        with pytest.raises(InputError):
            check_proof(path)


FORM = {"lower": [0.0], "upper": [1.0], "rows": [], "products": [], "functions": []}


@pytest.mark.parametrize(
    "form",
    [
        None,
        [],
        {},
        {**FORM, "lower": [float("nan")]},
        {**FORM, "lower": [True]},
        {**FORM, "lower": [10**400]},
        {**FORM, "lower": [0.0, 0.0]},
        {**FORM, "rows": [1]},
        {**FORM, "rows": [[[0], [1.0], 2.0]]},
        {**FORM, "rows": [[[1], [1.0], 2.0, None]]},
        {**FORM, "rows": [[[-1], [1.0], 2.0, None]]},
        {**FORM, "rows": [[[0], [1.0, 1.0], 2.0, None]]},
        {**FORM, "rows": [[[0], [float("inf")], 2.0, None]]},
        {**FORM, "products": [[0, 0]]},
        {**FORM, "products": [[0, 0, 1]]},
        {**FORM, "products": [[0, 0, 0.0]]},
        {**FORM, "functions": [[[0, 0, 0], [1, 1], [1.0]]]},
        {**FORM, "functions": [[[0, 0, 0], [10**9, 1], [1.0]]]},
    ],
)
def test_a_system_that_makes_no_sense_is_rejected(form, tmp_path):
    records = [{"holdfast_proof": 3}, {"form": form}, {"box": "", "steps": []}]
    assert check(sealed(records), tmp_path) != ""


@pytest.mark.parametrize(
    "record",
    [
        {},
        {"box": 0, "steps": []},
        {"box": "0", "steps": []},
        {"box": ""},
        {"box": "", "steps": [1]},
        {"box": "", "steps": [[]]},
        {"box": "", "steps": [["magic"]]},
        {"box": "", "steps": [["ray", [0], [1.0]]]},
        {"box": "", "steps": [["over", [0.0], [], []]]},
        {"box": "", "steps": [["over", [], [], []], ["ray", [99], [1.0]]]},
        {"box": "", "steps": [["over", [], [], []], ["ray", [0], [float("nan")]]]},
        {"box": "", "steps": [["over", [], [], []], ["ray", [0], [1e308]]]},
        {"box": "", "steps": [["over", [], [], []], ["bound", 0, "both", [], []]]},
        {"box": "", "steps": [["over", [], [], []], ["bound", 7, "lower", [], []]]},
        {"box": "", "steps": [], "split": [0, float("nan")]},
        {"box": "", "steps": [], "split": [5, 0.5]},
        {"box": "", "steps": [], "split": None},
    ],
)
def test_a_record_that_makes_no_sense_is_rejected(record, tmp_path):
    row = [[0], [1.0], -1.0, 2.0]
    head = [{"holdfast_proof": 3}, {"form": {**FORM, "rows": [row]}}]
    body = [*head, record]
    records = [*body, {"end": {"boxes": 1, "steps": 1, "sha256": ""}}]
    assert check(records, tmp_path) not in ("", "the log was changed after it was written")


def test_a_log_without_a_system_or_with_two_proves_nothing(records, tmp_path):
    assert check(sealed([records[0]]), tmp_path) != ""
    assert check(sealed([records[0], *boxes_of(records)]), tmp_path) != ""
    assert "second" in check(sealed([*records[:2], records[1], *boxes_of(records)]), tmp_path)
