"""What contacts at places of an object can carry, before any kinematics: computed, and used to choose by."""

from .carrying import WANTED, Carrying, Limit, Load, carrying, object_load, task_load
from .choice import PLANNED_FRICTION, first_that_carries, others_that_carry
from .finger_force import Fingertip, usual_fingertip
from .forces import CarriedForces, carried_forces
from .multiple import best_points, least_multiple, most_multiple
from .places import Places, contact_places

__all__ = [
    "PLANNED_FRICTION",
    "WANTED",
    "CarriedForces",
    "Carrying",
    "Fingertip",
    "Limit",
    "Load",
    "Places",
    "best_points",
    "carried_forces",
    "carrying",
    "contact_places",
    "first_that_carries",
    "least_multiple",
    "most_multiple",
    "object_load",
    "others_that_carry",
    "task_load",
    "usual_fingertip",
]
