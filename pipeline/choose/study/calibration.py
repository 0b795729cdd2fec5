"""Whether what a policy calls likely comes true as often."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....base.numeric.arrays import Array

__all__ = ["Bin", "Calibration", "calibration"]


@dataclass(frozen=True)
class Bin:
    """Candidates to which a policy gives about the same chance.

    Attributes:
        predicted: their mean chance by the policy.
        observed: share of their tests that held.
        count: candidates.
    """

    predicted: float
    observed: float
    count: int


@dataclass(frozen=True)
class Calibration:
    """Whether what is called likely happens.

    Attributes:
        brier: mean squared difference between chance and outcome, over candidates and draws; 0 is perfect.
        error: mean distance between predicted and observed share over the bins, by their candidates.
        bins: ten of equal width, those that are empty left out.
    """

    brier: float
    error: float
    bins: tuple[Bin, ...]


def calibration(chances: Array, held: NDArray[np.bool_], bins: int = 10) -> Calibration:
    """Calibration of chances.

    Args:
        chances: (N,), in [0, 1].
        held: (N, D), what came true.
        bins: how many, of equal width.
    """
    observed = held.mean(axis=1)
    brier = float(((chances[:, None] - held) ** 2).mean())
    number = np.minimum((chances * bins).astype(np.int64), bins - 1)
    found = [
        Bin(float(chances[number == k].mean()), float(observed[number == k].mean()), int((number == k).sum()))
        for k in range(bins)
        if (number == k).any()
    ]
    error = sum(entry.count * abs(entry.predicted - entry.observed) for entry in found) / len(chances)
    return Calibration(brier, error, tuple(found))
