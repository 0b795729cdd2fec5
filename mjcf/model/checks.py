"""Checks of the arguments that the functions of this room share."""

from ...arguments import check_instance
from ...solver import Configuration
from ..settings import HoldSettings

__all__ = ["check_configuration", "checked_settings"]


def check_configuration(configuration: Configuration) -> None:
    """Refuses what is no configuration.

    Raises:
        InputError: it is something else.
    """
    check_instance("configuration", configuration, Configuration, "a Configuration, as solve gives it")


def checked_settings(settings: HoldSettings | None, default: HoldSettings | None = None) -> HoldSettings:
    """The settings that were given, or the default ones for None.

    Args:
        settings: what was given.
        default: what None stands for; None for the defaults of `HoldSettings`.

    Raises:
        InputError: it is something else.
    """
    if settings is None:
        return default or HoldSettings()
    return check_instance("settings", settings, HoldSettings, "HoldSettings, as preset_settings gives them")
