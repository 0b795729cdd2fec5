"""Suggesting contacts: pairs of hand and object regions for a hand and an object that have no task yet."""

from .outcome import Outcome, Step
from .search import Search
from .searches import searches, suggest
from .suggestion import Suggestion, Suggestions
from .surface import Site
from .task_text import task_text
from .tried import Tried

__all__ = [
    "Outcome",
    "Search",
    "Site",
    "Step",
    "Suggestion",
    "Suggestions",
    "Tried",
    "searches",
    "suggest",
    "task_text",
]
