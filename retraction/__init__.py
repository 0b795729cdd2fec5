"""Retraction: the clearance of every pair of bodies, and configurations moved until nothing penetrates."""

from .approach import Approach, find_approach
from .bodies import Bodies, Body, build_piece, hand_bodies
from .clear_room import ClearRoom
from .clearance import Clearance, PairClearance, compute_clearance, compute_clearances
from .contact_gaps import contact_gaps
from .distance import lower_bounds, measure
from .mujoco_clearance import ClearanceComparison, compare_clearance, compute_clearance_by_mujoco
from .nearest import measure_quickly
from .outcome import (
    ClearConfiguration,
    FailureReason,
    RetractionFailure,
    RetractionOutcome,
    RetractionStatus,
    Route,
)
from .pairs import CollisionModel, collision_model, overlapping_links
from .retract import retract
from .settings import RetractionSettings

__all__ = [
    "Approach",
    "Bodies",
    "Body",
    "ClearConfiguration",
    "ClearRoom",
    "Clearance",
    "ClearanceComparison",
    "CollisionModel",
    "FailureReason",
    "PairClearance",
    "RetractionFailure",
    "RetractionOutcome",
    "RetractionSettings",
    "RetractionStatus",
    "Route",
    "build_piece",
    "collision_model",
    "compare_clearance",
    "compute_clearance",
    "compute_clearance_by_mujoco",
    "compute_clearances",
    "contact_gaps",
    "find_approach",
    "hand_bodies",
    "lower_bounds",
    "measure",
    "measure_quickly",
    "overlapping_links",
    "retract",
]
