"""DexGraspNet .npy: a list of dictionaries with joints by name."""

import io
from collections.abc import Sequence
from typing import Any

import numpy as np

from .angles import roll_pitch_yaw
from .placed import PlacedGrasp, one_object

__all__ = ["dexgraspnet_bytes"]

_TURNS, _SHIFTS = ("WRJRx", "WRJRy", "WRJRz"), ("WRJTx", "WRJTy", "WRJTz")


def dexgraspnet_bytes(grasps: Sequence[PlacedGrasp]) -> bytes:
    """The bytes of a file: joints, and the hand's Euler angles about fixed axes and position, by name.

    The format names the object by the file alone; here `object_code` has its name too, and `success` says who
    holds where that is known.

    Raises:
        InputError: the grasps are of several objects or hands, or there are none.
    """
    one_object(grasps, "dexgraspnet")
    entries = np.empty(len(grasps), dtype=object)
    for i, grasp in enumerate(grasps):
        entries[i] = _entry(grasp)
    buffer = io.BytesIO()
    # The format is numpy's own way to save a list; what it holds is dictionaries of numbers.
    np.save(buffer, entries, allow_pickle=True)
    return buffer.getvalue()


def _entry(grasp: PlacedGrasp) -> dict[str, Any]:
    T = grasp.T_object_hand
    qpos = dict(grasp.joints)
    qpos |= dict(zip(_TURNS, roll_pitch_yaw(T[:3, :3]), strict=True))
    qpos |= dict(zip(_SHIFTS, T[:3, 3].tolist(), strict=True))
    entry = {"qpos": qpos, "scale": grasp.scale, "object_code": grasp.object}
    return entry if grasp.holds is None else {**entry, "success": grasp.holds}
