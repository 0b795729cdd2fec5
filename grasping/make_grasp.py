"""The step from a configuration to a grasp."""

from ..mjcf import Grasp, HoldSettings, NotHoldable, plan_squeeze, preset_settings
from ..retraction import Approach, RetractionSettings
from ..solver import Configuration
from .clearing import Clearing, strengthen_and_clear
from .ready_grasp import ReadyGrasp, Refusal

__all__ = ["make_grasp", "squeeze_grasp"]


def make_grasp(
    configuration: Configuration,
    *,
    settings: HoldSettings | None = None,
    retraction: RetractionSettings | None = None,
) -> ReadyGrasp | Refusal:
    """Makes a grasp of a configuration: strengthens and retracts it in turns, and plans the squeeze.

    Args:
        configuration: from the solver; the grasp is certified where this is.
        settings: of the hold test to come; None takes the preset `holdfast` for the configuration's task.
        retraction: thresholds of clearance; None takes the defaults.

    Returns:
        The grasp, whose configuration may be another one of the same task (see `ReadyGrasp.clearing`), or
        why there is none: it could not be freed of penetration, or no forces of the hand can hold the object.
    """
    settings = settings or preset_settings("holdfast", configuration.task)
    clearing = strengthen_and_clear(configuration, settings=settings, retraction=retraction)
    if clearing.failure is not None:
        return Refusal(clearing.configuration, clearing.failure, settings, clearing)
    return _squeezed(clearing.configuration, settings, clearing.approach, clearing)


def squeeze_grasp(
    configuration: Configuration, *, settings: HoldSettings | None = None, approach: Approach | None = None
) -> ReadyGrasp | Refusal:
    """The last step of `make_grasp` alone, with a configuration as it is, be it clear or not.

    Args:
        configuration: where hand and object are.
        settings: of the hold test to come; None takes the preset `holdfast` for the configuration's task.
        approach: of the configuration, where it is known; None looks for it when it is needed.
    """
    settings = settings or preset_settings("holdfast", configuration.task)
    return _squeezed(configuration, settings, approach, None)


def _squeezed(
    configuration: Configuration,
    settings: HoldSettings,
    approach: Approach | None,
    clearing: Clearing | None,
) -> ReadyGrasp | Refusal:
    squeeze = plan_squeeze(configuration, settings=settings)
    if isinstance(squeeze, NotHoldable):
        return Refusal(configuration, squeeze, settings, clearing)
    return ReadyGrasp(Grasp(configuration, squeeze, approach), clearing)
