"""Pictures without a background, for pages that are light or dark."""

import numpy as np

from ...arrays import Array, Picture

__all__ = ["cut_out", "straight_alpha"]


def straight_alpha(shown: Array, opacity: Array) -> Picture:
    """A picture (height, width, 4) of colours that were mixed with nothing.

    Args:
        shown: (height, width, 3) in [0, 1], colours times opacity.
        opacity: (height, width) in [0, 1].
    """
    colours = shown / np.maximum(opacity, 1e-6)[..., None]
    layers = np.concatenate([colours, opacity[..., None]], axis=-1)
    return (np.clip(layers, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)


def cut_out(on_black: Picture, silhouette: Picture) -> Picture:
    """What stands before nothing, cut out, with soft edges.

    Args:
        on_black: picture (height, width, 3) before nothing.
        silhouette: the same with everything in white.
    """
    opacity = silhouette.mean(axis=-1) / 255.0
    # Rounding leaves a hole in what is whole.
    opacity[opacity > 0.98] = 1.0
    return straight_alpha(on_black / 255.0, opacity)
