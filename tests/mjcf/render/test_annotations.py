"""What is drawn onto pictures."""

import numpy as np
from holdfast.mjcf.render.annotations import with_rings

from ..conftest import is_drawn


def test_dashed_rings_have_gaps() -> None:
    picture = np.full((160, 160, 3), 255, dtype=np.uint8)
    place = np.array([[80.0, 80.0]])
    whole, dashed = (is_drawn(with_rings(picture, place, [sight])).sum() for sight in (True, False))
    assert 0.3 * whole < dashed < 0.8 * whole
