"""Spaces of the environments."""

import numpy as np
from gymnasium import spaces

from ...arguments import check_whole_number
from ...errors import InputError
from ..choice import Feature, bounds

__all__ = ["action_space", "check_candidates", "observation_space"]

_MOST_CANDIDATES = 10_000


def check_candidates(count: object) -> int:
    """K, the number of candidates on offer.

    Raises:
        InputError: no whole number, or one for which there is no room.
    """
    checked = check_whole_number("candidates", count, least=1)
    if checked > _MOST_CANDIDATES:
        raise InputError("candidates", "", f"must be at most {_MOST_CANDIDATES}, not {checked}")
    return checked


def observation_space(
    features: tuple[Feature, ...], of_objects: tuple[Feature, ...], count: int, *, shows_tries: bool
) -> spaces.Dict:
    """Of K candidates: their features, those of the object, the mask, and what was tried before.

    Bounds are those of the features; rows without a candidate are zeros.

    Args:
        features: of candidates.
        of_objects: of objects.
        count: K.
        shows_tries: whether tries and their margins are shown.
    """
    # Zero stands for nothing, so it has to be allowed.
    low, high = (
        limit(array, 0.0) for limit, array in zip((np.minimum, np.maximum), bounds(features), strict=True)
    )
    object_low, object_high = bounds(of_objects)
    parts: dict[str, spaces.Space[object]] = {
        "candidates": spaces.Box(np.tile(low, (count, 1)), np.tile(high, (count, 1)), dtype=np.float32),
        "object": spaces.Box(object_low, object_high, dtype=np.float32),
        "mask": spaces.Box(0, 1, (count,), np.int8),
    }
    if shows_tries:
        parts["tried"] = spaces.Box(0, 1, (count,), np.int8)
        parts["margin"] = spaces.Box(-1.0, 1.0, (count,), np.float32)
    return spaces.Dict(parts)


def action_space(count: int) -> spaces.Discrete:
    """Which of K candidates."""
    return spaces.Discrete(count)
