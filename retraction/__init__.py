"""Retraction: the clearance of every pair of bodies, and configurations moved until nothing penetrates."""

from .approach import Approach, find_approach
from .clearance import Clearance, PairClearance, compute_clearance, compute_clearances
from .outcome import ClearConfiguration, RetractionFailure, RetractionOutcome, Route
from .retract import retract, retract_all
from .second_opinion import Comparison, compare_clearance, compute_clearance_by_mujoco
from .settings import RetractionSettings

__all__ = [
    "Approach",
    "ClearConfiguration",
    "Clearance",
    "Comparison",
    "PairClearance",
    "RetractionFailure",
    "RetractionOutcome",
    "RetractionSettings",
    "Route",
    "compare_clearance",
    "compute_clearance",
    "compute_clearance_by_mujoco",
    "compute_clearances",
    "find_approach",
    "retract",
    "retract_all",
]
