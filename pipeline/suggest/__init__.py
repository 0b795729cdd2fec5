"""Suggesting contacts: pairs of hand and object regions for a hand and an object that have no task yet."""

from .search import Search, searches, suggest
from .suggestion import Suggestion, Suggestions, Tried
from .surface import Site
from .task_text import task_text

__all__ = ["Search", "Site", "Suggestion", "Suggestions", "Tried", "searches", "suggest", "task_text"]
