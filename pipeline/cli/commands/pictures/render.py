"""`holdfast render GRASP`."""

import argparse
from pathlib import Path

from .....base.machine.backend import check_renderer, configure
from .....base.text.console import emit
from .....mjcf import preset_settings
from ....report import draw_grasp
from .._grasp import load

__all__ = ["main"]


def main(arguments: argparse.Namespace) -> int:
    """Draws a grasp from four sides, and its hold where a squeeze is found; prints the paths."""
    configure()
    check_renderer()
    loaded = load(arguments)
    folder = Path(arguments.out) if arguments.out else loaded.path.with_name(f"{loaded.path.stem}_pictures")
    settings = preset_settings("holdfast", loaded.configuration.task)
    for path in draw_grasp(loaded.configuration, folder, loaded.record.id, settings):
        emit(str(path))
    return 0
