"""The door out: nothing is replaced but regular files, and messages name the file as the user did."""

import os
import stat
import threading

import pytest
from holdfast.base.files.output_file import (
    check_folder_target,
    check_target,
    remove_parts,
    write_bytes,
    write_json,
)
from holdfast.errors import InputError


def test_links_are_followed(tmp_path):
    (tmp_path / "real").mkdir()
    link = tmp_path / "link.json"
    link.symlink_to("real/a.json")
    for text in (b"one", b"two"):  # the file is made, then replaced
        write_bytes(link, text)
        assert link.is_symlink() and (tmp_path / "real" / "a.json").read_bytes() == text
    assert os.listdir(tmp_path / "real") == ["a.json"]


def test_devices_are_written_through(tmp_path):
    link = tmp_path / "null"
    link.symlink_to("/dev/null")
    check_target(link)
    write_bytes(link, b"x")
    assert link.is_symlink() and stat.S_ISCHR(os.stat("/dev/null").st_mode)
    with pytest.raises(InputError, match=r"/dev/full: can't be written: no space left on device"):
        write_json(type(link)("/dev/full"), {})


def test_a_pipe_is_written_through(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    got = []
    reader = threading.Thread(target=lambda: got.append(pipe.read_bytes()))
    reader.start()
    write_bytes(pipe, b"x" * 200_000)
    reader.join()
    assert got == [b"x" * 200_000] and stat.S_ISFIFO(pipe.stat().st_mode)


def test_a_descriptor_of_this_process_is_written_at_its_place(tmp_path):
    path = tmp_path / "out"
    handle = os.open(path, os.O_WRONLY | os.O_CREAT)
    os.write(handle, b"before ")
    write_bytes(type(path)(f"/dev/fd/{handle}"), b"between ")
    os.write(handle, b"after")
    os.close(handle)
    assert path.read_bytes() == b"before between after"


def test_the_mode_of_a_file_stays(tmp_path):
    path = tmp_path / "a"
    write_bytes(path, b"one")
    path.chmod(0o600)
    write_bytes(path, b"two")
    assert stat.S_IMODE(path.stat().st_mode) == 0o600


def test_names_may_be_as_long_as_names_can_be(tmp_path):
    path = tmp_path / ("a" * 255)
    check_target(path)
    write_bytes(path, b"x")
    for check in (check_target, check_folder_target):
        with pytest.raises(InputError, match="too long"):
            check(tmp_path / ("a" * 256) / "b")


@pytest.mark.parametrize("name", ["folder", "file/x", "nul\0l", "loop"])
def test_what_can_not_be_written_is_said_before_and_after_the_work(name, tmp_path):
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").touch()
    (tmp_path / "loop").symlink_to("loop")
    before = sorted(os.listdir(tmp_path))
    for act in (check_target, lambda path: write_bytes(path, b"x")):
        with pytest.raises(InputError) as caught:
            act(tmp_path / name)
        assert caught.value.source == str(tmp_path / name) and ".part" not in str(caught.value)
    assert sorted(os.listdir(tmp_path)) == before


def test_halves_of_files_are_removed_and_nothing_else(tmp_path, monkeypatch):
    names = {".gitkeep", ".notes.part", "a.json"}
    for name in names:
        (tmp_path / name).touch()
    monkeypatch.setattr("os.fsync", lambda _: os.kill(os.getpid(), 0) or 1 / 0)
    with pytest.raises(ZeroDivisionError):
        write_bytes(tmp_path / "a.json", b"x")
    assert set(os.listdir(tmp_path)) == names
    (tmp_path / ".part-of-other").touch()
    remove_parts(tmp_path / "a.json")
    assert set(os.listdir(tmp_path)) == names | {".part-of-other"}
