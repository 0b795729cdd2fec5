"""Statics of an object's regions: whether they can hold a load, the least friction, the largest load."""

from .anytime import NEXT_TO_NOTHING, Anytime, BestGrasp, Standing, climbs, in_time
from .best import BestFriction, best_friction
from .charts import UNIT_M
from .climb import BalancedPoint
from .friction_worker import FrictionSetup
from .load import (
    BestLoad,
    LoadProblem,
    LoadSetup,
    best_load,
    carried_load,
    largest_force_N,
    load_form,
    load_problem,
    most_against,
    why_no_load,
)
from .points import RegionPoints, point_maps
from .problem import StaticsProblem, check_applies, statics_form, statics_problem, why_not
from .refute import StaticsResult, refute_balance
from .rounded import friction_down, friction_up, multiple_down, multiple_up
from .search import StaticsSearch
from .separation import friction_against, needed_friction, twist_for
from .worker import Maps, StaticsBox, StaticsSetup, StaticsWorker

__all__ = [
    "NEXT_TO_NOTHING",
    "UNIT_M",
    "Anytime",
    "BalancedPoint",
    "BestFriction",
    "BestGrasp",
    "BestLoad",
    "FrictionSetup",
    "LoadProblem",
    "LoadSetup",
    "Maps",
    "RegionPoints",
    "Standing",
    "StaticsBox",
    "StaticsProblem",
    "StaticsResult",
    "StaticsSearch",
    "StaticsSetup",
    "StaticsWorker",
    "best_friction",
    "best_load",
    "carried_load",
    "check_applies",
    "climbs",
    "friction_against",
    "friction_down",
    "friction_up",
    "in_time",
    "largest_force_N",
    "load_form",
    "load_problem",
    "most_against",
    "multiple_down",
    "multiple_up",
    "needed_friction",
    "point_maps",
    "refute_balance",
    "statics_form",
    "statics_problem",
    "twist_for",
    "why_no_load",
    "why_not",
]
