"""A data set of choices as arrays: candidates in groups, what describes them, and how they fared."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal, Self

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError, UnknownName
from .feature import Feature

__all__ = ["SPLITS", "ChoiceData", "SplitBy"]

SplitBy = Literal["object", "hand", "task"]
SPLITS = ("train", "valid", "test")


@dataclass(frozen=True, eq=False, repr=False)
class ChoiceData:
    """N candidates in G groups, of M objects; each candidate was tried under D draws at L loads.

    A group is one situation of choice: an object, a hand and the regions that touch. Its rows are
    contiguous, and its candidates were tried under the same draws.

    Attributes:
        features: (N, F) what describes a candidate, within the bounds of `feature_specs`.
        feature_specs: what the columns are.
        object_features: (M, O) what describes an object.
        object_specs: what the columns are.
        group: (N,) which group each candidate belongs to: 0 to G - 1, ascending.
        object_index: (N,) which object.
        object_ids: (M,) the objects by name.
        candidate_ids: (N,) unique names.
        hand: (N,) name of the hand.
        task: (N,) kind of the task.
        held: (N, D, L) whether the hand held the object.
        margin: (N, D, L) share of the limits of slip and turn that was left; at most 0 where it was not held.
        conditions: (G, D, C) what was drawn, the same for all candidates of a group.
        condition_names: what its last axis is.
        loads: (L,) multiples of the load, ascending.
        splits: by `object`, `hand` and `task`, to which part (N,) each candidate belongs: `train`, `valid` or
            `test`.
    """

    features: NDArray[np.float32]
    feature_specs: tuple[Feature, ...]
    object_features: NDArray[np.float32]
    object_specs: tuple[Feature, ...]
    group: NDArray[np.int64]
    object_index: NDArray[np.int64]
    object_ids: NDArray[np.str_]
    candidate_ids: NDArray[np.str_]
    hand: NDArray[np.str_]
    task: NDArray[np.str_]
    held: NDArray[np.bool_]
    margin: NDArray[np.float32]
    conditions: NDArray[np.float32]
    condition_names: tuple[str, ...]
    loads: tuple[float, ...]
    splits: dict[str, NDArray[np.str_]]

    def __len__(self) -> int:
        return len(self.group)

    def __repr__(self) -> str:
        where = f"{self.group_count} groups, {len(self.object_ids)} objects, hands {', '.join(self.hands)}"
        return f"<ChoiceData: {len(self)} candidates in {where}, draws and loads {self.held.shape[1:]}>"

    @property
    def feature_names(self) -> tuple[str, ...]:
        """Names of the columns of `features`."""
        return tuple(feature.name for feature in self.feature_specs)

    @property
    def formulas(self) -> dict[str, int]:
        """Features by which a person would rank candidates, with +1 where the largest is best, else -1."""
        return {feature.name: feature.formula for feature in self.feature_specs if feature.is_formula}

    @property
    def hands(self) -> tuple[str, ...]:
        """Names of the hands, sorted."""
        return tuple(np.unique(self.hand).tolist())

    @property
    def split(self) -> NDArray[np.str_]:
        """The split by object (N,)."""
        return self.splits["object"]

    @cached_property
    def starts(self) -> NDArray[np.int64]:
        """(G + 1,) first row of each group, and N at the end."""
        return np.concatenate([[0], 1 + np.flatnonzero(np.diff(self.group)), [len(self)]]).astype(np.int64)

    @property
    def group_count(self) -> int:
        """G."""
        return len(self.starts) - 1

    @property
    def sizes(self) -> NDArray[np.int64]:
        """(G,) candidates in each group."""
        return np.diff(self.starts)

    def groups(self) -> Iterator[slice]:
        """Rows of each group in turn."""
        for first, end in zip(self.starts[:-1], self.starts[1:], strict=True):
            yield slice(int(first), int(end))

    def load_index(self, load: float) -> int:
        """Place of a load on the last axis of `held`.

        Raises:
            InputError: the data has other loads.
        """
        if load not in self.loads:
            raise InputError("load", "", f"must be one of {', '.join(map(str, self.loads))}, not {load}")
        return self.loads.index(load)

    def part(self, name: str, *, by: SplitBy = "object") -> Self:
        """The candidates of one part of a split: `train`, `valid` or `test`.

        Raises:
            UnknownName: no such split or part.
        """
        if by not in self.splits:
            raise UnknownName("split", "", "split", by, self.splits)
        if name not in SPLITS:
            raise UnknownName("split", "", "part", name, SPLITS)
        return self.select(self.splits[by] == name)

    def select(self, rows: NDArray[np.bool_]) -> Self:
        """The candidates for which `rows` (N,) is true; groups are numbered anew, objects stay."""
        kept, group = np.unique(self.group[rows], return_inverse=True)
        return replace(
            self,
            features=self.features[rows],
            group=group.astype(np.int64),
            object_index=self.object_index[rows],
            candidate_ids=self.candidate_ids[rows],
            hand=self.hand[rows],
            task=self.task[rows],
            held=self.held[rows],
            margin=self.margin[rows],
            conditions=self.conditions[kept],
            splits={name: parts[rows] for name, parts in self.splits.items()},
        )
