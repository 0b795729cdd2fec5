"""Retraction: the clearance of every pair of bodies, and configurations moved until nothing penetrates."""

from .clearance import Clearance, PairClearance, compute_clearance, compute_clearances
from .outcome import ClearConfiguration, RetractionFailure, RetractionOutcome
from .retract import retract, retract_all
from .second_opinion import compute_clearance_by_mujoco
from .settings import RetractionSettings

__all__ = [
    "ClearConfiguration",
    "Clearance",
    "PairClearance",
    "RetractionFailure",
    "RetractionOutcome",
    "RetractionSettings",
    "compute_clearance",
    "compute_clearance_by_mujoco",
    "compute_clearances",
    "retract",
    "retract_all",
]
