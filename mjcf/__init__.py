"""The grasp in MuJoCo: hand and object as MJCF, strengthening, the squeeze, the hold test, pictures.

MuJoCo itself is imported when something is simulated or drawn, not by importing this package: it settles on
its OpenGL backend at import (see `holdfast.pipeline.backend`).
"""

from .grasp import Grasp
from .grasp_model import grasp_mjcf
from .hand_model import hand_mjcf
from .hold import hold_test, hold_tests
from .hold_result import DirectionResult, HoldResult, Outcome
from .settings import HoldSettings
from .squeeze import NotHoldable, Obstacle, Squeeze, plan_squeeze
from .strengthen import strengthen

__all__ = [
    "DirectionResult",
    "Grasp",
    "HoldResult",
    "HoldSettings",
    "NotHoldable",
    "Obstacle",
    "Outcome",
    "Squeeze",
    "grasp_mjcf",
    "hand_mjcf",
    "hold_test",
    "hold_tests",
    "plan_squeeze",
    "strengthen",
]
