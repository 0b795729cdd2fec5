"""The grasps among which an environment draws its candidates: made once by the whole chain, then kept."""

import hashlib
import json
from dataclasses import asdict, dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ... import __version__
from ...base.files.file_model import FileModel, parse
from ...base.files.file_paths import cache_folder
from ...base.files.json_file import read_json
from ...base.files.output_file import write_json
from ...errors import HoldfastError, InputError
from ...mjcf import Grasp, HoldSettings, NotHoldable, Squeeze, plan_squeeze
from ...objects import Task
from ...solver import Configuration, solve
from ..records import GraspRecord, fingerprint, to_configuration, to_json
from ..run import new_grasp, with_clearing
from .features import features
from .making import cleared_at_strength

__all__ = ["Candidate", "NoCandidate", "load_pool"]


class NoCandidate(HoldfastError):
    """A task has no grasp that could be squeezed, so there is nothing to choose among."""

    def __init__(self, task: Task):
        super().__init__(f"task {task.name}: none of its grasps can be freed of penetration and squeezed")


@dataclass(frozen=True, eq=False)
class Candidate:
    """A grasp of the pool.

    Attributes:
        id: its name in the pool.
        configuration: hand and object.
        clearance_m: smallest signed distance between bodies.
        squeeze: how the hand presses; None where no squeeze carries the weight.
        settings: what the squeeze was planned for.
        is_clear: whether nothing sinks in.
    """

    id: str
    configuration: Configuration
    clearance_m: float
    squeeze: Squeeze | None
    settings: HoldSettings
    is_clear: bool

    @property
    def is_valid(self) -> bool:
        """Whether the hand can be told to make this grasp at all."""
        return self.is_clear and self.squeeze is not None

    @cached_property
    def features(self) -> NDArray[np.float32]:
        """What a policy sees of it; see `features.features`."""
        return features(self.configuration, self.clearance_m, self.squeeze, self.settings)

    @cached_property
    def grasp(self) -> Grasp:
        """The grasp of a valid candidate; one for all episodes, as is the approach that it finds."""
        assert self.squeeze is not None
        return Grasp(self.configuration, self.squeeze)


class _PoolFile(FileModel):
    grasps: list[GraspRecord]


def load_pool(
    task: Task, *, size: int, seed: int, settings: HoldSettings, folder: Path | None = None
) -> tuple[Candidate, ...]:
    """The pool of a task: from the cache, or made anew (a second or two a grasp) and put there.

    Args:
        task: the task.
        size: grasps asked of the solver.
        seed: of the solver.
        settings: nominal settings, for which squeezes are planned.
        folder: of the cache; None takes the user's cache folder.

    Raises:
        NoCandidate: no grasp could be cleared and squeezed.
    """
    folder = folder or cache_folder() / "pools"
    path = folder / f"{task.name}-{_key(task, size, seed, settings)}.json"
    records = _read(path)
    if records is None:
        records = _make(task, size, seed, settings)
        _keep(path, records)
    pool = tuple(_candidate(record, task, settings, path) for record in records)
    if not any(candidate.is_valid for candidate in pool):
        raise NoCandidate(task)
    return pool


def _key(task: Task, size: int, seed: int, settings: HoldSettings) -> str:
    what = [__version__, fingerprint(task), size, seed, asdict(settings)]
    return hashlib.sha256(json.dumps(what).encode()).hexdigest()[:16]


def _read(path: Path) -> list[GraspRecord] | None:
    if not path.exists():
        return None
    try:
        return parse(_PoolFile, read_json(path), path).grasps
    except InputError:  # of an older version, or damaged: a cache may be made again
        return None


def _keep(path: Path, records: list[GraspRecord]) -> None:
    try:
        write_json(path, {"grasps": [to_json(record) for record in records]})
    except InputError:
        return  # a cache that can't be written costs time, not the result


def _make(task: Task, size: int, seed: int, settings: HoldSettings) -> list[GraspRecord]:
    records = []
    for number, configuration in enumerate(solve(task, candidates=size, seed=seed).configurations):
        clearing = cleared_at_strength(configuration, number, settings)
        records.append(with_clearing(new_grasp(configuration, f"g{number + 1:02d}"), clearing))
    return records


def _candidate(record: GraspRecord, task: Task, settings: HoldSettings, source: Path) -> Candidate:
    # From the written form even where the grasp has just been made: the same pool comes from the cache.
    configuration = to_configuration(record, task, source)
    squeeze = plan_squeeze(configuration, settings=settings)
    assert record.clearance is not None
    return Candidate(
        id=record.id,
        configuration=configuration,
        clearance_m=record.clearance.after,
        squeeze=None if isinstance(squeeze, NotHoldable) else squeeze,
        settings=settings,
        is_clear=record.is_clear,
    )
