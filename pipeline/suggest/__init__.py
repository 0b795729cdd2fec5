"""Suggesting contacts: pairs of hand and object regions for a hand and an object that have no task yet."""

from .rank import Suggestion, suggest
from .surface import Site, sites
from .task_text import region_fields, task_text

__all__ = ["Site", "Suggestion", "region_fields", "sites", "suggest", "task_text"]
