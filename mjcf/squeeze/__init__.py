"""Forces before simulation: contact statics, the squeeze plan, strengthening, measures of quality."""

from .alternatives import alternative_squeezes
from .climbing import planned_slack, start_strengths, starts_differ, strengthen
from .load_limit import LoadLimit, load_limit
from .pads import TURN_SHARE, USUAL_N, contact_curvatures, contact_pads
from .plan import plan_squeeze
from .press_unplanned import press_along_normals
from .quality import Quality, auc, epsilon_and_volume, grasp_quality, torque_length_m
from .refusal import NotHoldable, Obstacle
from .statics import Statics, grasp_statics
from .turn_room import follows_turn

__all__ = [
    "TURN_SHARE",
    "USUAL_N",
    "LoadLimit",
    "NotHoldable",
    "Obstacle",
    "Quality",
    "Statics",
    "alternative_squeezes",
    "auc",
    "contact_curvatures",
    "contact_pads",
    "epsilon_and_volume",
    "follows_turn",
    "grasp_quality",
    "grasp_statics",
    "load_limit",
    "plan_squeeze",
    "planned_slack",
    "press_along_normals",
    "start_strengths",
    "starts_differ",
    "strengthen",
    "torque_length_m",
]
