"""The grasp in MuJoCo: hand and object as MJCF, strengthening, the squeeze, the hold test, pictures.

MuJoCo itself is imported when something is simulated or drawn, not by importing this package: it settles on
its OpenGL backend at import (see `holdfast.backend`).
"""

from .directions import DIRECTION_SETS, directions, kind_of_test
from .hold import (
    Agreement,
    DirectionResult,
    FingerFirst,
    HoldResult,
    Noise,
    Outcome,
    Robustness,
    fingers_first,
    hold_margin,
    hold_probability,
    hold_test,
    least_squeeze,
    preset_names,
    preset_settings,
    settings_agreement,
    strain,
    verdict_agreement,
)
from .model import Grasp, PressedPads, Squeeze, grasp_mjcf, hand_mjcf, trial_mjcf
from .settings import HoldSettings
from .squeeze import (
    LoadLimit,
    NotHoldable,
    Obstacle,
    Quality,
    alternative_squeezes,
    auc,
    grasp_quality,
    load_limit,
    plan_squeeze,
    start_strengths,
    starts_differ,
    strengthen,
)

__all__ = [
    "DIRECTION_SETS",
    "Agreement",
    "DirectionResult",
    "FingerFirst",
    "Grasp",
    "HoldResult",
    "HoldSettings",
    "LoadLimit",
    "Noise",
    "NotHoldable",
    "Obstacle",
    "Outcome",
    "PressedPads",
    "Quality",
    "Robustness",
    "Squeeze",
    "alternative_squeezes",
    "auc",
    "directions",
    "fingers_first",
    "grasp_mjcf",
    "grasp_quality",
    "hand_mjcf",
    "hold_margin",
    "hold_probability",
    "hold_test",
    "kind_of_test",
    "least_squeeze",
    "load_limit",
    "plan_squeeze",
    "preset_names",
    "preset_settings",
    "settings_agreement",
    "start_strengths",
    "starts_differ",
    "strain",
    "strengthen",
    "trial_mjcf",
    "verdict_agreement",
]
