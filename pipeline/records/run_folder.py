"""The run folder on disk: every file whole or not at all, and `run.json` the one that counts."""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ...base.files.folder_lock import locked_folder
from ...base.files.output_file import json_text, remove_parts, write_json, write_text
from ...errors import InputError
from .difference import difference
from .grasp import GraspFile, GraspRecord
from .run import RunRecord, read_run
from .solution import to_json

__all__ = ["RunFolder"]

# Pictures of a grasp, by what stands behind its name.
_PICTURES = ("front.png", "left.png", "back.png", "right.png", "hold.png", "hold.webp")
# A record without grasps has this.
_NO_GRASPS = '\n "grasps": []'
_PART = re.compile(r"\.[0-9a-f]{8}-[0-9a-f]{8}\.part")


class RunFolder:
    """Folder of one run: `run.json`, `report.html`, `README.md`, `grasps/<id>.json` and `.xml`, `media/`.

    Files that `run.json` speaks of are written before it, so a kill at any moment leaves a `run.json` that is
    true of what lies beside it.
    """

    def __init__(self, path: Path):
        self.path = path
        # Of the grasps in the record that was written last: the record of each, and its text.
        self._texts: dict[str, tuple[GraspRecord, str]] = {}

    @property
    def record_path(self) -> Path:
        """Path of `run.json`."""
        return self.path / "run.json"

    @property
    def report_path(self) -> Path:
        """Path of `report.html`."""
        return self.path / "report.html"

    @property
    def readme_path(self) -> Path:
        """Path of `README.md`."""
        return self.path / "README.md"

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
        with locked_folder(self.path, "run"):
            self._check_folders()
            yield

    def _unusable(self, error: OSError | ValueError) -> InputError:
        reason = getattr(error, "strerror", None) or "is not the path of a folder"
        return InputError(self.path, "", f"can't be used as a run folder: {reason}")

    def _check_folders(self) -> None:
        """What lies behind a link is not the run's own; a run would mix with it, and take it for its own."""
        for folder in (self.path / "grasps", self.media):
            if folder.is_symlink():
                raise InputError(folder, "", "is a link; a run needs folders of its own there")

    @property
    def is_free(self) -> bool:
        """Whether nothing lies here but, perhaps, hidden files."""
        try:
            return all(entry.name.startswith(".") for entry in self.path.iterdir())
        except FileNotFoundError:
            return True
        except (OSError, ValueError) as error:
            raise self._unusable(error) from None

    def start(self, record: RunRecord, *, force: bool = False) -> None:
        """Begins anew, removing what an earlier run left: the files that its `run.json` speaks of, no others.

        Args:
            record: of the new run.
            force: whether a run may be replaced that is not the same, by `difference`.

        Raises:
            InputError: the folder is neither empty nor a run folder, so it may be precious; or what lies
                there is another run.
        """
        if not self.is_free and not self.record_path.exists():
            strangers = [entry.name for entry in self.path.iterdir() if not entry.name.startswith(".")]
            raise InputError(
                self.path, "", f"is not a run folder: it holds {sorted(strangers)[0]!r} but no run.json"
            )
        earlier = self._earlier(force=force)
        if earlier is not None and not force and (found := difference(record, earlier)):
            raise InputError(
                self.record_path,
                found.field,
                f"is {found.theirs}, but this run's is {found.ours}: name another folder by --out, or add "
                "--force to replace that run",
            )
        self.save(record)
        if earlier is not None:
            for path in self._files_of(earlier):
                path.unlink(missing_ok=True)

    def _earlier(self, *, force: bool) -> RunRecord | None:
        """The run that lies here, None where there is none."""
        if not self.record_path.exists():
            return None
        try:
            return self.load()
        except InputError as error:
            if force:  # nothing is known of what it wrote, so that stays
                return None
            raise InputError(
                self.record_path,
                error.field,
                f"{error.allowed}; name another folder by --out, or add --force to replace it",
            ) from None

    def _files_of(self, record: RunRecord) -> Iterator[Path]:
        """What a run has written beside its record."""
        yield self.report_path
        yield self.readme_path
        for grasp in record.grasps:
            yield self.grasp_path(grasp.id)
            yield self.grasp_path(grasp.id, ".xml")
            yield from (self.media / f"{grasp.id}_{picture}" for picture in _PICTURES)
        yield self.media / "task.png"
        yield from self.media.glob("earlier*")  # of runs before it, in its place

    def remove_parts(self) -> None:
        """Removes halves of files that a killed run has left; the lock keeps other runs away."""
        for path in (self.record_path, self.report_path, self.readme_path):
            remove_parts(path)
        for folder in (self.path / "grasps", self.media):
            for part in folder.glob(".*.part"):
                if _PART.fullmatch(part.name):
                    part.unlink(missing_ok=True)

    def load(self) -> RunRecord:
        """What `run.json` says.

        Raises:
            InputError: there is none, or it can't be used.
        """
        if self.path.is_dir() and not self.record_path.exists():
            raise InputError(self.path, "", f"is not a run folder: there is no {self.record_path.name} in it")
        return read_run(self.record_path)

    def save(self, record: RunRecord) -> None:
        """Writes `run.json`; the text of a grasp that is as it was is not made anew, which takes the time."""
        texts = {grasp.id: self._text(grasp) for grasp in record.grasps}
        whole = json_text(to_json(record.model_copy(update={"grasps": []})))
        if texts:
            listed = ",\n  ".join(text for _, text in texts.values())
            # No string has such a line: its own breaks are written as escapes.
            whole = whole.replace(_NO_GRASPS, f"{_NO_GRASPS[:-1]}\n  {listed}\n ]", 1)
        write_text(self.record_path, whole + "\n")
        self._texts = texts

    def _text(self, grasp: GraspRecord) -> tuple[GraspRecord, str]:
        """A grasp with what stands for it in `run.json`."""
        known = self._texts.get(grasp.id)
        if known is not None and known[0] is grasp:
            return known
        return grasp, json_text(to_json(grasp)).replace("\n", "\n  ")

    def save_grasp(self, grasp: GraspFile, mjcf: str | None = None) -> None:
        """Writes a grasp's own files; None leaves the model as it is."""
        if mjcf is not None:
            write_text(self.grasp_path(grasp.id, ".xml"), mjcf)
        write_json(self.grasp_path(grasp.id), to_json(grasp))
