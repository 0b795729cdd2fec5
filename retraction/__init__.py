"""Retraction: the clearance of every pair of bodies, and configurations moved until nothing penetrates."""

from .approach import Approach, find_approach
from .clearance import Clearance, PairClearance, compute_clearance, compute_clearances
from .distance import measure
from .outcome import ClearConfiguration, RetractionFailure, RetractionOutcome, Route
from .pairs import CollisionModel, collision_model, overlapping_links
from .retract import retract, retract_all
from .second_opinion import Comparison, compare_clearance, compute_clearance_by_mujoco
from .settings import RetractionSettings

__all__ = [
    "Approach",
    "ClearConfiguration",
    "Clearance",
    "CollisionModel",
    "Comparison",
    "PairClearance",
    "RetractionFailure",
    "RetractionOutcome",
    "RetractionSettings",
    "Route",
    "collision_model",
    "compare_clearance",
    "compute_clearance",
    "compute_clearance_by_mujoco",
    "compute_clearances",
    "find_approach",
    "measure",
    "overlapping_links",
    "retract",
    "retract_all",
]
