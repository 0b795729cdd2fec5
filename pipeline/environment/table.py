"""Situations whose outcomes are known: a step costs microseconds."""

from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...arguments import check_path
from ...errors import InputError
from ..choice import ChoiceData, Feature, SplitBy, TrialOutcome, load_dataset, shipped_dataset
from .episode import Slots

if TYPE_CHECKING:
    from ...solver import Configuration
    from .stored import StoredSituations

__all__ = ["Table", "TableEpisode"]


class Table:
    """A data set as a back end: a group and one of its draws make an episode.

    Args:
        dataset: its folder, or the data; None takes the small one that comes with the package.
        split: take this part alone: `train`, `valid` or `test`; None takes all.
        by: by `object`, `hand` or `task`.
        load: multiple of the load at which outcomes count.

    Attributes:
        data: the candidates.
        load_index: place of the load in `data.held`.

    Raises:
        InputError: no such data set, part, or load.
    """

    def __init__(
        self,
        dataset: str | Path | ChoiceData | None = None,
        *,
        split: str | None = None,
        by: SplitBy = "object",
        load: float = 1.0,
    ):
        if not isinstance(dataset, ChoiceData) and dataset is not None:
            dataset = check_path("dataset", dataset)
        data = dataset if isinstance(dataset, ChoiceData) else load_dataset(dataset)
        self.data = data if split is None else data.part(split, by=by)
        if not len(self.data):
            raise InputError("split", "", f"the data has no candidates for {split!r} by {by}")
        self.load_index = data.load_index(load)
        self._folder = None if isinstance(dataset, ChoiceData) else Path(dataset or shipped_dataset())
        starts = self.data.starts.tolist()
        self._groups = [(first, end, self._about(first)) for first, end in pairwise(starts)]
        self._ids = self.data.candidate_ids.tolist()
        self._objects = self.data.object_features[self.data.object_index]

    @property
    def features(self) -> tuple[Feature, ...]:
        """Of candidates."""
        return self.data.feature_specs

    @property
    def object_features(self) -> tuple[Feature, ...]:
        """Of objects."""
        return self.data.object_specs

    def draw(self, rng: np.random.Generator, count: int) -> "TableEpisode":
        """A group, one of its draws, and at most `count` of its candidates in any order."""
        group = int(rng.integers(len(self._groups)))
        first, end, about = self._groups[group]
        draw = int(rng.integers(self.data.held.shape[1]))
        rows = first + rng.permutation(end - first)[:count]
        ids = self._ids
        slots = Slots(
            self.data.features[rows], self._objects[first], [ids[row] for row in rows.tolist()], about
        )
        return TableEpisode(self, group, rows, draw, slots)

    def trial(self, row: int, draw: int) -> TrialOutcome:
        """What became of a candidate under a draw."""
        held = bool(self.data.held[row, draw, self.load_index])
        margin = float(self.data.margin[row, draw, self.load_index])
        return TrialOutcome(held, margin, "held" if held else "not held")

    def conditions(self, group: int, draw: int) -> dict[str, float]:
        """What was drawn."""
        values = self.data.conditions[group, draw].tolist()
        return dict(zip(self.data.condition_names, values, strict=True))

    def configuration(self, row: int) -> "Configuration | None":
        """Hand and object of a candidate; None where the data set doesn't keep them."""
        if self._stored is None:
            return None
        group, _, candidate = self._ids[row].partition("/")
        return self._stored.configuration(group, candidate)

    @cached_property
    def _stored(self) -> "StoredSituations | None":
        from .stored import StoredSituations  # with solver and simulator, which take seconds to import

        return None if self._folder is None else StoredSituations.of(self._folder)

    def _about(self, row: int) -> dict[str, Any]:
        data = self.data
        return {
            "object": str(data.object_ids[data.object_index[row]]),
            "hand": str(data.hand[row]),
            "task": str(data.task[row]),
        }


class TableEpisode:
    """A group and a draw."""

    __slots__ = ("_draw", "_group", "_rows", "_table", "slots")

    def __init__(self, table: Table, group: int, rows: NDArray[np.int64], draw: int, slots: Slots):
        self._table, self._group, self._rows, self._draw = table, group, rows, draw
        self.slots = slots

    def outcome(self, slot: int) -> TrialOutcome:
        """What became of a candidate."""
        return self._table.trial(int(self._rows[slot]), self._draw)

    def conditions(self) -> dict[str, float]:
        """What was drawn."""
        return self._table.conditions(self._group, self._draw)

    def configuration(self, slot: int) -> "Configuration | None":
        """Hand and object of a candidate."""
        return self._table.configuration(int(self._rows[slot]))
