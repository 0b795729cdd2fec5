"""Pages in the browser, by viser, which is an extra."""

from contextlib import redirect_stdout
from io import StringIO
from typing import Any

from .extras import from_extra

__all__ = ["close_page", "open_page"]


def open_page(what: str, host: str, port: int) -> tuple[Any, str]:
    """A server of an empty page, and the page's address.

    Args:
        what: is shown there, for the message where viser is missing.
        host: address to listen at.
        port: to listen at, or the next free one.

    Raises:
        MissingBackend: the package viser is not installed.
    """
    viser = from_extra("viser", "edit", what)
    # What viser says of itself is not for those who read our output.
    with redirect_stdout(StringIO()):
        server = viser.ViserServer(host=host, port=port, verbose=False)
    if hasattr(server.gui, "main_panel"):  # viser 1.1 and later
        server.gui.configure_theme(show_share_button=False, show_logo=False)
        server.gui.main_panel.dock_right()
    else:
        server.gui.configure_theme(show_share_button=False, show_logo=False, control_layout="fixed")
    return server, f"http://{host}:{server.get_port()}"


def close_page(server: Any) -> None:
    """Ends a server."""
    with redirect_stdout(StringIO()):
        server.stop()
