"""What a task's contacts can carry, as a run says it before anything else."""

from math import isfinite

from ...mjcf import HoldSettings
from ...objects import ObjectRegion, Task
from ...objects.carrying import Load, carrying, others_that_carry, task_load
from ..records import CarryingRecord

__all__ = ["find_carrying", "with_others"]


def find_carrying(task: Task, hold: HoldSettings) -> CarryingRecord | None:
    """What the contacts of a task can carry, and others that would; None where a stand carries the object."""
    load = _load(task, hold)
    if load is None:
        return None
    found = carrying(task.contacts, task.hand, load, task.max_normal_force_N)
    instead = [] if found.is_enough else _instead(task, load)
    text = str(found)
    if instead:
        text += f"; these would: {', '.join(instead)}"
    elif not found.is_enough:
        text += "; no named regions of the object were found that would: see `holdfast suggest`"
    return CarryingRecord(
        multiple=_finite(found.multiple),
        spread=_finite(found.spread),
        limit=None if found.limit is None else found.limit.value,
        forces=[_finite(force) for force in found.forces_N],
        friction=found.friction,
        force_factor=found.force_factor,
        friction_needed=found.friction_needed,
        instead=instead,
        text=text,
    )


def with_others(task: Task, hold: HoldSettings, record: CarryingRecord) -> CarryingRecord:
    """The record with contacts that would carry the load, where its own seemed to and no grasp's plan did."""
    load = _load(task, hold)
    return record if load is None else record.model_copy(update={"instead": _instead(task, load)})


def _load(task: Task, hold: HoldSettings) -> Load | None:
    return task_load(
        task,
        friction=hold.sliding_friction(task.object),
        gravity=hold.gravity,
        directions=hold.directions,
        mass_kg=hold.object_mass_kg,
    )


def _instead(task: Task, load: Load) -> list[str]:
    regions = [ObjectRegion(name, region) for name, region in task.object.regions.items()]
    others = others_that_carry(task.hand, load, task.contacts, regions)
    return [f"{contact.hand.name} - {contact.object.name}" for contact in others or ()]


def _finite(value: float) -> float | None:
    return value if isfinite(value) else None
