"""A motion as few rows as straight lines between them need to give it back."""

import numpy as np

from ...base.numeric.arrays import Array

__all__ = ["thinned"]

# In rad, m and parts of a unit quaternion: far less than can be seen.
_TOLERANCE = 3e-4
_MOST_ROWS = 24
_DIGITS = 5


def thinned(times_s: Array, qpos: Array) -> list[list[float]]:
    """Rows (time, positions) from which the samples follow by straight lines, to within what can be seen.

    Args:
        times_s: (k,) times, increasing.
        qpos: (k, n) positions at those times; what follows the first row that is not finite is left out.

    Returns:
        The first and the last sample and, of those between, one after the other the one that is farthest off,
        until none is off or there are 24 of them.
    """
    rows = np.column_stack([times_s, qpos])
    whole = np.isfinite(rows).all(axis=1)
    rows = rows[: len(rows) if whole.all() else int(np.argmin(whole))]
    kept = sorted({0, len(rows) - 1}) if len(rows) else []
    while 1 < len(kept) < min(_MOST_ROWS, len(rows)):
        off = np.abs(_between(rows, np.array(kept)) - rows[:, 1:]).max(axis=1)
        worst = int(np.argmax(off))
        if off[worst] <= _TOLERANCE:
            break
        kept = sorted([*kept, worst])
    # Adding zero turns -0 into 0.
    return (np.round(rows[kept], _DIGITS) + 0.0).tolist()


def _between(rows: Array, kept: Array) -> Array:
    """What straight lines between the kept rows make of all of them, without the time."""
    before = np.clip(np.searchsorted(kept, np.arange(len(rows)), side="right") - 1, 0, len(kept) - 2)
    a, b = rows[kept[before]], rows[kept[before + 1]]
    share = (rows[:, :1] - a[:, :1]) / (b[:, :1] - a[:, :1])
    return a[:, 1:] + share * (b[:, 1:] - a[:, 1:])
