"""The run folder on disk: every file whole or not at all, and `run.json` the one that counts."""

import fcntl
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ...errors import InputError
from ...files import write_json, write_text
from .grasp import GraspFile
from .run import RunRecord, read_run
from .solution import to_json

__all__ = ["RunFolder"]

_OURS = re.compile(r"(g\d+\.(json|xml)|g\d+_[a-z]+\.(png|gif)|\..+)")


class RunFolder:
    """Folder of one run: `run.json`, `report.html`, `grasps/<id>.json`, `grasps/<id>.xml`, `media/`.

    Files that `run.json` speaks of are written before it, so a kill at any moment leaves a `run.json` that is
    true of what lies beside it.
    """

    def __init__(self, path: Path):
        self.path = path

    @property
    def record_path(self) -> Path:
        """Path of `run.json`."""
        return self.path / "run.json"

    @property
    def report_path(self) -> Path:
        """Path of `report.html`."""
        return self.path / "report.html"

    @property
    def media(self) -> Path:
        """Folder of the pictures."""
        return self.path / "media"

    def grasp_path(self, identifier: str, suffix: str = ".json") -> Path:
        """Path of a grasp's JSON (or, by its suffix, MJCF) file."""
        return self.path / "grasps" / f"{identifier}{suffix}"

    @contextmanager
    def writing(self) -> Iterator[None]:
        """Creates the folder and keeps other runs out of it.

        Raises:
            InputError: the folder can't be made, holds something else, or another run is writing there.
        """
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            handle = os.open(self.path, os.O_RDONLY | os.O_DIRECTORY)
        except OSError as error:
            raise InputError(self.path, "", f"can't be used as a run folder: {error.strerror}") from None
        try:
            self._lock(handle)
            yield
        finally:
            os.close(handle)

    def _lock(self, handle: int) -> None:
        try:
            # The lock is the kernel's, so a killed run leaves none behind.
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise InputError(self.path, "", "another run is writing there") from None

    def start(self, record: RunRecord) -> None:
        """Begins anew, removing what an earlier run left.

        Raises:
            InputError: the folder is neither empty nor a run folder, so it may be precious.
        """
        strangers = [entry.name for entry in self.path.iterdir() if not entry.name.startswith(".")]
        if strangers and not self.record_path.exists():
            raise InputError(
                self.path, "", f"is not a run folder: it holds {sorted(strangers)[0]!r} but no run.json"
            )
        self.save(record)
        for entry in [*self._entries("grasps"), *self._entries("media")]:
            # Only what a run has written goes; notes that someone put there stay.
            if _OURS.fullmatch(entry.name):
                entry.unlink()
        self.report_path.unlink(missing_ok=True)

    def _entries(self, name: str) -> list[Path]:
        folder = self.path / name
        return [entry for entry in folder.iterdir() if entry.is_file()] if folder.is_dir() else []

    def load(self) -> RunRecord:
        """What `run.json` says.

        Raises:
            InputError: there is none, or it can't be used.
        """
        return read_run(self.record_path)

    def save(self, record: RunRecord) -> None:
        """Writes `run.json`."""
        write_json(self.record_path, to_json(record))

    def save_grasp(self, grasp: GraspFile, mjcf: str | None) -> None:
        """Writes a grasp's own files."""
        if mjcf is not None:
            write_text(self.grasp_path(grasp.id, ".xml"), mjcf)
        write_json(self.grasp_path(grasp.id), to_json(grasp))
