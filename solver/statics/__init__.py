"""Statics of an object's regions: a proof that they can't hold a load, and how little friction they need."""

from .best import BestFriction, Standing, best_friction
from .climb import BalancedPoint
from .problem import statics_form, why_not
from .refute import StaticsResult, refute_balance

__all__ = [
    "BalancedPoint",
    "BestFriction",
    "Standing",
    "StaticsResult",
    "best_friction",
    "refute_balance",
    "statics_form",
    "why_not",
]
