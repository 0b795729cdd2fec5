"""The grasp in MuJoCo: hand and object as MJCF, strengthening, the squeeze, the hold test, pictures.

MuJoCo itself is imported when something is simulated or drawn, not by importing this package: it settles on
its OpenGL backend at import (see `holdfast.pipeline.backend`).
"""

from .agreement import Agreement, settings_agreement
from .directions import DIRECTION_SETS, directions, kind_of_test
from .grasp import Grasp
from .grasp_model import grasp_mjcf
from .hand_model import hand_mjcf
from .hold import hold_test, hold_tests
from .hold_result import DirectionResult, HoldResult, Outcome
from .holdable import NotHoldable, Obstacle
from .margin import hold_margin
from .presets import preset_names, preset_settings
from .quality import Quality, auc, grasp_quality
from .robustness import Noise, Robustness, hold_probability
from .settings import HoldSettings
from .squeeze import Squeeze
from .squeeze_plan import plan_squeeze
from .strengthen import strengthen
from .trial_model import trial_mjcf

__all__ = [
    "DIRECTION_SETS",
    "Agreement",
    "DirectionResult",
    "Grasp",
    "HoldResult",
    "HoldSettings",
    "Noise",
    "NotHoldable",
    "Obstacle",
    "Outcome",
    "Quality",
    "Robustness",
    "Squeeze",
    "auc",
    "directions",
    "grasp_mjcf",
    "grasp_quality",
    "hand_mjcf",
    "hold_margin",
    "hold_probability",
    "hold_test",
    "hold_tests",
    "kind_of_test",
    "plan_squeeze",
    "preset_names",
    "preset_settings",
    "settings_agreement",
    "strengthen",
    "trial_mjcf",
]
