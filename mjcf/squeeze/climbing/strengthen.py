"""Sliding a grasp to where the hand can hold it.

The solver's configurations make the contacts, no more: the line between two fingertips may lie far outside
their friction cones, or the object's weight may turn it about that line. The contact manifold has more
dimensions than such a grasp needs, so this stage climbs on it, from where the solver stands, until a squeeze
carries the planned load with the friction that squeezes are best planned with.

Away from there bodies may be in each other's way, and what is measured is how far that friction is from
carrying the load (`grasp_strength`). Where a lift is clear of penetration and is to stay so, the last part of
the way may be out of reach. There the climb goes by what contacts have to spare with all of the friction
(`grasp_slack`), which is what tells grasps that hold from those that don't.
"""

from dataclasses import replace

from ....objects import LiftTest
from ....retraction import ClearRoom, RetractionSettings
from ....solver import Configuration, ContactManifold, State, certify_state
from ...model import check_configuration, checked_settings
from ...settings import HoldSettings
from .climb import climb
from .grasp_measure import GraspMeasure, Strength
from .grasp_slack import SlackMeasure
from .grasp_strength import StrengthMeasure

__all__ = ["strengthen"]


def strengthen(
    configuration: Configuration,
    *,
    settings: HoldSettings | None = None,
    keep_clear: RetractionSettings | None = None,
) -> Configuration:
    """The configuration, or one on the same contact manifold whose squeeze carries more.

    It stops at `settings.planned_load` times the weight with the friction that squeezes are best planned
    with, or where steps hardly help. The result is certified anew: where that fails, the last place on the
    way that can be certified is taken.

    Args:
        configuration: where to begin.
        settings: of the hold test to come.
        keep_clear: thresholds of clearance that are kept on the way, where the configuration is clear by
            them; None heeds contacts alone.
    """
    check_configuration(configuration)
    settings = checked_settings(settings)
    manifold = ContactManifold(configuration.task)
    for state in reversed(_way(manifold, configuration.state, settings, keep_clear)):
        reached = certify_state(manifold, state)
        if reached.certified or not configuration.certified:
            return reached
    return configuration


def _way(
    manifold: ContactManifold, state: State, settings: HoldSettings, keep_clear: RetractionSettings | None
) -> list[State]:
    """The states on the way up, without the first one."""
    frictions = settings.planned_frictions(manifold.task.object)
    strength = StrengthMeasure(manifold, replace(settings, friction=frictions[0]), state)

    def is_enough(here: Strength) -> bool:
        if measure is strength:
            return here.value >= settings.planned_load
        # What all of the friction can't carry, a part of it can't.
        return here.value >= 0.0 and strength.at(here.state).value >= settings.planned_load

    measure: GraspMeasure = strength
    if keep_clear is not None and isinstance(manifold.task.test, LiftTest):
        measure = SlackMeasure(manifold, replace(settings, friction=frictions[-1]), state)
    room = None if keep_clear is None else ClearRoom(manifold, keep_clear)
    return climb(manifold, measure, state, is_enough, room)
