"""Candidates among which the environment has one chosen, and the numbers that describe them."""

from .candidate_pool import Candidate, load_pool
from .features import LIMIT, feature_names

__all__ = ["LIMIT", "Candidate", "feature_names", "load_pool"]
