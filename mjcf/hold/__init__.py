"""The hold test: a squeezed grasp is lifted, turned or pressed in simulation, and its motion is measured."""

from .hold import hold_test, hold_test_if_passed
from .lift import Lift, shared_lift
from .outcome import Outcome
from .placement import Placement
from .presets import preset_names, preset_settings
from .result import DirectionResult, HoldResult, UsualSqueeze
from .strain import strain, whole_strain
from .trials import (
    Agreement,
    Disturbance,
    FingerFirst,
    LessSpin,
    Margin,
    Noise,
    Robustness,
    find_margin,
    fingers_first,
    hold_disturbed,
    hold_margin,
    hold_probability,
    least_squeeze,
    settings_agreement,
    verdict_agreement,
    with_less_spin,
)
from .warp import hold_many
from .words import load_word, outcome_word, passed_word, verdict_word

__all__ = [
    "Agreement",
    "DirectionResult",
    "Disturbance",
    "FingerFirst",
    "HoldResult",
    "LessSpin",
    "Lift",
    "Margin",
    "Noise",
    "Outcome",
    "Placement",
    "Robustness",
    "UsualSqueeze",
    "find_margin",
    "fingers_first",
    "hold_disturbed",
    "hold_many",
    "hold_margin",
    "hold_probability",
    "hold_test",
    "hold_test_if_passed",
    "least_squeeze",
    "load_word",
    "outcome_word",
    "passed_word",
    "preset_names",
    "preset_settings",
    "settings_agreement",
    "shared_lift",
    "strain",
    "verdict_agreement",
    "verdict_word",
    "whole_strain",
    "with_less_spin",
]
