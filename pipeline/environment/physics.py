"""Situations that are tried in MuJoCo as they are chosen."""

import hashlib
import json
import zlib
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ... import __version__
from ...arguments import check_instance, check_number, check_path, check_whole_number
from ...base.files.file_model import parse
from ...base.files.file_paths import cache_folder
from ...base.files.json_file import read_json
from ...base.files.output_file import write_json
from ...base.machine.backend import configure
from ...errors import HoldfastError, InputError
from ...hands import load_hand
from ...mjcf import preset_settings
from ...objects.families import FAMILIES, FAMILY_PREFIX
from ...solver import Configuration
from ..choice import (
    CONDITIONS,
    DATASET_FILE,
    OBJECT_FEATURES,
    DrawRanges,
    Feature,
    TrialOutcome,
    candidate_specs,
    category,
    check_reference,
    draw,
    find_situation,
    make_candidates,
    own_hand,
    read_head,
    shipped_dataset,
    try_under,
)
from .episode import Slots
from .stored import Pool, PoolFile, StoredSituations

__all__ = ["NothingToChoose", "Physics", "PhysicsEpisode"]

# Members of a family that are drawn where no seed says which.
_MEMBERS = 1000
# Objects without a candidate in a row, before it is given up.
_MOST_DRAWN = 20


class NothingToChoose(HoldfastError):
    """None of the objects has grasps that could be tried."""

    def __init__(self, references: Sequence[str]):
        super().__init__(f"no candidate of {', '.join(references)} is certified, clear and squeezed")


@dataclass(frozen=True)
class _Source:
    """An object or a task, or a family of which any member is drawn, with a hand."""

    reference: str
    hand: str

    def member(self, rng: np.random.Generator) -> "_Source":
        """Itself; of a family without a seed a member that is drawn."""
        family = self.reference.removeprefix(FAMILY_PREFIX)
        if self.reference.startswith(FAMILY_PREFIX) and family in FAMILIES:
            return _Source(f"{self.reference}:{int(rng.integers(_MEMBERS))}", self.hand)
        return self


class Physics:
    """A back end that puts the chosen candidate to the test; see `choice.try_under`.

    Args:
        objects: what is grasped: `family:mug:17`, or `family:mug` for any member of it; built-in objects and
            tasks, meshes, object and task files. None replays the candidates of a data set.
        hands: names or files of hands, each with each object; of tasks, unless given, their own hand, and the
            hand `sa` for what is no task.
        dataset: folder of the data set to replay; None takes the small one that comes with the package.
        pool: candidates that are made of an object with a hand, some seconds once; then they are kept.
        pool_seed: of these.
        ranges: what is hidden; None takes the data set's, or the usual.
        load: multiple of the task's load.
        cache: folder where pools are kept; None takes the user's cache folder.

    Raises:
        InputError: an object, a hand or a data set that can't be used.
    """

    def __init__(
        self,
        objects: Sequence[str] | None = None,
        *,
        hands: Sequence[str] | None = None,
        dataset: str | Path | None = None,
        pool: int = 16,
        pool_seed: int = 0,
        ranges: DrawRanges | None = None,
        load: float = 1.0,
        cache: str | Path | None = None,
    ):
        check_whole_number("pool", pool, least=1)
        check_whole_number("pool_seed", pool_seed, least=0)
        check_number("load", load, above=0.0)
        configure()  # before anything imports MuJoCo, which settles on its renderer then
        self._size, self._seed, self._load = pool, pool_seed, load
        if ranges is not None:
            check_instance("ranges", ranges, DrawRanges, "DrawRanges")
        self._cache = cache_folder() / "choice-pools" if cache is None else check_path("cache", cache)
        self._stored: StoredSituations | None = None
        self._sources: list[_Source] = []
        self._pools: dict[_Source, Pool | None] = {}
        if objects is None:
            if hands is not None:
                raise InputError("hands", "", "can be given where objects are")
            folder = shipped_dataset() if dataset is None else check_path("dataset", dataset)
            head = read_head(folder / DATASET_FILE)
            self._stored = StoredSituations.of(folder)
            if self._stored is None:
                raise InputError(folder, "", "keeps no situations to replay")
            self._features = tuple(
                Feature.from_record(entry, str(folder), f"features.{k}")
                for k, entry in enumerate(head["features"])
            )
            self._ranges = ranges or DrawRanges.from_record(head.get("draw_ranges"), str(folder))
            return
        if dataset is not None:
            raise InputError("dataset", "", "can be given where no objects are")
        by_hand = ("",) if hands is None else _names("hands", hands, "sa")
        named = _names("objects", objects, "family:mug:17")
        self._sources = [_Source(reference, hand) for reference in named for hand in by_hand]
        self._ranges = ranges or DrawRanges()
        self._features = candidate_specs(max(_joints(source) for source in self._sources))

    def __getstate__(self) -> dict[str, Any]:
        # Pools are read again where they are needed.
        return {**self.__dict__, "_pools": {}}

    @property
    def features(self) -> tuple[Feature, ...]:
        """Of candidates."""
        return self._features

    @property
    def object_features(self) -> tuple[Feature, ...]:
        """Of objects."""
        return OBJECT_FEATURES

    def draw(self, rng: np.random.Generator, count: int) -> "PhysicsEpisode":
        """An object, what is hidden of it, and at most `count` of its candidates in any order.

        Raises:
            NothingToChoose: of many objects in a row none has a candidate.
        """
        refused = []
        for _ in range(_MOST_DRAWN):
            pool = self._drawn_pool(rng)
            if isinstance(pool, Pool):
                conditions = draw(rng, pool.task.object, self._ranges)
                chosen = rng.permutation(len(pool.candidates))[:count].tolist()
                return PhysicsEpisode(pool, chosen, conditions, self._load, len(self._features))
            refused.append(pool)
        raise NothingToChoose(sorted(set(refused)))

    def _drawn_pool(self, rng: np.random.Generator) -> Pool | str:
        """The candidates of what is drawn, or its name where there are none."""
        if self._stored is not None:
            return self._stored.pool(self._stored.names[int(rng.integers(len(self._stored.names)))])
        source = self._sources[int(rng.integers(len(self._sources)))].member(rng)
        if source not in self._pools:
            self._pools[source] = self._read(source) or self._make(source)
        return self._pools[source] or source.reference

    def _path(self, source: _Source) -> Path:
        what = [__version__, source.reference, source.hand, self._size, self._seed]
        key = hashlib.sha256(json.dumps(what).encode()).hexdigest()[:16]
        return self._cache / f"{category(source.reference)[:40]}-{key}.json"

    def _read(self, source: _Source) -> Pool | None:
        path = self._path(source)
        try:
            file = parse(PoolFile, read_json(path), path)
            return Pool(file, str(path)) if file.candidates else None
        except InputError:  # not there, damaged, or of a mesh that has changed: a cache may be made again
            return None

    def _make(self, source: _Source) -> Pool | None:
        found = find_situation(source.reference, source.hand, seed=self._seed)
        if found is None:
            return None
        situation, task = found
        seed = zlib.crc32(f"{self._seed} {source.reference} {source.hand}".encode()) % 2**31
        made = make_candidates(task, self._size, seed=seed, settings=preset_settings("holdfast", task))
        if not made.candidates:
            return None
        file, path = PoolFile(situation=situation, candidates=list(made.candidates)), self._path(source)
        with suppress(InputError):  # a cache that can't be written costs time, not the result
            write_json(path, file.model_dump(mode="json"))
        return Pool(file, str(path))


class PhysicsEpisode:
    """Candidates of an object, and what is hidden of it."""

    def __init__(
        self, pool: Pool, chosen: list[int], conditions: NDArray[np.float32], load: float, width: int
    ):
        self._pool, self._chosen, self._conditions, self._load = pool, chosen, conditions, load
        rows = np.zeros((len(chosen), width), dtype=np.float32)
        for row, k in zip(rows, chosen, strict=True):
            values = pool.candidates[k].features
            row[: len(values)] = values
        self.slots = Slots(
            rows, pool.object_features, [pool.candidates[k].solution.id for k in chosen], dict(pool.about)
        )

    def outcome(self, slot: int) -> TrialOutcome:
        """What becomes of a candidate in MuJoCo."""
        grasp = self._pool.grasp(self._chosen[slot])
        return try_under(grasp, self._conditions, (self._load,), self._pool.settings)[0]

    def conditions(self) -> dict[str, float]:
        """What was drawn."""
        names = (name for name, _, _ in CONDITIONS)
        return dict(zip(names, self._conditions.tolist(), strict=True))

    def configuration(self, slot: int) -> Configuration | None:
        """Hand and object of a candidate."""
        return self._pool.grasp(self._chosen[slot]).configuration


def _names(argument: str, given: object, example: str) -> list[str]:
    """Names and paths of a list, at least one.

    Raises:
        InputError: it is none, such as a single name, or is empty.
    """
    if not isinstance(given, Sequence) or isinstance(given, str | bytes) or not given:
        raise InputError(argument, "", f"must be a list of at least one name or file, such as [{example!r}]")
    return [str(check_path(f"{argument}[{k}]", name)) for k, name in enumerate(given)]


def _joints(source: _Source) -> int:
    """Independent joints of a source's hand; a task's own is that of its file.

    Raises:
        InputError: no such hand, object or task.
    """
    check_reference(source.reference)
    hand = load_hand(source.hand, source="hands") if source.hand else own_hand(source.reference)
    return len(hand.independent)
