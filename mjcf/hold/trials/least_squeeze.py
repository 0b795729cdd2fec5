"""The least squeeze that holds: how much of what a grasp presses with it needs.

Servos' targets are moved to a share of their way from the grasp to the squeeze, and contacts press with about
that share of their forces. A weaker squeeze that holds leaves room for a fragile object; one that needs
nearly all of its forces has none to lose.
"""

from collections.abc import Callable, Sequence

from ....objects import LiftTest
from ...model import Grasp
from ...settings import Direction, HoldSettings
from ..checks import trial_settings
from ..lift import Lift
from ..result import Squeezed
from ..strain import most_strained_first

__all__ = ["least_squeeze"]

_SMALLEST = 0.125
_RESOLUTION = 0.125
# A share that is predicted is tried in so many directions, those in which the grasp gives way first.
_DECISIVE = 2


def least_squeeze(
    grasp: Grasp,
    *,
    settings: HoldSettings | None = None,
    strains: Sequence[float] | None = None,
    margin: float | None = None,
    weakest: Sequence[Direction] | None = None,
    lift: Lift | None = None,
) -> float | None:
    """The least share of the squeeze that was found to pass the test, at least 1/8.

    The whole squeeze, a half, a quarter and an eighth are tried until one fails, and what lies between that
    and the last that passed is halved down to an eighth of it. With a `margin` the share that it predicts is
    tried before, then its neighbours on the side where the answer lies, and the others only as far as these
    leave them open. What comes out passed in all directions; the next smaller share that was tried failed.

    Args:
        grasp: the grasp.
        settings: of the test; None takes what the squeeze was planned for.
        strains: of a lift that is known to be held with these settings, the `strain` of each direction; None
            where nothing is known.
        margin: of the whole squeeze, where it is known: a share carries about as much less as it is smaller.
            Of no use where the object rests in the hand.
        weakest: the directions of gravity, that first in which the grasp is likely to give way first; None
            goes by the strains.
        lift: of this grasp with these settings, to go on with; None begins one.

    Returns:
        None where the whole squeeze fails, or the task is no lift.
    """
    settings = trial_settings(grasp, settings)
    if not isinstance(grasp.configuration.task.test, LiftTest):
        return None
    order = weakest or most_strained_first(settings, strains or [0.0] * len(settings.directions))
    trial = _Shares(lift or Lift(grasp, settings), order, whole_passes=strains is not None)
    if strains is None and not trial.passes(1.0):
        return None
    if margin is not None and margin >= 1.0 and not any(settings.resting_direction):
        _try_about(trial, margin)
    # What the directions that are likely to decide leave is tried in all of them before it counts.
    least = _least(trial.seems_held)
    return least if trial.passes(least) else _least(trial.passes)


def _least(holds: Callable[[float], bool]) -> float:
    """The least share that holds, by halves until one fails and then between the two."""
    high, low = 1.0, 0.5
    while holds(low):
        high, low = low, 0.5 * low
        if low < _SMALLEST:
            return high
    while high - low > _RESOLUTION * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if holds(middle) else (middle, high)
    return high


def _try_about(trial: "_Shares", margin: float) -> None:
    """Tries the share that a margin predicts and some beside it, on the side where the answer lies."""
    shares = _all_shares()
    at = max(i for i, share in enumerate(shares) if share * margin >= 1.0 or share == 1.0)
    # Where the next smaller share passes, nothing more need be known of this one.
    seems_held = trial.seems_held(shares[at])
    # Predictions are seldom off by more than a few.
    for away in (1, 3):
        neighbour = shares[min(max(at + (away if seems_held else -away), 0), len(shares) - 1)]
        if trial.passes(neighbour) != seems_held:
            break
    if seems_held:
        trial.passes(shares[at])


def _all_shares() -> list[float]:
    """The shares that may be tried, the largest first."""

    def between(low: float, high: float) -> list[float]:
        middle = 0.5 * (low + high)
        if high - low <= _RESOLUTION * high:
            return []
        return [*between(middle, high), middle, *between(low, middle)]

    shares = [1.0]
    while shares[-1] > _SMALLEST:
        high = shares[-1]
        shares += [*between(0.5 * high, high), 0.5 * high]
    return shares


class _Shares:
    """Tests of a grasp with shares of its squeeze.

    More than a share that passed passes, and less than one that failed fails: that is not tried again.

    Args:
        lift: of the grasp.
        order: the directions of gravity, that first in which it is likely to give way.
        whole_passes: whether the whole squeeze is known to pass in all of them.
    """

    def __init__(self, lift: Lift, order: Sequence[Direction], *, whole_passes: bool):
        self._lift, self._order = lift, tuple(order)
        self._decisive = self._order[:_DECISIVE]
        self._failed = 0.0
        self._squeezed: dict[float, Squeezed] = {}
        # The directions in which a share is known to hold.
        self._held = {1.0: set(order)} if whole_passes else dict[float, set[Direction]]()

    def passes(self, share: float) -> bool:
        """Whether the grasp is held with this share of its squeeze."""
        return self._is_held(share, self._order)

    def seems_held(self, share: float) -> bool:
        """Whether it is in the directions that are likely to decide."""
        return self._is_held(share, self._decisive)

    def _is_held(self, share: float, directions: Sequence[Direction]) -> bool:
        if share <= self._failed:
            return False
        if any(other <= share and held.issuperset(directions) for other, held in self._held.items()):
            return True
        held = self._held.setdefault(share, set())
        if share in self._squeezed:
            self._lift.go_back(self._squeezed[share])
        else:
            self._lift.squeeze_partly(share)
            self._squeezed[share] = self._lift.squeezed
        if self._lift.keeps_place() and self._holds(directions, held):
            return True
        self._failed = share
        return False

    def _holds(self, directions: Sequence[Direction], held: set[Direction]) -> bool:
        """Whether the squeezed grasp holds in these directions; those in which it does are noted."""
        for direction in directions:
            if direction in held:
                continue
            if not self._lift.holds(direction):
                # The next share is tried in it first.
                self._order = (direction, *(other for other in self._order if other != direction))
                self._decisive = self._order[:_DECISIVE]
                return False
            held.add(direction)
        return True
