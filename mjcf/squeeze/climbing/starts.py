"""How well configurations of a task could hold before anything has moved them: which are worth a start."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ....base.machine.cancellation import give_up_if_asked
from ....base.numeric.arrays import Array
from ....objects import LiftTest, Task
from ....solver import Configuration, ContactManifold
from ...model import checked_settings
from ...settings import HoldSettings
from .grasp_slack import SlackMeasure
from .grasp_strength import StrengthMeasure

__all__ = ["planned_slack", "start_strengths", "starts_differ"]

# Digits that are kept, so that programs that begin at other bases rank alike.
_DIGITS = 6


def starts_differ(task: Task) -> bool:
    """Whether `start_strengths` tells configurations of a task apart: on a stand, all carry the load."""
    return isinstance(task.test, LiftTest)


def start_strengths(
    configurations: Sequence[Configuration], *, settings: HoldSettings | None = None
) -> Array:
    """What strengthening would climb from, (n,): see `StrengthMeasure`, at the friction planned with first.

    Below zero it is minus the imbalance of contact forces inside their cones and the servos' efforts, above
    it the load that is carried, in multiples of the weight. It takes some milliseconds a configuration.

    Args:
        configurations: of one task, as solved; at least one.
        settings: of the hold test to come.
    """
    settings = checked_settings(settings)
    first = configurations[0]
    friction = settings.planned_frictions(first.task.object)[0]
    manifold = ContactManifold(first.task)
    measure = StrengthMeasure(manifold, replace(settings, friction=friction), first.state)
    values = []
    for configuration in configurations:
        give_up_if_asked()
        measure.begin_at(configuration.state)
        values.append(measure.at(configuration.state).value)
    return np.round(np.array(values), _DIGITS)


def planned_slack(configuration: Configuration, *, settings: HoldSettings | None = None) -> float:
    """What a grasp has to spare under the planned load, with all of the friction; see `SlackMeasure`.

    In N, what every contact may lose before one slips; on a stand, which carries the object, in multiples of
    the load, what is carried beyond the planned one. At least zero where a squeeze carries the planned load.
    """
    settings = checked_settings(settings)
    task = configuration.task
    manifold = ContactManifold(task)
    whole = replace(settings, friction=settings.planned_frictions(task.object)[-1])
    if not starts_differ(task):
        strength = StrengthMeasure(manifold, whole, configuration.state).at(configuration.state).value
        return strength - settings.planned_load
    return SlackMeasure(manifold, whole, configuration.state).at(configuration.state).value
