"""Which features a policy goes by: what it loses where one of them is dealt out anew."""

from dataclasses import dataclass

import numpy as np

from ....base.numeric.arrays import Array
from ...choice import Feature
from ..inputs import compute_inputs
from ..policies import Prepared, Trained
from ..situations import Situations
from .measures import figures
from .splits import Split

__all__ = ["Importance", "importances"]

_REPEATS = 3


@dataclass(frozen=True)
class Importance:
    """What a policy loses without a feature.

    Attributes:
        feature: its name.
        auc: by how much AUC within situations falls, on situations that were not trained on.
        success: by how much the share of first choices that hold falls.
    """

    feature: str
    auc: float
    success: float


def importances(
    trained: Trained, prepared: Prepared, split: Split, load: int, *, seed: int = 0
) -> list[Importance]:
    """What dealing a feature out anew costs, the most first.

    Values are dealt out among the candidates of each situation, with every input that is computed of them;
    those of an object among the situations.

    Args:
        trained: by `train`, on the training part of the split.
        prepared: situations and inputs.
        split: whose test part is looked at.
        load: index of the load.
        seed: of the dealing.
    """
    situations = prepared.situations.take(split.test)
    rows = prepared.situations.rows(split.test)
    head = trained.heads[load]
    whole = prepared.values[rows]

    def achieved(values: Array) -> Array:
        found = figures(situations, head.scores(values, situations.place), load)
        known = found.auc[np.isfinite(found.auc)]
        return np.array([known.mean() if len(known) else 0.5, found.success.mean()])

    base = achieved(whole)
    rng = np.random.default_rng(seed)
    found = []
    for column in situations.columns:
        touched = [k for k, entry in enumerate(trained.inputs) if entry.feature == column.name]
        if not touched:
            continue
        lost = np.zeros(2)
        for _ in range(_REPEATS):
            values = whole.copy()
            dealt = _dealt(situations, column, rng)
            values[:, touched] = compute_inputs(
                [trained.inputs[k] for k in touched], situations.names, dealt, situations.first
            )
            lost += (base - achieved(values)) / _REPEATS
        found.append(Importance(column.name, float(lost[0]), float(lost[1])))
    return sorted(found, key=lambda entry: -entry.auc)


def _dealt(situations: Situations, column: Feature, rng: np.random.Generator) -> Array:
    """Features of which one is dealt out anew."""
    features = situations.features.copy()
    k = situations.names.index(column.name)
    if column.name in situations.of_object:
        of_situation = features[situations.first[:-1], k]
        features[:, k] = rng.permutation(of_situation)[situations.situation]
        return features
    # Sorted by situation first and by a random number second, each situation's rows come in random order.
    order = np.lexsort((rng.random(len(features)), situations.situation))
    features[:, k] = features[order, k]
    return features
