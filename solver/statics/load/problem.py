"""What a tree for the load asks: how large a load do contacts of limited normal force carry at most?

Exact statement of a bound, in the object's frame: at any point of each contact's region of the object, a
soft-finger force as in `statics.problem`, with the friction of the object, and a normal part of F_i at most.
There is a direction in which such forces do not carry more than the bound times the weight, wherever the
points are. So no grasp by these contacts, as points, carries more whichever way gravity acts; and in a test
whose directions come within an angle of every direction, none more than the bound over that angle's cosine.

What F_i stands for: servos' efforts make forces in the hand's frame, which no statics of the object knows. So
a largest normal force takes their place: that of the task or the hand, or what the hand's fingertips are
rated for, or a number that is given.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from ....arguments import check_number
from ....base.numeric.arrays import Array
from ....errors import InputError
from ....objects import LiftTest, Task
from ..problem import StaticsProblem, statics_problem

__all__ = ["LoadProblem", "largest_force_N", "load_form", "load_problem", "why_no_load"]

# Standard gravity as the hold test has it.
_GRAVITY = 9.81
_LEAST_COVERED = 1e-6


@dataclass(frozen=True, eq=False)
class LoadProblem(StaticsProblem):
    """A problem with limited forces and a weight.

    Attributes:
        forces_N: largest normal force (n,) of each contact.
        weight_N: the load.
        cosine: of the angle within which some direction of the task's test is of every direction.
    """

    forces_N: Array
    weight_N: float
    cosine: float

    @property
    def log(self) -> str:
        """The kind of log of a tree."""
        return "load"

    @property
    def claim(self) -> str:
        """What such a log claims a bound of."""
        return "multiple"


def why_no_load(task: Task) -> str:
    """Why nothing is said of how much a task's regions carry; empty where something is."""
    if not isinstance(task.test, LiftTest):
        return "its test is no lift: a stand takes up what the contacts don't balance"
    if _covered(task.test) < _LEAST_COVERED:
        return "its load acts along few directions, so an object may rest on the hand"
    if not task.contacts:
        return "it has no contacts"
    return ""


def largest_force_N(task: Task, max_force_N: float | None = None) -> float:
    """The largest normal force of each contact: as given, or the task's and the hand's, or as rated.

    Raises:
        InputError: it can't be used, or nothing says how large it is.
    """
    if max_force_N is not None:
        return check_number("max_force_N", max_force_N, above=0.0)
    if task.max_normal_force_N is not None:
        return task.max_normal_force_N
    if task.hand.rated_force_N is None:
        raise InputError(
            task.name,
            "max_normal_force",
            f"neither the task nor its hand {task.hand.name} says how hard a contact may press; give a "
            "largest normal force (--max-force N, or max_force_N=N in Python)",
        )
    return task.hand.rated_force_N


def load_problem(
    task: Task, *, max_force_N: float | None = None, spin_arm_m: float | None = None
) -> LoadProblem:
    """The problem of a task of which something is said; see `why_no_load`.

    Args:
        task: the task.
        max_force_N: largest normal force of each contact; see `largest_force_N`.
        spin_arm_m: see `statics_problem`.

    Raises:
        InputError: an argument that can't be used, a task of which nothing is said, or an unknown force.
    """
    base = statics_problem(_check_applies(task), spin_arm_m=spin_arm_m)
    force_N = largest_force_N(task, max_force_N)
    forces_N = [force_N] * base.n_contacts
    assert isinstance(task.test, LiftTest)
    return LoadProblem(
        task=base.task,
        charts=base.charts,
        arms=base.arms,
        reaches=base.reaches,
        friction=base.friction,
        form=_form(base) | {"forces_N": forces_N},
        forces_N=np.array(forces_N),
        weight_N=base.form["mass_kg"] * _GRAVITY,
        cosine=_covered(task.test),
    )


def load_form(task: Task) -> dict[str, Any]:
    """A task's regions and load as plain data, for `holdfast.check_proof` to compare the log of a tree with.

    Largest forces are not among them: they may be given beside the task.

    Raises:
        InputError: nothing is said of the task.
    """
    return _form(statics_problem(_check_applies(task)))


def _form(base: StaticsProblem) -> dict[str, Any]:
    form = {key: value for key, value in base.form.items() if key not in ("reaches_m", "directions")}
    return form | {"friction": base.friction, "gravity": _GRAVITY}


def _check_applies(task: Task) -> Task:
    reason = why_no_load(task)
    if reason:
        raise InputError(task.name, "", f"nothing is said of how much its regions carry: {reason}")
    return task


def _covered(test: LiftTest) -> float:
    """The least over all directions of the largest cosine with one of the test's; 0 where it is not above."""
    directions = np.unique(np.array(test.directions, dtype=float).reshape(-1, 3), axis=0)
    try:
        return max(0.0, float(-ConvexHull(directions).equations[:, 3].max()))
    except (QhullError, ValueError):
        return 0.0
