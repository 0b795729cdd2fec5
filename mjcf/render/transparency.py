"""Pictures without a background, for pages that are light or dark."""

import numpy as np
from numpy.typing import NDArray

from ...base.numeric.arrays import Array, Picture

__all__ = ["cut_out", "straight_alpha"]


def straight_alpha(shown: Array, opacity: Array) -> Picture:
    """A picture (..., 4) of colours that were mixed with nothing.

    Args:
        shown: (..., 3) in [0, 1], colours times opacity.
        opacity: (...) in [0, 1].
    """
    colours = shown / np.maximum(opacity, 1e-6)[..., None]
    layers = np.concatenate([colours, opacity[..., None]], axis=-1)
    return (np.clip(layers, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)


def cut_out(on_black: Picture, opacity: NDArray[np.uint8]) -> Picture:
    """What stands before nothing, cut out, with soft edges.

    Args:
        on_black: picture (height, width, 3) before nothing.
        opacity: how much there is of each pixel (height, width), 255 where it is whole.
    """
    share = opacity / 255.0
    # Rounding leaves a hole in what is whole.
    whole = share > 0.98
    cut = np.zeros((*opacity.shape, 4), dtype=np.uint8)
    cut[whole, :3], cut[whole, 3] = on_black[whole], 255
    edge = (opacity > 0) & ~whole  # the few pixels that have to be mixed
    cut[edge] = straight_alpha(on_black[edge] / 255.0, share[edge])
    return cut
