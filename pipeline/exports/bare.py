"""Matrices alone, as .npy."""

import io
from collections.abc import Sequence

import numpy as np

from .placed import PlacedGrasp, one_object

__all__ = ["bare_bytes"]


def bare_bytes(grasps: Sequence[PlacedGrasp]) -> bytes:
    """The bytes of a file: poses (N, 4, 4) of the hand's root link in the object's frame, in m.

    Raises:
        InputError: the grasps are of several objects or hands, or there are none.
    """
    one_object(grasps, "bare")
    buffer = io.BytesIO()
    np.save(buffer, np.array([grasp.T_object_hand for grasp in grasps]), allow_pickle=False)
    return buffer.getvalue()
