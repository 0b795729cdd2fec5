"""The folder of a batch: what is to be run, what came of each item, and what is set aside as damaged."""

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TypeAlias

from ... import __version__
from ...base.files.file_model import FileModel, parse
from ...base.files.folder_lock import locked_folder
from ...base.files.json_file import read_json
from ...base.files.output_file import remove_parts, write_json
from ...errors import InputError
from ...objects import looks_like_mesh
from ..records import RunFolder, relative_source, resolve_source, setting_difference, to_json
from .item import Item, items_of
from .outcome import Outcome

__all__ = ["BatchFolder", "BatchPlan", "Settings"]

_MOST_ASIDE = 1000

Settings: TypeAlias = dict[str, bool | int | float | str | None]


class BatchPlan(FileModel):
    """`batch.json`: what a batch was asked for.

    Attributes:
        holdfast: version that began it.
        items: names of the items with what loads each: a built-in name, or a path from this file's folder.
        settings: what the results depend on, by name.
    """

    holdfast: str
    items: dict[str, str]
    settings: Settings


class BatchFolder:
    """`batch.json`, `outcomes/<name>.json`, `runs/<name>/`, and what is made of them in the end.

    Attributes:
        path: of the folder.
    """

    def __init__(self, path: Path):
        self.path = path

    @property
    def plan_path(self) -> Path:
        """What is to be run."""
        return self.path / "batch.json"

    @property
    def index_path(self) -> Path:
        """The page."""
        return self.path / "index.html"

    def run_path(self, item: Item) -> Path:
        """The run folder of an item."""
        return self.path / "runs" / item.name

    def outcome_path(self, item: Item) -> Path:
        """What became of an item."""
        return self.path / "outcomes" / f"{item.name}.json"

    @contextmanager
    def writing(self) -> Iterator[None]:
        """Makes the folder, and keeps other batches out of it.

        Raises:
            InputError: it can't be made, holds links in place of its own folders, or another batch is at it.
        """
        with locked_folder(self.path, "batch"):
            for folder in (self.path / "runs", self.path / "outcomes"):
                if folder.is_symlink():
                    raise InputError(folder, "", "is a link; a batch needs folders of its own there")
            for path in (self.plan_path, self.index_path):
                remove_parts(path)
            yield

    def begin(self, items: Sequence[Item], settings: Settings, *, resume: bool) -> None:
        """Writes the plan, or looks whether the one that lies here is the same.

        Raises:
            InputError: something else lies here; or a batch that is not to be resumed, of another version, or
                with other tasks or settings.
        """
        plan = BatchPlan(
            holdfast=__version__,
            items={item.name: self._written(item) for item in items},
            settings=settings,
        )
        if self.plan_path.exists():
            if not resume:
                raise InputError(self.path, "", "holds a batch: go on by --resume, or name another folder")
            self._check_same(plan, self.plan())
            return
        strangers = sorted(entry.name for entry in self.path.iterdir() if not entry.name.startswith("."))
        if strangers:
            found = f"it holds {strangers[0]!r} but no batch.json"
            raise InputError(self.path, "", f"is not a batch folder: {found}")
        write_json(self.plan_path, to_json(plan))

    def plan(self) -> BatchPlan:
        """What is to be run.

        Raises:
            InputError: there is no plan, or it can't be used.
        """
        return parse(BatchPlan, read_json(self.plan_path), self.plan_path)

    def planned_items(self) -> list[Item]:
        """The items of the plan that lies here."""
        return items_of(self._loaded(reference) for reference in self.plan().items.values())

    def outcome(self, item: Item) -> Outcome | None:
        """What became of an item; None where that is not known yet.

        Raises:
            InputError: its file is damaged, or of another item.
        """
        path = self.outcome_path(item)
        if not path.exists():
            return None
        found = parse(Outcome, read_json(path), path)
        if (found.name, found.reference) != (item.name, self._written(item)):
            raise InputError(path, "reference", f"is {found.reference[:80]!r}, which is another item")
        return found

    def save(self, item: Item, outcome: Outcome) -> None:
        """Writes what became of an item."""
        written = outcome.model_copy(update={"reference": self._written(item)})
        write_json(self.outcome_path(item), to_json(written))

    def whole_outcome(self, item: Item) -> tuple[Outcome | None, list[str]]:
        """The outcome of an item that need not be run again, and what had to be set aside, in words.

        What is damaged is set aside, never trusted: an outcome's file, or a `run.json`.
        """
        try:
            outcome = self.outcome(item)
        except InputError as error:
            return None, [self._set_aside(self.outcome_path(item), error)]
        if outcome is None or outcome.state != "done":
            return None, self._set_damaged_aside([self.run_path(item)])
        folders = [self.path / run.folder for run in outcome.runs]
        damaged = self._set_damaged_aside(folders)
        is_whole = not damaged and all(
            run.complete and (self.path / run.folder / "run.json").is_file() for run in outcome.runs
        )
        return (outcome if is_whole else None), damaged

    def _set_damaged_aside(self, folders: list[Path]) -> list[str]:
        """Sets run folders aside whose record can't be read, or is gone, with all that lies in them."""
        words = []
        for folder in folders:
            if not RunFolder(folder).is_free:
                try:
                    RunFolder(folder).load()
                except InputError as error:
                    words.append(self._set_aside(folder, error))
        return words

    def _set_aside(self, path: Path, error: InputError) -> str:
        """Moves what is damaged out of the way; what was wrong with it and where it lies, in words."""
        for k in range(1, _MOST_ASIDE):
            aside = self.path / "damaged" / f"{path.parent.name}_{path.name}.{k}"
            if not aside.exists():
                break
        try:
            aside.parent.mkdir(exist_ok=True)
            path.rename(aside)
        except OSError as refused:
            raise InputError(path, "", f"is damaged, and can't be set aside: {refused.strerror}") from None
        return f"{error}; set aside as {aside.relative_to(self.path)}"

    def _check_same(self, plan: BatchPlan, earlier: BatchPlan) -> None:
        if plan.holdfast != earlier.holdfast:
            said = f"is {earlier.holdfast[:40]!r}, but this is {plan.holdfast!r}"
            raise InputError(self.plan_path, "holdfast", f"{said}: can't resume another version's batch")
        if found_difference := setting_difference(plan.settings, earlier.settings):
            raise InputError(self.plan_path, f"settings.{found_difference.field}", found_difference.words)
        if plan.items != earlier.items:
            other = sorted(set(plan.items.items()) ^ set(earlier.items.items()))
            why = f"{other[0][1]!r} is in one of them alone" if other else "their order differs"
            raise InputError(self.plan_path, "items", f"are other tasks ({why}): can't resume")

    def _written(self, item: Item) -> str:
        if item.is_mesh:
            return os.path.relpath(os.path.realpath(item.reference), os.path.realpath(self.path))
        return relative_source(item.reference, self.plan_path)

    def _loaded(self, reference: str) -> str:
        is_mesh = looks_like_mesh(reference)
        return str(self.path / reference) if is_mesh else resolve_source(reference, self.plan_path)
