"""Intervals for what was measured on a sample, by resampling it.

Two questions have two bootstraps. How far would a figure move with other *objects* of the same kind? Objects
are resampled, with all their situations. How far with other *seeds*? Runs are resampled within each stratum,
and the middle half of all scores is averaged, as Agarwal et al. (Deep Reinforcement Learning at the Edge of
the Statistical Precipice, 2021) define it.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import trim_mean

from ....base.numeric.arrays import Array
from ..situations import Names

__all__ = ["Estimate", "interquartile_mean", "iqm_over_seeds", "mean_over_objects", "ratio_over_objects"]

_SAMPLES = 2000
_LEVEL = 0.95


@dataclass(frozen=True)
class Estimate:
    """A figure with its interval.

    Attributes:
        value: the figure.
        low: lower end of the 95 % interval.
        high: upper end.
    """

    value: float
    low: float
    high: float

    def text(self, factor: float = 1.0, digits: int = 2) -> str:
        """Value and interval, times a factor, with so many decimals; a dash for what is not a number."""
        if not np.isfinite(self.value):
            return "-"
        # Adding zero turns the -0 that rounding may leave into 0.
        parts = (round(factor * x, digits) + 0.0 for x in (self.value, self.low, self.high))
        value, low, high = (f"{part:.{digits}f}" for part in parts)
        return f"{value} [{low}, {high}]"

    @property
    def as_list(self) -> list[float | None]:
        """Value, lower and upper end; None for what is not a number."""
        return [float(x) if np.isfinite(x) else None for x in (self.value, self.low, self.high)]


def interquartile_mean(scores: Array) -> float:
    """The mean of the middle half of all scores, whatever the shape."""
    return float(trim_mean(scores, 0.25, axis=None))


def iqm_over_seeds(scores: Array, *, seed: int = 0, samples: int = _SAMPLES) -> Estimate:
    """Interquartile mean of scores (runs, strata); runs are resampled within each stratum by itself."""
    rng = np.random.default_rng(seed)
    runs, strata = scores.shape
    drawn = rng.integers(runs, size=(samples, runs, strata))
    resampled = scores[drawn, np.arange(strata)].reshape(samples, -1)
    return _estimate(interquartile_mean(scores), trim_mean(resampled, 0.25, axis=1))


def mean_over_objects(values: Array, objects: Names, *, seed: int = 0, samples: int = _SAMPLES) -> Estimate:
    """Mean of values (G,) of situations, but those that are NaN; objects are resampled, with all theirs."""
    ones = np.ones_like(values)
    return ratio_over_objects(values, ones, objects, seed=seed, samples=samples)


def ratio_over_objects(
    above: Array, below: Array, objects: Names, *, seed: int = 0, samples: int = _SAMPLES
) -> Estimate:
    """Sum of `above` (G,) over that of `below` (G,), where both are numbers; objects are resampled.

    The same seed draws the same objects, so that intervals of several figures go together.
    """
    known = np.isfinite(above) & np.isfinite(below)
    names, which = np.unique(objects, return_inverse=True)
    tops = np.bincount(which[known], weights=above[known], minlength=len(names))
    bottoms = np.bincount(which[known], weights=below[known], minlength=len(names))
    if not known.any() or bottoms.sum() == 0.0:
        return Estimate(np.nan, np.nan, np.nan)
    rng = np.random.default_rng(seed)
    weights = rng.multinomial(len(names), np.full(len(names), 1.0 / len(names)), size=samples)
    with np.errstate(divide="ignore", invalid="ignore"):
        ratios = (weights @ tops) / (weights @ bottoms)
    return _estimate(float(tops.sum() / bottoms.sum()), ratios[np.isfinite(ratios)])


def _estimate(value: float, resampled: NDArray[np.float64]) -> Estimate:
    tail = 50.0 * (1.0 - _LEVEL)
    low, high = np.percentile(resampled, [tail, 100.0 - tail])
    return Estimate(value, float(low), float(high))
