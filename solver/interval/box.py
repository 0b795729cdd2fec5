"""Boxes as pairs of their lower and upper ends."""

from typing import TypeAlias

import numpy as np

from ...base.numeric.arrays import Array

__all__ = ["Interval", "hull", "is_within"]

Interval: TypeAlias = tuple[Array, Array]


def is_within(inner: Interval, outer: Interval) -> bool:
    """Whether a box lies in another."""
    return bool(np.all(inner[0] >= outer[0]) and np.all(inner[1] <= outer[1]))


def hull(a: Interval, b: Interval) -> Interval:
    """The smallest box that holds both."""
    return np.minimum(a[0], b[0]), np.maximum(a[1], b[1])
