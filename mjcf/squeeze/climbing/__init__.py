"""Sliding a grasp along its contacts to where it carries its load, and what says how well it does."""

from .starts import planned_slack, start_strengths, starts_differ
from .strengthen import strengthen

__all__ = ["planned_slack", "start_strengths", "starts_differ", "strengthen"]
