"""An editor for tasks in the browser: what is edited, how it is saved, and the page (which needs viser)."""

from .draft import Draft, Pair, surface_hit
from .page import EditorPage
from .saving import EditSource, save_task

__all__ = ["Draft", "EditSource", "EditorPage", "Pair", "save_task", "surface_hit"]
