"""Halton's sequence against another implementation of it."""

import numpy as np
import pytest
from holdfast.geometry import halton_points
from scipy.stats import qmc


@pytest.mark.parametrize(("count", "dimensions"), [(1, 1), (200, 23), (7, 40)])
def test_the_points_are_those_of_the_sequence_bit_for_bit(count: int, dimensions: int) -> None:
    expected = qmc.Halton(dimensions, scramble=False).random(count + 1)[1:]
    assert np.array_equal(halton_points(count, dimensions), expected)
