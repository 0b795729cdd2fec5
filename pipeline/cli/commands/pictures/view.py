"""`holdfast view RUN|GRASP`."""

import argparse
from pathlib import Path
from time import sleep

from .....base.text.console import Console, emit
from .....errors import InputError
from ....view import ViewPage, has_screen, load_viewables, open_window
from ...interrupt import stop_on_interrupt

__all__ = ["main"]

# How often it is asked whether to end.
_TICK_S = 0.2


def main(arguments: argparse.Namespace) -> int:
    """Shows grasps in MuJoCo's window, or serves a page with them until Ctrl-C and prints its address."""
    console = Console(quiet=arguments.quiet)
    grasps = load_viewables(Path(arguments.name), arguments.task)
    if arguments.where == "window" and not has_screen():
        raise InputError("view", "--in", "window needs a screen, and DISPLAY names none: take browser")
    if arguments.where == "window" or (arguments.where is None and has_screen()):
        console.say(f"opening {grasps[0].record.id} in MuJoCo's viewer; close the window to end")
        open_window(grasps[0])
        return 0
    page = ViewPage(grasps, host=arguments.host, port=arguments.port)
    try:
        emit(page.url)
        console.say("Ctrl-C ends the viewer")
        with stop_on_interrupt(console.say) as should_stop:
            while not should_stop():
                sleep(_TICK_S)
    finally:
        page.stop()
    return 0
