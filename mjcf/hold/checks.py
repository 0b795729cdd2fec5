"""What a test assumes, from the arguments that all tests share."""

from ...arguments import check_instance
from ..model import Grasp, checked_settings
from ..settings import HoldSettings

__all__ = ["trial_settings"]


def trial_settings(grasp: Grasp, settings: HoldSettings | None) -> HoldSettings:
    """The settings that were given, or for None those that the squeeze was planned for.

    Raises:
        InputError: either argument is something else.
    """
    check_instance("grasp", grasp, Grasp, "a Grasp, made of a Configuration and its Squeeze")
    return checked_settings(settings, grasp.squeeze.settings)
