"""Pads of jaws that lean against the way they slide, as where a hull fills what is hooked."""

import warnings

import numpy as np

from ...base.numeric.arrays import Array
from ...errors import InputWarning
from ...geometry import Region
from ..hand import Hand
from .fingers import Finger

__all__ = ["warn_of_leaning_pad"]

# Jaws for round things may lean by less.
_MOST_RAD = np.radians(25.0)


def warn_of_leaning_pad(
    hand: Hand, finger: Finger, normal: Array, name: str, pad: Region, source: str
) -> None:
    """Warns of a pad that no object between two parallel jaws can lie on.

    Args:
        hand: the hand.
        finger: one of its fingers.
        normal: (3,) which way it closes, in the frame of its last link.
        name: of the pad.
        pad: its region there.
        source: the file, for the message.
    """
    axes = hand.links[finger.last].axes
    lean_rad = float(np.arccos(np.clip(pad.middle()[1] @ normal, -1.0, 1.0)))
    if axes and axes[-1].kind == "prismatic" and lean_rad > _MOST_RAD:
        said = (
            f"leans by {np.degrees(lean_rad):.0f} degrees against the way the jaw slides: where its mesh is "
            "hooked, the hull fills what grips; give it as several convex meshes"
        )
        warnings.warn(InputWarning(source, f"region {name}", said), stacklevel=3)
