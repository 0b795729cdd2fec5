"""Situations in which one of several candidate grasps is to be chosen, and what becomes of each of them."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...base.numeric.arrays import Array, Indices, Mask
from ..choice import ChoiceData, Feature

__all__ = ["Names", "Padded", "Situations", "to_situations"]

Names = NDArray[np.str_]
"""A name of each element."""


@dataclass(frozen=True, eq=False)
class Padded:
    """Values of candidates in a rectangle, a row for each situation.

    Attributes:
        values: (G, K, ...); zeros where a situation has fewer candidates.
        there: (G, K), where a candidate is.
    """

    values: NDArray[np.generic]
    there: Mask


@dataclass(frozen=True, eq=False)
class Situations:
    """G situations with N candidates in all; those of a situation are neighbours.

    Attributes:
        features: (N, F).
        columns: what they are, F of them.
        first: (G + 1,), where the candidates of each situation begin, and N.
        held: (N, D, L), whether a candidate held in each draw of the hidden conditions, under each load.
        margin: (N, D, L), share of the limits of slip and turn that was left; at most 0 where not held.
        loads: (L,), multiples of the object's weight.
        objects: (G,), name of each situation's object.
        families: (G,), of which kind it is.
        hands: (G,), name of the hand.
        tasks: (G,), kind of the task.
        of_object: names of the features that are the same for all candidates of a situation.
    """

    features: Array
    columns: tuple[Feature, ...]
    first: Indices
    held: NDArray[np.bool_]
    margin: Array
    loads: Array
    objects: Names
    families: Names
    hands: Names
    tasks: Names
    of_object: frozenset[str] = frozenset()

    def __len__(self) -> int:
        return len(self.first) - 1

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the features."""
        return tuple(column.name for column in self.columns)

    @property
    def formulas(self) -> tuple[Feature, ...]:
        """The features by which a person would choose."""
        return tuple(column for column in self.columns if column.is_formula)

    @cached_property
    def sizes(self) -> Indices:
        """Candidates of each situation (G,)."""
        return np.diff(self.first)

    @cached_property
    def situation(self) -> Indices:
        """The situation of each candidate (N,)."""
        return np.repeat(np.arange(len(self)), self.sizes)

    @cached_property
    def place(self) -> Indices:
        """The place of each candidate in its situation (N,), from 0: the usual order."""
        return np.arange(len(self.features)) - self.first[self.situation]

    def load_index(self, load: float) -> int:
        """Which of the loads is the nearest."""
        return int(np.abs(self.loads - load).argmin())

    def chance(self, load: int) -> Array:
        """Share of the draws in which each candidate held (N,), under the load of that index."""
        return self.held[:, :, load].mean(axis=1)

    def take(self, chosen: Indices) -> "Situations":
        """Some of the situations, in the order that is given."""
        rows = self.rows(chosen)
        return replace(
            self,
            features=self.features[rows],
            first=np.concatenate([[0], np.cumsum(self.sizes[chosen])]).astype(np.int64),
            held=self.held[rows],
            margin=self.margin[rows],
            objects=self.objects[chosen],
            families=self.families[chosen],
            hands=self.hands[chosen],
            tasks=self.tasks[chosen],
        )

    def rows(self, chosen: Indices) -> Indices:
        """The candidates of some situations, in the order of these."""
        if not len(chosen):
            return np.zeros(0, dtype=np.int64)
        return np.concatenate([np.arange(self.first[g], self.first[g + 1]) for g in chosen])

    def padded(self, values: NDArray[np.generic]) -> Padded:
        """Values (N, ...) of the candidates as a rectangle."""
        width = int(self.sizes.max(initial=0))
        there = np.arange(width) < self.sizes[:, None]
        rectangle = np.zeros((len(self), width, *values.shape[1:]), dtype=values.dtype)
        rectangle[there] = values
        return Padded(rectangle, there)


def to_situations(data: ChoiceData) -> Situations:
    """The situations of a data set, with what describes an object beside what describes a candidate."""
    begins = data.starts[:-1]
    objects = data.object_ids[data.object_index[begins]]
    return Situations(
        features=np.hstack([data.features, data.object_features[data.object_index]]).astype(np.float64),
        columns=(*data.feature_specs, *data.object_specs),
        first=data.starts,
        held=data.held,
        margin=data.margin.astype(np.float64),
        loads=np.array(data.loads),
        objects=objects,
        families=np.array([_family(name) for name in objects]),
        hands=data.hand[begins],
        tasks=data.task[begins],
        of_object=frozenset(column.name for column in data.object_specs),
    )


def _family(name: str) -> str:
    """`mug` of `family:mug:17`; objects that are of no family make a kind of their own."""
    parts = name.split(":")
    return parts[1] if len(parts) == 3 else "others"
