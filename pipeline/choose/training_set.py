"""What a policy is trained on: inputs and outcomes of candidates, under one load."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...base.numeric.arrays import Array, Indices

__all__ = ["TrainingSet"]

# Of an input that hardly varies: rounding is not to be blown up.
_LEAST_SCALE = 1e-6


@dataclass(frozen=True, eq=False)
class TrainingSet:
    """N candidates in G situations.

    Attributes:
        inputs: (N, I).
        first: (G + 1,), where the candidates of each situation begin, and N.
        held: (N, D), outcomes under the load, in D draws.
        margin: (N, D), share of the limits that was left, at most 0 where it was not held.
        signs: (I,), 1 or -1 of an input by which a person would choose, the larger or the smaller; else 0.
        seed: of whatever is random in training.
    """

    inputs: Array
    first: Indices
    held: NDArray[np.bool_]
    margin: Array
    signs: Array
    seed: int

    @cached_property
    def chance(self) -> Array:
        """Share of the draws in which each candidate held (N,)."""
        return self.held.mean(axis=1)

    def above_rivals(self, values: Array) -> Array:
        """Values (N,) less the mean of their situation."""
        sizes = np.diff(self.first)
        return values - np.repeat(np.add.reduceat(values, self.first[:-1]) / sizes, sizes)

    @cached_property
    def mean(self) -> Array:
        """Of each input (I,)."""
        return self.inputs.mean(axis=0)

    @cached_property
    def scale(self) -> Array:
        """Standard deviation of each input (I,); 1 where it does not vary."""
        spread = self.inputs.std(axis=0)
        return np.where(spread > _LEAST_SCALE * np.maximum(1.0, np.abs(self.mean)), spread, 1.0)

    @cached_property
    def standardised(self) -> Array:
        """Inputs with mean 0 and standard deviation 1."""
        return (self.inputs - self.mean) / self.scale
