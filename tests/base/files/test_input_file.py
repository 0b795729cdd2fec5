"""The door in: whatever stands at a path, reading it ends, and gives no more than was allowed."""

import os

import pytest
from holdfast.base.files.array_file import load_arrays
from holdfast.base.files.input_file import open_input, read_input, read_text
from holdfast.errors import InputError


def put(path, kind):
    match kind:
        case "pipe":
            os.mkfifo(path)
        case "device":
            path.symlink_to("/dev/zero")
        case "folder":
            path.mkdir()
        case "loop":
            path.symlink_to(path.name)
        case "socket":
            path.symlink_to("/dev/tty")


@pytest.mark.parametrize("kind", ["pipe", "device", "folder", "loop", "nothing"])
def test_what_is_no_regular_file_is_refused_at_once(kind, tmp_path):
    path = tmp_path / "x"
    put(path, kind)
    for read in (lambda: read_input(path, 100), lambda: read_text(path, 100)):
        with pytest.raises(InputError, match=r"regular file|symbolic links|no such file"):
            read()


def test_no_more_is_read_than_is_allowed_whatever_the_size_says(tmp_path):
    path = tmp_path / "x"
    path.write_bytes(b"a" * 100)
    assert read_input(path, 100) == b"a" * 100
    with pytest.raises(InputError, match="larger than 99 bytes"):
        read_input(path, 99)
    with pytest.raises(InputError, match="larger than 10 bytes"):
        read_input(type(path)("/proc/self/maps"), 10)  # whose size is said to be 0
    with path.open("wb") as file:
        file.truncate(1 << 40)
    with pytest.raises(InputError, match="larger than 1 MiB"):
        read_input(path, 1 << 20)


def test_a_file_is_named_as_it_was_asked_for(tmp_path):
    with pytest.raises(InputError) as caught:
        read_input(tmp_path / "thing.obj", 1, source="task.yaml", field="mesh")
    assert str(caught.value) == "task.yaml: mesh: 'thing.obj': no such file or directory"


def test_links_can_be_refused(tmp_path):
    (tmp_path / "private").write_bytes(b"secret")
    (tmp_path / "link").symlink_to("private")
    assert read_input(tmp_path / "link", 100) == b"secret"
    with pytest.raises(InputError):
        read_input(tmp_path / "link", 100, links=False)


def test_errors_of_a_reader_are_its_own(tmp_path):
    (tmp_path / "x").write_bytes(b"")
    with pytest.raises(OSError, match="bad content"), open_input(tmp_path / "x"):
        raise OSError("bad content")


def test_an_archive_expands_to_no_more_than_is_allowed():
    import io

    import numpy as np

    buffer = io.BytesIO()
    np.savez_compressed(buffer, x=np.zeros(100_000))
    data = buffer.getvalue()
    assert len(data) < 5_000
    assert load_arrays(data, largest=1_000_000)["x"].shape == (100_000,)
    with pytest.raises(ValueError, match="too large"):
        load_arrays(data, largest=500_000)
    for bad in (b"", data[:-10], b"PK" + data[2:200]):
        with pytest.raises(ValueError, match="archive"):
            load_arrays(bad, largest=1_000_000)


def test_what_stands_for_a_file_that_lies_elsewhere_is_told_from_one_that_is_damaged(tmp_path):
    pointer = tmp_path / "palm.stl"
    pointer.write_text(f"version https://git-lfs.github.com/spec/v1\noid sha256:{'0' * 64}\nsize 72984\n")
    for read in (lambda: read_input(pointer, 1000), lambda: read_text(pointer, 1000)):
        with pytest.raises(InputError, match="git lfs pull"):
            read()
    short = tmp_path / "short.txt"
    short.write_text("v")
    with open_input(short) as file:
        assert file.read() == b"v"  # from its beginning, and whole
