"""Grasps to look at and play: on a page that viser serves, or in MuJoCo's own window."""

from .page import ViewPage
from .viewable import Viewable, load_viewables
from .window import has_screen, open_window

__all__ = ["ViewPage", "Viewable", "has_screen", "load_viewables", "open_window"]
