"""Types of arrays, by what their elements are; shapes and units stand in docstrings."""

from __future__ import annotations

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
