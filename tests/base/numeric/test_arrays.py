"""Where lists lie that are packed into one array."""

import numpy as np
import pytest
from holdfast.base.numeric.arrays import offsets


@pytest.mark.parametrize("lengths", [[], [3], [2, 0, 5], np.array([1, 4])])
def test_offsets_find_each_piece_again(lengths):
    pieces = [np.full(n, k) for k, n in enumerate(lengths)]
    packed = np.concatenate([np.zeros(0), *pieces])
    start = offsets(lengths)
    assert start.dtype == np.int64 and len(start) == len(lengths) + 1
    for piece, a, b in zip(pieces, start[:-1], start[1:], strict=True):
        assert np.array_equal(packed[a:b], piece)
    assert start[-1] == len(packed)
