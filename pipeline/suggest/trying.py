"""One try: a task made of sites and fingers is solved, made clear and squeezed."""

from dataclasses import dataclass, replace

import numpy as np

from ...base.machine.cancellation import give_up_if_asked
from ...geometry import region_normal
from ...grasping import ReadyGrasp, make_grasp
from ...hands import Hand, HandRegion
from ...mjcf import HoldSettings, grasp_quality, preset_settings
from ...objects import Contact, ObjectModel, ObjectRegion, Task
from ...retraction import RetractionFailure, RetractionSettings
from ...solver import (
    Configuration,
    ContactManifold,
    Progress,
    SolveResult,
    State,
    certify_state,
    pad_misfits,
    search_locally,
    solve,
)
from .outcome import Outcome
from .pad_edges import EDGE_ROOM_DEG, is_edge
from .screen import Combination
from .suggestion import Suggestion

__all__ = ["Effort", "solved_states", "task_of", "try_from", "try_task"]

# The number of boxes ends a try; this is for what nobody has thought of.
_LONGEST_S = 30.0
# With a number behind it, a name may have 64 characters.
_LONGEST_NAME = 56


@dataclass(frozen=True)
class Effort:
    """How much is spent on a try.

    Attributes:
        candidates: configurations asked of the solver.
        boxes: that it may look into; in place of a time, so that the same seed tries the same.
        cleared: of its configurations, how many are made grasps at most.
        restarts: of retraction.
    """

    candidates: int
    boxes: int
    cleared: int
    restarts: int


def try_task(task: Task, seed: int, effort: Effort) -> Suggestion | Outcome:
    """A suggestion, or which step refused it.

    Raises:
        Cancelled: whoever asked for it wants no more of it.
    """
    result = _solve(task, seed, effort)
    certified = [c for c in result.configurations if c.certified]
    if not certified:
        askew = [abs(misfit.hand_deg - misfit.object_deg) for misfit in pad_misfits(task)]
        return Outcome("askew", askew_deg=max(askew)) if askew else Outcome("unreached")
    return _made(task, certified, effort, len(certified) / result.boxes)


def try_from(task: Task, state: State, effort: Effort) -> Suggestion | Outcome:
    """A suggestion near a state, or which step refused it.

    Raises:
        Cancelled: whoever asked for it wants no more of it.
    """
    manifold = ContactManifold(task)
    found = search_locally(manifold, replace(state, params=np.full(manifold.n_params, 0.5)))
    if found is None:
        return Outcome("unreached")
    configuration = certify_state(manifold, found)
    if not configuration.certified:
        return Outcome("unreached")
    return _made(task, [configuration], effort, 1.0)


def solved_states(task: Task, seed: int, effort: Effort) -> list[State]:
    """States in which regions touch places, certified and nothing more."""
    result = _solve(task, seed, effort)
    return [c.state for c in result.configurations if c.certified]


def _made(task: Task, certified: list[Configuration], effort: Effort, reach: float) -> Suggestion | Outcome:
    """A suggestion of the best of certified configurations that can be freed and squeezed."""
    settings: HoldSettings = preset_settings("holdfast", task)
    certified.sort(key=lambda c: -grasp_quality(c, settings=settings).epsilon)
    retraction = RetractionSettings(restarts=effort.restarts)
    is_clear = False
    blocking = []
    for configuration in certified[: effort.cleared]:
        give_up_if_asked()
        made = make_grasp(configuration, settings=settings, retraction=retraction)
        if isinstance(made, ReadyGrasp):
            return Suggestion(task, made, reach)
        if not isinstance(made.reason, RetractionFailure):
            is_clear = True
        elif made.reason.worst_pair is not None:
            blocking.append(made.reason.worst_pair)
    return Outcome("weak" if is_clear else "sinking", tuple(blocking))


def _solve(task: Task, seed: int, effort: Effort) -> SolveResult:
    """What the solver finds in its first boxes."""
    boxes = 0

    def count(progress: Progress) -> None:
        nonlocal boxes
        boxes = progress.boxes
        give_up_if_asked()

    return solve(
        task,
        candidates=effort.candidates,
        seed=seed,
        budget_s=_LONGEST_S,
        on_progress=count,
        should_stop=lambda: boxes >= effort.boxes,
    )


def task_of(
    hand: Hand,
    obj: ObjectModel,
    combination: Combination,
    regions: tuple[HandRegion, ...],
    room_deg: float | None = None,
) -> Task:
    """The task in which regions of a hand touch places on an object.

    Args:
        hand: the hand.
        obj: the object.
        combination: the places.
        regions: of the hand, one for each.
        room_deg: by how much normals at flat ones may fail to be opposed; None for the usual.
    """
    pairs = tuple(
        Contact(
            region,
            ObjectRegion(site.name or "inline", site.region),
            _room_deg(region, room_deg),
        )
        for region, site in zip(regions, combination.sites, strict=True)
    )
    fingers = "_".join(region.name.replace("/", "_").removesuffix("_tip") for region in regions)
    return Task(name=f"{obj.name}_{fingers}"[:_LONGEST_NAME], hand=hand, object=obj, contacts=pairs)


def _room_deg(region: HandRegion, room_deg: float | None) -> float | None:
    """Room for the normal of a contact: that of an edge, or what is given where the region is flat."""
    if is_edge(region):
        return EDGE_ROOM_DEG
    return None if region_normal(region.region) is None else room_deg
