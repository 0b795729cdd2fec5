"""What a grasp is put to beside its test: more load, less squeeze, other settings, noise, a finger first."""

from .agreement import Agreement, settings_agreement, verdict_agreement
from .disturbance import Disturbance, hold_disturbed
from .finger_first import FingerFirst, fingers_first
from .least_squeeze import least_squeeze
from .less_spin import LessSpin, with_less_spin
from .margin import Margin, find_margin, hold_margin
from .robustness import Noise, Robustness, hold_probability

__all__ = [
    "Agreement",
    "Disturbance",
    "FingerFirst",
    "LessSpin",
    "Margin",
    "Noise",
    "Robustness",
    "find_margin",
    "fingers_first",
    "hold_disturbed",
    "hold_margin",
    "hold_probability",
    "least_squeeze",
    "settings_agreement",
    "verdict_agreement",
    "with_less_spin",
]
