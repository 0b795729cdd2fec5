"""Why a task is infeasible, in words that help: what, relaxed alone, would make it possible again.

Each contact is left out, each joint given more range, each region made larger, one at a time. A local search
finds most of what is possible within milliseconds. Where it finds nothing even for the largest step, branch
and prune refutes as large a step as it can, and the smaller ones with it. So each answer is as sure as its
verdict.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np

from ...arguments import check_budget, check_whole_number
from ...base.machine.work_clock import WorkClock
from ...geometry import Cap, Patch, Region
from ...objects import Contact, LiftTest, Task
from ..contacts import search_locally
from ..search import Verdict
from .certify import TaskCertifier
from .solve import check_task, solve

__all__ = ["RelaxationKind", "TaskRelaxation", "explain_infeasible", "relaxations"]


# Limits are widened, and regions enlarged, in these steps until the task becomes possible.
_WIDENINGS_DEG = (10.0, 30.0, 90.0)
_WIDENINGS_M = (0.01, 0.03, 0.1)
_ENLARGEMENTS = (1.5, 3.0)
# Local searches on each relaxed task, some milliseconds each.
_STARTS = 40


class RelaxationKind(Enum):
    """What is relaxed."""

    CONTACT = "contact"
    LIMIT = "joint limit"
    REGION = "region"


@dataclass(frozen=True, eq=False)
class TaskRelaxation:
    """One relaxation and what became of it.

    Attributes:
        kind: what is relaxed.
        name: the contact (`hand region - object region`), the joint, or the region.
        change: what was changed, for people.
        verdict: SOLVED: the relaxed task has a certified configuration; INFEASIBLE: proved that even so
            there is none; UNDECIDED: neither within the budget.
        budget_s: time that branch and prune had.
    """

    kind: RelaxationKind
    name: str
    change: str
    verdict: Verdict
    budget_s: float

    def __str__(self) -> str:
        says = {
            Verdict.SOLVED: "possible",
            Verdict.INFEASIBLE: "still infeasible (proved)",
            Verdict.UNDECIDED: f"undecided in {self.budget_s:g} s",
        }
        return f"{says[self.verdict]} {self.change}"


def explain_infeasible(
    task: Task,
    *,
    budget_s: float = 5.0,
    seed: int = 0,
    workers: int = 1,
    should_stop: Callable[[], bool] | None = None,
) -> tuple[TaskRelaxation, ...]:
    """Tries every relaxation of an infeasible task.

    Args:
        task: the task.
        budget_s: time to refute the steps of a relaxation.
        seed: seed of the local searches.
        workers: processes to use.
        should_stop: asked between the relaxations; what was found by then is returned.

    Raises:
        InputError: an argument that can't be used.

    Returns:
        For each contact, joint limit and region the smallest step that was found to make the task possible;
        or else the largest one that was refuted; or else the largest one, undecided.
    """
    budget_s = check_budget("budget_s", budget_s)
    seed = check_whole_number("seed", seed, least=0)
    workers = check_whole_number("workers", workers, least=1)
    found: list[TaskRelaxation] = []
    for kind, name, steps in relaxations(check_task(task)):
        if should_stop is not None and should_stop():
            break
        change, verdict = _try_steps(steps, budget_s, seed, workers)
        found.append(TaskRelaxation(kind, name, change, verdict, budget_s))
    return tuple(found)


def _try_steps(steps: "Steps", budget_s: float, seed: int, workers: int) -> tuple[str, Verdict]:
    """A step that is possible, or the last one that is refuted, or the last one, with its verdict."""
    for change, relaxed in steps:
        if _is_found_locally(relaxed, seed):
            return change, Verdict.SOLVED
    # Each step allows all that the ones before it allow, so that one refutation stands for all before it.
    clock = WorkClock()
    refuted = -1
    for number, share in ((len(steps) - 1, 0.5), *((k, 1.0) for k in range(len(steps) - 1))):
        left_s = share * (budget_s - clock.seconds)
        if number <= refuted or left_s <= 0.0:
            break
        change, relaxed = steps[number]
        result = solve(relaxed, candidates=1, seed=seed, budget_s=left_s, workers=workers)
        if result.verdict is Verdict.SOLVED:
            return change, Verdict.SOLVED
        if result.verdict is Verdict.INFEASIBLE:
            refuted = number
        elif number < len(steps) - 1:
            break
    if refuted < 0:
        return steps[-1][0], Verdict.UNDECIDED
    return steps[refuted][0], Verdict.INFEASIBLE


def _is_found_locally(task: Task, seed: int) -> bool:
    """Whether some local search from anywhere ends at a certified configuration."""
    certifier, rng = TaskCertifier(task), np.random.default_rng(seed)
    system = certifier.formulation.system
    for _ in range(_STARTS):
        x = rng.uniform(system.lower, system.upper)
        state = search_locally(
            certifier.manifold, certifier.formulation.state_from_inputs(x, certifier.q_free)
        )
        if state is not None and certifier.certify(state).certified:
            return True
    return False


Steps = list[tuple[str, Task]]


def relaxations(task: Task) -> Iterator[tuple[RelaxationKind, str, Steps]]:
    """All relaxations of a task, each as steps of growing size: words and the relaxed task."""
    if len(task.contacts) > 1:
        for i, contact in enumerate(task.contacts):
            name = f"{contact.hand.name} - {contact.object.name}"
            rest = task.contacts[:i] + task.contacts[i + 1 :]
            change = f"without the contact of {contact.hand.name} with {contact.object.name}"
            # A press counts its contacts; of postures no test is asked.
            yield RelaxationKind.CONTACT, name, [(change, replace(task, contacts=rest, test=LiftTest()))]
    for j in _joints_at_work(task):
        yield RelaxationKind.LIMIT, task.hand.independent_names[j], list(_wider_limits(task, j))
    for i, contact in enumerate(task.contacts):
        for side in (contact.object, contact.hand):
            steps = list(_larger_region(task, i, contact, side is contact.hand))
            if steps:
                yield RelaxationKind.REGION, side.name, steps


def _joints_at_work(task: Task) -> list[int]:
    """Independent joints that move a link with a contact."""
    moves = task.hand.tree.moves[[contact.hand.link for contact in task.contacts]].any(axis=0)
    drives = task.hand.coupling_matrix != 0.0
    return [j for j in range(len(task.hand.independent)) if bool(drives[moves, j].any())]


def _wider_limits(task: Task, j: int) -> Iterator[tuple[str, Task]]:
    name = task.hand.independent_names[j]
    revolute = task.hand.axes[task.hand.independent[j]].kind == "revolute"
    for step in _WIDENINGS_DEG if revolute else _WIDENINGS_M:
        limits = task.limits.copy()
        room = np.deg2rad(step) if revolute else step
        limits[j] = limits[j, 0] - room, limits[j, 1] + room
        if revolute:
            limits[j] = np.clip(limits[j], -2.0 * np.pi, 2.0 * np.pi)
        low, high = np.rad2deg(limits[j]) if revolute else 1e3 * limits[j]
        unit = "deg" if revolute else "mm"
        yield f"if {name} could range over {low:.0f}..{high:.0f} {unit}", replace(task, limits=limits)


def _larger_region(task: Task, i: int, contact: Contact, on_hand: bool) -> Iterator[tuple[str, Task]]:
    side = contact.hand if on_hand else contact.object
    whose = "the hand's" if on_hand else "the object's"
    for factor in _ENLARGEMENTS:
        region = _enlarged(side.region, factor)
        if region is None:
            return
        larger = (
            replace(contact, hand=replace(contact.hand, region=region))
            if on_hand
            else replace(contact, object=replace(contact.object, region=region))
        )
        contacts = (*task.contacts[:i], larger, *task.contacts[i + 1 :])
        yield f"if {whose} region {side.name} were {factor:g} times as wide", replace(task, contacts=contacts)


def _enlarged(region: Region, factor: float) -> Region | None:
    """The region, `factor` times as wide: a patch continued beyond its edges, a cap opened; else None.

    What is added may leave the surface of the body, which is no slip here.
    """
    match region:
        case Patch():
            room = 0.5 * (factor - 1.0)
            wider = region.patch.restrict((-room, 1.0 + room), (-room, 1.0 + room))
            return None if wider.normal_may_vanish() else Patch(wider, off_surface=True)
        case Cap():
            if region.half_angle_rad >= np.pi:
                return None
            half_angle_rad = min(np.pi, factor * region.half_angle_rad)
            return replace(region, half_angle_rad=half_angle_rad, off_surface=True)
    return None
