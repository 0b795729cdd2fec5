"""Short names for directions of gravity, no two alike in one test."""

from collections import Counter
from collections.abc import Sequence

import numpy as np

from ..base.numeric.arrays import Array

__all__ = ["gravity_names", "main_axis"]

_AXES = "xyz"
# Beside the nearest axis a direction leans towards others by so much of its length at least, and of the most.
_LEANING, _OF_THE_MOST = 0.02, 0.3


def gravity_names(directions: Sequence[tuple[float, float, float]]) -> list[str]:
    """Names of directions in the palm frame, such as `−y` or, for a tilted one, `−y +x 30°`.

    The axis that is nearest comes first; the angle is that between the two. Directions that would still have
    the same name are numbered.

    Args:
        directions: of any length; where one is zero, as in tests without gravity, its name is empty.
    """
    names = [_name(np.array(direction)) for direction in directions]
    counts = Counter(names)
    seen = Counter[str]()
    out = []
    for name in names:
        seen[name] += 1
        out.append(f"{name} ({seen[name]})" if name and counts[name] > 1 else name)
    return out


def main_axis(direction: tuple[float, float, float]) -> tuple[str, bool]:
    """The axis nearest to a direction, empty for none, and whether the direction points against it."""
    size = max(abs(part) for part in direction)
    if size == 0.0:
        return "", False
    i = max(range(3), key=lambda k: abs(direction[k]))
    return _AXES[i], direction[i] < 0.0


def _name(direction: Array) -> str:
    size = float(np.linalg.norm(direction))
    if size == 0.0:
        return ""
    unit = direction / size
    order = np.argsort(-np.abs(unit), kind="stable")
    leaning = max(_LEANING, _OF_THE_MOST * float(abs(unit[order[1]])))
    named = [order[0], *(i for i in order[1:] if abs(unit[i]) >= leaning)]
    parts = [f"{'−' if unit[i] < 0.0 else '+'}{_AXES[i]}" for i in named]
    if len(parts) == 1:
        return parts[0]
    angle = round(float(np.degrees(np.arccos(min(1.0, abs(unit[order[0]]))))))
    return f"{' '.join(parts)} {angle}°"
