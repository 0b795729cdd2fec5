"""Types of arrays, by what their elements are, and where lists lie that are packed into one array.

Shapes and units stand in docstrings.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
"""Real numbers."""

Indices = NDArray[np.int64]
"""Whole numbers: indices, offsets, counts."""

Mask = NDArray[np.bool_]
"""What holds of each element."""

Picture = NDArray[np.uint8]
"""Red, green and blue of every pixel, `(height, width, 3)`."""


def offsets(lengths: Sequence[int] | Indices) -> Indices:
    """Where each of the pieces of these lengths begins in their row (k,), and where the last one ends."""
    return np.concatenate([[0], np.cumsum(lengths, dtype=np.int64)]).astype(np.int64)
