"""A blend of the measures by which a person would choose: each counts for what it has told, none backwards.

That larger is better (or smaller) is known of a formula beforehand, and how near to its limits a grasp came
says more than whether it held. So little data is enough.
"""

import numpy as np
from scipy.optimize import nnls

from ...errors import InputError
from .heads import Linear
from .training_set import TrainingSet

__all__ = ["train_blend"]

# Of squared weights, per candidate.
_PENALTY = 0.05


def train_blend(data: TrainingSet) -> Linear:
    """Weights of at least 0 of the formulas' distances from the mean of their situation; nothing is random.

    They have the least squared error of the margin, which is taken from the mean of its situation too, so
    that how hard a situation is has no say.

    Raises:
        InputError: the data has no formula.
    """
    used = np.flatnonzero(data.signs)
    if not len(used):
        raise InputError("data set", "", "names no formula among its features that could be blended")
    x = data.inputs[:, used] * data.signs[used]
    target = data.above_rivals(data.margin.mean(axis=1))
    size = np.sqrt(_PENALTY * len(x))
    found, _ = nnls(np.vstack([x, size * np.eye(len(used))]), np.concatenate([target, np.zeros(len(used))]))
    weights = np.zeros(data.inputs.shape[1])
    weights[used] = found * data.signs[used]
    width = len(weights)
    return Linear(mean=[0.0] * width, scale=[1.0] * width, weights=weights.tolist())
