"""The least squeeze that holds: how much of what a grasp presses with it needs.

Servos' targets are moved to a share of their way from the grasp to the squeeze, and contacts press with about
that share of their forces. A weaker squeeze that holds leaves room for a fragile object; one that needs
nearly all of its forces has none to lose.
"""

from collections.abc import Callable, Sequence

import numpy as np

from ...objects import LiftTest
from ..model import Grasp
from ..settings import HoldSettings
from .checks import trial_settings
from .lift import Lift
from .strain import most_strained_first

__all__ = ["least_squeeze"]

_SMALLEST = 0.125
_RESOLUTION = 0.125


def least_squeeze(
    grasp: Grasp,
    *,
    settings: HoldSettings | None = None,
    strains: Sequence[float] | None = None,
    margin: float | None = None,
) -> float | None:
    """The least share of the squeeze that was found to pass the test, at least 1/8.

    The whole squeeze, a half, a quarter and an eighth are tried until one fails, and what lies between that
    and the last that passed is halved down to an eighth of it. So every share that was tried from the answer
    upwards passed. With a `margin` the two shares between which it then ought to lie are tried before, and
    the others only as far as these leave them open.

    Args:
        grasp: the grasp.
        settings: of the test; None takes what the squeeze was planned for.
        strains: of a lift that is known to be held with these settings, the `strain` of each direction; None
            where nothing is known.
        margin: of the whole squeeze, where it is known: a share carries about as much less as it is smaller.
            Of no use where the object rests in the hand.

    Returns:
        None where the whole squeeze fails, or the task is no lift.
    """
    settings = trial_settings(grasp, settings)
    if not isinstance(grasp.configuration.task.test, LiftTest):
        return None
    trial = _Shares(grasp, settings, strains)
    if strains is None and not trial.passes(1.0):
        return None
    if margin is not None and margin >= 1.0 and not any(settings.resting_direction):
        low, high = _between(lambda share: share * margin >= 1.0)
        if high < 1.0 and trial.passes(high) and low >= _SMALLEST:
            trial.passes(low)
    return _between(trial.passes)[1]


def _between(passes: Callable[[float], bool]) -> tuple[float, float]:
    """The largest share that fails and the least that passes, as far as they are told apart."""
    high, low = 1.0, 0.5
    while passes(low):
        high, low = low, 0.5 * low
        if low < _SMALLEST:
            return low, high
    while high - low > _RESOLUTION * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if passes(middle) else (middle, high)
    return low, high


class _Shares:
    """Tests of a grasp with shares of its squeeze; the direction that failed last is tried first.

    More than a share that passed passes, and less than one that failed fails: that is not tried again.
    """

    def __init__(self, grasp: Grasp, settings: HoldSettings, strains: Sequence[float] | None):
        self._lift = Lift(grasp, settings)
        self._order = most_strained_first(settings, strains or [0.0] * len(settings.directions))
        self._failed, self._passed = 0.0, np.inf

    def passes(self, share: float) -> bool:
        """Whether the grasp is held with this share of its squeeze."""
        if self._failed < share < self._passed:
            if self._is_held(share):
                self._passed = share
            else:
                self._failed = share
        return share >= self._passed

    def _is_held(self, share: float) -> bool:
        self._lift.squeeze(share=share)
        if not self._lift.keeps_place():
            return False
        for direction in self._order:
            if not self._lift.holds(direction):
                self._order.remove(direction)
                self._order.insert(0, direction)
                return False
        return True
