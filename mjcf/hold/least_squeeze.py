"""The least squeeze that holds: how much of what a grasp presses with it needs.

Servos' targets are moved to a share of their way from the grasp to the squeeze, and contacts press with about
that share of their forces. A weaker squeeze that holds leaves room for a fragile object; one that needs
nearly all of its forces has none to lose.
"""

from collections.abc import Sequence

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
    grasp: Grasp, *, settings: HoldSettings | None = None, strains: Sequence[float] | None = None
) -> float | None:
    """The least share of the squeeze that was found to pass the test, at least 1/8.

    The whole squeeze, a half, a quarter and an eighth are tried until one fails, and what lies between that
    and the last that passed is halved down to an eighth of it. So every share that was tried from the answer
    upwards passed.

    Args:
        grasp: the grasp.
        settings: of the test; None takes what the squeeze was planned for.
        strains: of a lift that is known to be held with these settings, the `strain` of each direction; None
            where nothing is known.

    Returns:
        None where the whole squeeze fails, or the task is no lift.
    """
    settings = trial_settings(grasp, settings)
    if not isinstance(grasp.configuration.task.test, LiftTest):
        return None
    trial = _Shares(grasp, settings, strains)
    if strains is None and not trial.passes(1.0):
        return None
    high, low = 1.0, 0.5
    while trial.passes(low):
        high, low = low, 0.5 * low
        if low < _SMALLEST:
            return high
    while high - low > _RESOLUTION * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if trial.passes(middle) else (middle, high)
    return high


class _Shares:
    """Tests of a grasp with shares of its squeeze; the direction that failed last is tried first."""

    def __init__(self, grasp: Grasp, settings: HoldSettings, strains: Sequence[float] | None):
        self._lift = Lift(grasp, settings)
        self._order = most_strained_first(settings, strains or [0.0] * len(settings.directions))

    def passes(self, share: float) -> bool:
        """Whether the grasp is held with this share of its squeeze."""
        self._lift.squeeze(share=share)
        if not self._lift.result([]).held:
            return False
        for direction in self._order:
            if not self._lift.hold(direction).held:
                self._order.remove(direction)
                self._order.insert(0, direction)
                return False
        return True
