"""The object as the hand feels it: the parts that it moves, with the mass that the test gives them."""

from dataclasses import replace

from ...geometry import MassProperties
from ...objects import ObjectModel, Task
from ..settings import HoldSettings

__all__ = ["payload"]


def payload(task: Task, settings: HoldSettings) -> ObjectModel:
    """The parts of the task's object that the hand moves, or all of them where it moves none.

    A lift leaves the other parts behind, so that they neither weigh on the hand nor carry anything.
    """
    obj, parts = task.object, task.carried or task.object.parts
    if len(parts) == len(obj.parts) and settings.object_mass_kg is None:
        return obj
    if settings.object_mass_kg is not None:
        scale = settings.object_mass_kg / sum(part.inertia.mass for part in parts)
        parts = tuple(replace(part, inertia=_scaled(part.inertia, scale)) for part in parts)
    return replace(obj, parts=parts)


def _scaled(inertia: MassProperties, scale: float) -> MassProperties:
    return MassProperties(scale * inertia.mass, inertia.centre, scale * inertia.inertia)
