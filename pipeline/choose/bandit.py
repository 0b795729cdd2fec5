"""LinUCB (Li et al., 2010): learns while it chooses, and sees only what becomes of its own choices."""

import numpy as np

from .heads import Linear
from .training_set import TrainingSet

__all__ = ["train_bandit"]

_BOLDNESS = 0.5
_PRIOR = 10.0
_ROUNDS = 3


def train_bandit(data: TrainingSet) -> Linear:
    """Goes through the situations in random order and learns the expected outcome of each choice.

    In each situation it takes the candidate with the highest upper bound of its expected outcome, and is told
    whether that held in one draw of the hidden conditions. What remains is the expectation alone.
    """
    rng = np.random.default_rng(data.seed)
    x = np.column_stack([data.standardised, np.ones(len(data.inputs))])
    width = x.shape[1]
    inverse = np.eye(width) / _PRIOR
    sums = np.zeros(width)
    for _ in range(_ROUNDS):
        for situation in rng.permutation(len(data.first) - 1):
            rows = x[data.first[situation] : data.first[situation + 1]]
            spread = np.sqrt(np.maximum(0.0, ((rows @ inverse) * rows).sum(axis=1)))
            chosen = int((rows @ (inverse @ sums) + _BOLDNESS * spread).argmax())
            row = rows[chosen]
            draw = rng.integers(data.held.shape[1])
            sums += row * data.held[data.first[situation] + chosen, draw]
            along = inverse @ row
            inverse -= np.outer(along, along) / (1.0 + row @ along)
    weights = inverse @ sums
    return Linear(
        mean=data.mean.tolist(),
        scale=data.scale.tolist(),
        weights=weights[:-1].tolist(),
        constant=float(weights[-1]),
    )
