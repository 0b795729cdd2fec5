"""Statics of an object's regions: whether they can hold a load, the least friction, the largest load."""

from .anytime import Standing
from .best import BestFriction, best_friction
from .climb import BalancedPoint
from .load import BestLoad, best_load, largest_force_N, load_form, why_no_load
from .problem import statics_form, why_not
from .refute import StaticsResult, refute_balance

__all__ = [
    "BalancedPoint",
    "BestFriction",
    "BestLoad",
    "Standing",
    "StaticsResult",
    "best_friction",
    "best_load",
    "largest_force_N",
    "load_form",
    "refute_balance",
    "statics_form",
    "why_no_load",
    "why_not",
]
