"""What a policy computes with: features as they are, and how each candidate stands among its rivals.

Which of a few grasps is the best is a question of comparison: that one squeezes at 9 N says little, that it
squeezes the hardest of all says much, whatever the object and the hand. So each feature that differs between
candidates is also given as its rank among them and as its distance from their mean.
"""

from collections.abc import Collection, Sequence
from itertools import pairwise
from typing import Literal

import numpy as np
from scipy.stats import rankdata

from ...base.files.file_model import FileModel
from ...base.numeric.arrays import Array, Indices
from ..choice import Feature

__all__ = ["Input", "compute_inputs", "default_inputs"]

# A spread below this, relative to the values, is rounding.
_NO_SPREAD = 1e-6


class Input(FileModel):
    """A number that a policy computes with.

    Attributes:
        feature: name of the feature that it comes from.
        form: `value` as it is; `rank` among the candidates of the situation, from 0 (the smallest) to 1,
            equal ones sharing the mean of theirs; `distance` from their mean, in standard deviations.
    """

    feature: str
    form: Literal["value", "rank", "distance"]


def default_inputs(
    columns: Sequence[Feature], of_object: Collection[str], *, free: bool = False
) -> tuple[Input, ...]:
    """The inputs of a policy that learns.

    Args:
        columns: the features that there are.
        of_object: names of those that are the same for all candidates of a situation.
        free: whether to leave out those that speak of one hand alone.
    """
    kept = [column for column in columns if not (free and column.kind == "hand")]
    compared = [column.name for column in kept if column.name not in of_object]
    return (
        *(Input(feature=column.name, form="value") for column in kept),
        *(Input(feature=name, form="rank") for name in compared),
        *(Input(feature=name, form="distance") for name in compared),
    )


def compute_inputs(inputs: Sequence[Input], names: Sequence[str], features: Array, first: Indices) -> Array:
    """The inputs (N, I) of candidates.

    The order of the candidates in a situation has no say, down to the last bit.

    Args:
        inputs: which.
        names: of the features.
        features: (N, F).
        first: (G + 1,), where the candidates of each situation begin.
    """
    if not inputs:
        return np.zeros((len(features), 0))
    place = {name: k for k, name in enumerate(names)}
    columns = np.array([place[entry.feature] for entry in inputs], dtype=np.int64)
    forms = np.array([entry.form for entry in inputs])
    taken = np.asarray(features, dtype=np.float64)[:, columns]
    result = taken.copy()
    ranked, compared = forms == "rank", forms == "distance"
    for start, end in pairwise(first):
        block = taken[start:end]
        result[start:end, ranked] = _ranks(block[:, ranked])
        result[start:end, compared] = _distances(block[:, compared])
    return result


def _ranks(block: Array) -> Array:
    if len(block) < 2 or not block.shape[1]:
        return np.full(block.shape, 0.5)
    return (rankdata(block, axis=0) - 1.0) / (len(block) - 1.0)


def _distances(block: Array) -> Array:
    # Sums of rounded numbers depend on their order, so they are put into one.
    ordered = np.sort(block, axis=0)
    mean = ordered.mean(axis=0)
    spread = np.sqrt(((ordered - mean) ** 2).mean(axis=0))
    differs = spread > _NO_SPREAD * np.maximum(1e-12, np.abs(ordered).max(axis=0, initial=0.0))
    return np.where(differs, (block - mean) / np.where(differs, spread, 1.0), 0.0)
