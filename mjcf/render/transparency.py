"""Pictures without a background, for pages that are light or dark."""

import numpy as np

from ...arrays import Array, Picture

__all__ = ["straight_alpha", "without_sky"]


def straight_alpha(shown: Array, opacity: Array) -> Picture:
    """A picture (height, width, 4) of colours that were mixed with nothing.

    Args:
        shown: (height, width, 3) in [0, 1], colours times opacity.
        opacity: (height, width) in [0, 1].
    """
    colours = shown / np.maximum(opacity, 1e-6)[..., None]
    layers = np.concatenate([colours, opacity[..., None]], axis=-1)
    return (np.clip(layers, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)


def without_sky(with_sky: Picture, on_black: Picture, sky: Picture) -> Picture:
    """What stands before a sky, cut out, with soft edges.

    Args:
        with_sky: picture (height, width, 3) before the sky.
        on_black: the same before nothing.
        sky: the sky alone, nowhere black.
    """
    before, black, behind = (picture.astype(float) for picture in (with_sky, on_black, sky))
    through = ((before - black) / np.maximum(behind, 1.0)).mean(axis=-1)
    opacity = np.clip(1.0 - through, 0.0, 1.0)
    # Rounding leaves a trace of what is not there, and a hole in what is whole.
    opacity[opacity < 0.02] = 0.0
    opacity[opacity > 0.98] = 1.0
    return straight_alpha(black / 255.0, opacity)
