"""Names of the pictures in a run's `media/`."""

from pathlib import Path

__all__ = ["VIEW_NAMES", "film_path", "view_path"]

VIEW_NAMES = ("front", "left", "back", "right")
"""The four sides from which a grasp is drawn; the first is the thumbnail's."""


def view_path(folder: Path, identifier: str, view: str) -> Path:
    """Path of the picture of a grasp from one side."""
    return folder / f"{identifier}_{view}.png"


def film_path(folder: Path, identifier: str) -> Path:
    """Path of the filmstrip of a grasp's hold test."""
    return folder / f"{identifier}_hold.png"
