"""Candidates of a data set with all that a test needs, one situation at a time."""

import json
import zipfile
from functools import lru_cache
from pathlib import Path
from typing import Any, Self

from ...base.files.file_model import FileModel, parse
from ...errors import InputError
from ...mjcf import Grasp, HoldSettings, preset_settings
from ...objects import Task
from ...solver import Configuration
from ..choice import SITUATIONS_FILE, Situation, StoredCandidate, category, object_features, task_of, to_grasp

__all__ = ["Pool", "PoolFile", "StoredSituations"]

_LARGEST_BYTES = 64 * 2**20
_MOST_KEPT = 256


class PoolFile(FileModel):
    """Candidates of a situation, in a file."""

    situation: Situation
    candidates: list[StoredCandidate]


class Pool:
    """Candidates of a situation, ready to be tried; grasps are made as they are needed.

    Args:
        file: what is written of them.
        source: where, for messages.

    Attributes:
        task: their task.
        settings: of tests.
        candidates: as written.
        object_features: of the object.
        about: object, hand and task by name.
    """

    def __init__(self, file: PoolFile, source: str):
        self._source = source
        self.task: Task = task_of(file.situation, source)
        self.settings: HoldSettings = preset_settings("holdfast", self.task)
        self.candidates = file.candidates
        self.object_features = object_features(self.task.object)
        kind = f"{category(file.situation.object)}-{len(self.task.contacts)}"
        self.about = {"object": file.situation.object, "hand": self.task.hand.name, "task": kind}
        self._grasps: dict[int, Grasp] = {}

    def grasp(self, k: int) -> Grasp:
        """A candidate's grasp."""
        if k not in self._grasps:
            self._grasps[k] = to_grasp(self.candidates[k], self.task, self.settings, self._source)
        return self._grasps[k]


class StoredSituations:
    """The situations of a data set.

    Args:
        path: of their archive.

    Raises:
        InputError: a damaged archive.
    """

    def __init__(self, path: Path):
        self._path = path
        try:
            with zipfile.ZipFile(path) as archive:
                self.names = sorted(name.removesuffix(".json") for name in archive.namelist())
        except (zipfile.BadZipFile, OSError):
            raise InputError(path, "", "is damaged") from None

    @classmethod
    def of(cls, folder: Path) -> Self | None:
        """Those of a data set; None where they were left out of its folder."""
        path = folder / SITUATIONS_FILE
        return cls(path) if path.exists() else None

    def pool(self, name: str) -> Pool:
        """The candidates of a situation.

        Raises:
            InputError: no such situation, a damaged one, or one of an object that is no longer the same.
        """
        return _pool(self._path, name)

    def configuration(self, name: str, candidate: str) -> Configuration | None:
        """Hand and object of a candidate; None where there is none of that name."""
        pool = self.pool(name)
        for k, one in enumerate(pool.candidates):
            if one.solution.id == candidate:
                return pool.grasp(k).configuration
        return None


@lru_cache(maxsize=_MOST_KEPT)
def _pool(path: Path, name: str) -> Pool:
    source = f"{path}: {name}.json"
    try:
        with zipfile.ZipFile(path) as archive:
            entry = archive.getinfo(f"{name}.json")
            if entry.file_size > _LARGEST_BYTES:
                raise InputError(source, "", "is too large")
            content: Any = json.loads(archive.read(entry))
    except KeyError:
        raise InputError(source, "", "is not in the archive") from None
    except (zipfile.BadZipFile, OSError, ValueError, RecursionError):
        raise InputError(source, "", "is damaged") from None
    if not isinstance(content, dict):
        raise InputError(source, "", "must be a JSON object")
    return Pool(parse(PoolFile, content, source), source)
