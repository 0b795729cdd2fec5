"""What a statics tree asks: can forces at points of these regions carry the task's load, however the hand is?

Exact statement of a refutation, in the object's frame: take any point of each contact's region of the object,
and at each a soft-finger force, f_n >= 0 along the inward normal with f_t^2 + (tau / r)^2 <= mu^2 f_n^2,
where mu is the friction and r the largest arm at which the hand's pad can resist spin. No such forces but
zero balance each other. A lift that is tested along a direction and the opposite one then fails in one of
them: the forces that carry the weight w and those that carry -w would together balance each other, and w is
not zero. That holds whatever the hand does, wherever the object is in it, and for any mass above zero. Less
friction refutes as well.

What it does not say: the contacts that the task names, as points. A palm or a pad that carries over an area
is no point: `reach_m` lets each contact act anywhere within a disc about its point, which refutes less. A
link that happens to touch elsewhere, or a stand, is another contact; a grasp that simulation holds by one of
them is no contradiction. Nor does it apply where no direction of the load has its opposite, or to turns and
presses, which a stand holds: `why_not` says so.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np

from ...arguments import check_number
from ...base.numeric.arrays import Array
from ...errors import InputError
from ...objects import LiftTest, Task
from .charts import UNIT_M, Chart, region_charts

__all__ = ["StaticsProblem", "check_applies", "statics_form", "statics_problem", "why_not"]


@dataclass(frozen=True, eq=False)
class StaticsProblem:
    """Regions of a task's object as seen from its centre of mass.

    Attributes:
        task: name of the task.
        charts: of each contact, charts that cover its region.
        arms: spin arm (n,) of each contact in `UNIT_M`.
        reaches: radius (n,) in `UNIT_M` of the disc about its point in which each contact acts.
        friction: coefficient of the task.
        form: what a log says of the problem; see docs/statics.md.
    """

    task: str
    charts: tuple[tuple[Chart, ...], ...]
    arms: Array
    reaches: Array
    friction: float
    form: dict[str, Any]

    @property
    def log(self) -> str:
        """The kind of log of a tree."""
        return "statics"

    @property
    def claim(self) -> str:
        """What such a log claims a bound of."""
        return "friction"

    @property
    def n_contacts(self) -> int:
        """Number of contacts."""
        return len(self.charts)

    @property
    def choices(self) -> list[tuple[int, ...]]:
        """All ways to choose a chart for each contact, which are the roots of the tree."""
        return list(product(*(range(len(charts)) for charts in self.charts)))


def why_not(task: Task) -> str:
    """Why statics of regions says nothing of a task's test; empty where it does."""
    if not isinstance(task.test, LiftTest):
        return "its test is no lift: a stand takes up what the contacts don't balance"
    if not _has_opposites(task.test.directions):
        return "no direction of its load has its opposite, so contacts need not balance each other"
    if not task.contacts:
        return "it has no contacts"
    return ""


def statics_problem(
    task: Task, *, friction: float | None = None, spin_arm_m: float | None = None, reach_m: float = 0.0
) -> StaticsProblem:
    """The problem of a task to which statics applies (see `why_not`).

    Args:
        task: the task.
        friction: coefficient; that of the object unless given.
        spin_arm_m: arm at which friction resists spin at every contact; the largest that the hand's pads have
            (`Pad.largest_arm_m`), whatever their shape and force, unless given.
        reach_m: radius of the disc about its point, in the tangent plane, anywhere in which each contact
            acts.

    Raises:
        InputError: a coefficient or an arm that can't be used.
    """
    arm_m = task.hand.pad.largest_arm_m if spin_arm_m is None else spin_arm_m
    check_number("spin_arm_m", arm_m, least=0.0)
    reach_m = check_number("reach_m", reach_m, least=0.0)
    mu = check_number("friction", task.object.friction if friction is None else friction, least=0.0)
    assert isinstance(task.test, LiftTest)
    carried = replace(task.object, parts=task.carried).inertia
    centre = np.asarray(carried.centre, dtype=float)
    charts = tuple(tuple(region_charts(c.object.region, centre)) for c in task.contacts)
    form = {
        "contacts": [[chart.data for chart in of_one] for of_one in charts],
        "centre_m": centre.tolist(),
        "spin_arms_m": [float(arm_m)] * len(charts),
        "reaches_m": [reach_m] * len(charts),
        "mass_kg": float(carried.mass),
        "directions": [[float(x) for x in d] for d in task.test.directions],
    }
    arms, reaches = np.full(len(charts), arm_m / UNIT_M), np.full(len(charts), reach_m / UNIT_M)
    return StaticsProblem(task.name, charts, arms, reaches, mu, form)


def statics_form(task: Task) -> dict[str, Any]:
    """A task's regions and load as plain data, for `holdfast.check_proof` to compare the log of a tree with.

    Raises:
        InputError: statics says nothing of the task.
    """
    return statics_problem(check_applies(task)).form


def check_applies(task: Task) -> Task:
    """The task.

    Raises:
        InputError: statics says nothing of it.
    """
    reason = why_not(task)
    if reason:
        raise InputError(task.name, "", f"statics of its regions says nothing of this task: {reason}")
    return task


def _has_opposites(directions: Sequence[tuple[float, float, float]]) -> bool:
    known = {tuple(float(x) for x in d) for d in directions}
    return any(tuple(-x for x in d) in known for d in known)
