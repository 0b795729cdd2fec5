"""Logistic regression, with a penalty on large weights."""

import numpy as np
from scipy.optimize import minimize

from ...base.numeric.arrays import Array
from .heads import Linear, sigmoid
from .training_set import TrainingSet

__all__ = ["train_logistic"]

# Per candidate; found among decades on training objects.
_PENALTY = 0.01
_STEPS = 300


def train_logistic(data: TrainingSet) -> Linear:
    """The chance of each candidate to hold as a logistic function of its inputs; nothing in it is random."""
    x, chance = data.standardised, data.chance
    count = len(x)

    def loss(weights: Array) -> tuple[float, Array]:
        slopes, constant = weights[:-1], weights[-1]
        odds = x @ slopes + constant
        value = (np.logaddexp(0.0, odds) - chance * odds).mean() + 0.5 * _PENALTY * (slopes @ slopes)
        excess = (sigmoid(odds) - chance) / count
        return float(value), np.append(x.T @ excess + _PENALTY * slopes, excess.sum())

    found = minimize(
        loss, np.zeros(x.shape[1] + 1), jac=True, method="L-BFGS-B", options={"maxiter": _STEPS}
    ).x
    return Linear(
        mean=data.mean.tolist(),
        scale=data.scale.tolist(),
        weights=found[:-1].tolist(),
        constant=float(found[-1]),
        link="chance",
    )
