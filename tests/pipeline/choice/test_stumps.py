"""No feature gives the outcome away: a stump on each of them is far from knowing it."""

import numpy as np
import pytest
from holdfast.pipeline.choice import ChoiceData, load_dataset


def stump_accuracy(values: np.ndarray, held: np.ndarray) -> float:
    """Share of outcomes that the best threshold on a feature gets right, in either direction."""
    order = np.argsort(values, kind="stable")
    values, held = values[order], held[order]
    below = np.concatenate([[0], np.cumsum(held)])  # held among the first k
    count, total = len(held), held.sum()
    k = np.concatenate([[0], 1 + np.flatnonzero(np.diff(values)), [count]])
    right = below[k] + (count - k) - (total - below[k])  # held below, not held above
    return float(max(right.max(), (count - right).max()) / count)


@pytest.fixture(scope="module")
def data() -> ChoiceData:
    return load_dataset()


def test_a_stump_finds_what_is_given_away() -> None:
    held = np.array([False, True, True, False, True])
    assert stump_accuracy(held.astype(float), held) == 1.0
    assert stump_accuracy(-held.astype(float), held) == 1.0
    assert stump_accuracy(np.zeros(5), held) == 0.6


@pytest.mark.parametrize("load", [0, 1])
def test_no_feature_gives_the_outcome_away(load: int, data: ChoiceData) -> None:
    held = data.held[:, :, load].ravel()
    usual = max(held.mean(), 1.0 - held.mean())
    for k, feature in enumerate(data.feature_specs):
        values = np.repeat(data.features[:, k], data.held.shape[1])
        assert stump_accuracy(values, held) < usual + 0.25, feature.name
    for k, feature in enumerate(data.object_specs):
        values = np.repeat(data.object_features[data.object_index, k], data.held.shape[1])
        assert stump_accuracy(values, held) < usual + 0.25, feature.name
