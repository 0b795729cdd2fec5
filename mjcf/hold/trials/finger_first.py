"""Whether a grasp stands it when one finger arrives first.

A hand does not close as a plan has it: one finger is early, its pad softer, its drive freer. While it presses
alone, only friction and the fingers' places keep the object; a grasp that balances by leaning on every
contact lets the object go. So each finger in turn makes its squeeze first and the others follow, on the
hand's own pads, without a load: the object must stay within the limits that the squeeze itself has to keep.

A grasp that passes its test but not this is held narrowly. Simulators with other contacts refute most of what
they refute of held grasps in the squeeze, and of these this trial finds nearly all. It says nothing of other
errors, such as an object that is elsewhere or slippery (see `robustness`), and it is stricter than need be:
in some grasps that it calls narrow, all fingers would come in time.

Only lifts have it. In a turn or a press a stand holds the object, so that no finger can push it away.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import degrees

import numpy as np
from numpy.typing import NDArray

from ....hands import finger_joints
from ....objects import LiftTest
from ...model import Grasp
from ...settings import HoldSettings
from ..checks import trial_settings
from ..lift import Lift

__all__ = ["FingerFirst", "fingers_first"]

# A finger whose targets move by less does nothing in the squeeze, in rad or m.
_MOVES = 1e-6


@dataclass(frozen=True)
class FingerFirst:
    """What becomes of the object where one finger arrives first.

    Attributes:
        finger: name of the finger.
        slip_m: how far the whole squeeze then moves what is watched on the object; where that is so far that
            the object is lost, how far it had moved by then.
        rotation_rad: how far it turns the object, likewise.
        kept: whether both are within the limits of the squeeze.
    """

    finger: str
    slip_m: float
    rotation_rad: float
    kept: bool

    def __str__(self) -> str:
        words = f"{self.finger} first: the object moves by {1e3 * self.slip_m:.2f} mm"
        return f"{words} and turns by {degrees(self.rotation_rad):.1f} deg" + (
            "" if self.kept else ": too far"
        )


def fingers_first(
    grasp: Grasp,
    *,
    settings: HoldSettings | None = None,
    until_lost: bool = False,
    suspects: Sequence[str] = (),
    lift: Lift | None = None,
) -> tuple[FingerFirst, ...]:
    """Lets each finger that moves in the squeeze make it first, once.

    Args:
        grasp: the grasp.
        settings: of the test; None takes what the squeeze was planned for.
        until_lost: whether to stop at the first finger that the grasp does not stand.
        suspects: names of fingers to begin with, in this order, such as those that another squeeze did not
            stand; with `until_lost`, most that it does not stand is found sooner.
        lift: of this grasp with these settings, to go on with; None begins one.

    Returns:
        One entry a finger that was tried, in the order of the joints; none where the task is no lift, or one
        finger makes the squeeze alone.
    """
    settings = trial_settings(grasp, settings)
    configuration = grasp.configuration
    if not isinstance(configuration.task.test, LiftTest):
        return ()
    moves = np.abs(grasp.squeeze.targets - configuration.state.q) > _MOVES
    fingers = {
        name: joints for name, joints in finger_joints(configuration.task.hand).items() if moves[joints].any()
    }
    if len(fingers) < 2:
        return ()
    lift = lift or Lift(grasp, settings)
    found: dict[str, FingerFirst] = {}
    known = [name for name in suspects if name in fingers]
    for name in (*known, *(name for name in fingers if name not in known)):
        leads = np.zeros(len(moves), dtype=bool)
        leads[fingers[name]] = True
        found[name] = _with_first(lift, name, leads, settings)
        if until_lost and not found[name].kept:
            break
    return tuple(found[name] for name in fingers if name in found)


def _with_first(lift: Lift, name: str, leads: NDArray[np.bool_], settings: HoldSettings) -> FingerFirst:
    """The squeeze with some joints (n_independent,) first; of two ways, the one that moves the object less.

    Where gravity acts in the squeeze, the object either rests in the hand anyway, as a pot on the palm, or
    something carries it until all fingers press, as a stand does a guitar.
    """
    ways = (False, True) if any(settings.resting_direction) else (False,)
    entries = []
    for supported in ways:
        lift.squeeze(first=leads, supported=supported)
        result = lift.result([])
        kept = result.is_finite and result.kept_place
        entries.append(FingerFirst(name, result.squeeze_slip_m, result.squeeze_rotation_rad, kept))
        if kept:
            break
    return min(entries, key=lambda entry: (not entry.kept, entry.slip_m))
