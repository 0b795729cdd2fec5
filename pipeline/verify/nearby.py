"""A certified grasp near a given one: the same links touch where it touched, or why there is none."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import StrEnum
from itertools import combinations

import numpy as np

from ...errors import InputError
from ...grasping import ReadyGrasp, Refusal, make_grasp
from ...hands import Hand
from ...mjcf import NotHoldable, preset_settings
from ...objects import Contact, ObjectModel, Task
from ...retraction import RetractionSettings
from ...solver import Configuration, ContactManifold, State, Verdict, certify_state, search_locally, solve
from .fitted import fitted_contact
from .measured import Measured, Touch

__all__ = ["Nearby", "NearbyVerdict", "find_nearby", "given_configuration", "main_touches", "task_of"]

_MOST_CONTACTS = 5
# Certified grasps that are put to a test before the first of them is taken all the same.
_MOST_TRIED = 4
# Sizes of the regions on the object that are tried in turn.
_GROWN = (1.0, 2.0)
# Descents of retraction; and boxes of the solver, where the local search finds nothing.
_RESTARTS = 8


class NearbyVerdict(StrEnum):
    """What became of the search for a grasp near a given one."""

    FOUND = "found"
    NONE = "none"
    UNDECIDED = "undecided"
    NOT_TRIED = "not tried"


@dataclass(frozen=True, eq=False)
class Nearby:
    """What was found near a given grasp.

    Attributes:
        verdict: found; none, which is proved; undecided; or not tried, for too little touches.
        grasp: certified, clear and squeezed; None unless found.
        dropped: fingers that touch in the given grasp and not in this one.
        reason: why there is none, in words; empty where one was found.
    """

    verdict: NearbyVerdict
    grasp: ReadyGrasp | None = None
    dropped: tuple[str, ...] = ()
    reason: str = ""


def task_of(
    hand: Hand,
    obj: ObjectModel,
    given: Measured,
    touches: tuple[Touch, ...],
    name: str,
    *,
    grown: float = 1.0,
) -> Task:
    """The task whose contacts are the touches of a given grasp.

    Raises:
        InputError: a touch where no region can be laid on hand and object.
    """
    contacts: list[Contact] = [fitted_contact(hand, obj, given, touch, grown=grown) for touch in touches]
    return Task(name=name, hand=hand, object=obj, contacts=contacts, source=name)


def given_configuration(task: Task, given: Measured) -> Configuration:
    """The given grasp as a configuration of its task, with its gaps and depths; nothing of it is certified.

    Coupled joints follow their masters, and joints stand at their limits that were given beyond them.
    """
    manifold = ContactManifold(task)
    q = given.joints[task.hand.independent]
    q = np.clip(q, task.limits[:, 0], task.limits[:, 1])
    state = State(q, given.T_palm_object[:3, :3], given.T_palm_object[:3, 3], np.full(manifold.n_params, 0.5))
    return Configuration(task, state, manifold.error_m(state), None)


def find_nearby(
    hand: Hand,
    obj: ObjectModel,
    given: Measured,
    name: str,
    *,
    prove_s: float = 0.0,
    holds: Callable[[ReadyGrasp], bool] = lambda _: True,
    should_stop: Callable[[], bool] = lambda: False,
) -> Nearby:
    """Looks for a certified grasp near a given one.

    The local search sets out from the given configuration. Where it finds nothing, or what it finds can't be
    freed of penetration or hold the object, larger regions are tried, then fewer fingers.

    Args:
        hand: the hand.
        obj: the object, in its size.
        given: the grasp.
        name: of the tasks that are made.
        holds: whether a grasp passes a test that it should; others are only taken where few more tries find
            none that does.
        prove_s: time for the solver to look for a proof that there is none, or for what a local search
            misses; 0 for none.
        should_stop: asked between tries.
    """
    touches = main_touches(given)
    if len(touches) < 2:
        return Nearby(NearbyVerdict.NOT_TRIED, reason=f"{_count(len(touches))} near the object")
    reason, first, found = "", None, list[Nearby]()
    for chosen, grown in _tries(touches):
        if should_stop():
            return found[0] if found else Nearby(NearbyVerdict.UNDECIDED, reason="interrupted")
        try:
            task = task_of(hand, obj, given, chosen, name, grown=grown)
        except InputError as error:
            reason = reason or f"no regions: {error.allowed}"
            continue
        first = first or task
        made = _make(task, given)
        if not isinstance(made, ReadyGrasp):
            reason = reason or made
            continue
        left = {touch.finger for touch in chosen}
        dropped = dict.fromkeys(t.finger for t in given.touches if t.finger not in left)
        found.append(Nearby(NearbyVerdict.FOUND, made, tuple(dropped)))
        if holds(made):
            return found[-1]
        if len(found) == _MOST_TRIED:
            break
    if found:
        return found[0]
    if first is not None and prove_s > 0.0:
        return _by_solver(first, prove_s, reason, should_stop)
    return Nearby(NearbyVerdict.UNDECIDED, reason=reason)


def main_touches(given: Measured) -> tuple[Touch, ...]:
    """One touch of each finger, the most exact first; the palm only where it touches."""
    found: dict[str, Touch] = {}
    for touch in sorted(given.touches, key=lambda touch: abs(touch.distance_m)):
        found.setdefault(touch.finger, touch)
    if "palm" in found and found["palm"].distance_m > 1e-3:
        del found["palm"]
    return tuple(found.values())[:_MOST_CONTACTS]


def _tries(touches: tuple[Touch, ...]) -> Iterator[tuple[tuple[Touch, ...], float]]:
    """Which touches to ask for, and how large regions may be: all of them, then all but one, and so on."""
    for left_out in range(max(1, len(touches) - 1)):
        for chosen in combinations(touches, len(touches) - left_out):
            for grown in _GROWN if left_out == 0 else _GROWN[:1]:
                yield chosen, grown


def _make(task: Task, given: Measured) -> ReadyGrasp | str:
    """A grasp of a task near a given one, or why there is none."""
    start = given_configuration(task, given)
    manifold = ContactManifold(task)
    state = search_locally(manifold, start.state)
    if state is None:
        return "the links can't touch there all at once, as far as a local search tells"
    configuration = certify_state(manifold, state)
    if not configuration.certified:
        return "a configuration was found that can't be certified"
    settings = preset_settings("holdfast", task)
    made = make_grasp(configuration, settings=settings, retraction=RetractionSettings(restarts=_RESTARTS))
    if isinstance(made, Refusal):
        if isinstance(made.reason, NotHoldable):
            return f"certified, but {made.reason}"
        return f"certified, but not clear: {made.reason}"
    return made


def _by_solver(task: Task, budget_s: float, reason: str, should_stop: Callable[[], bool]) -> Nearby:
    """What branch and prune says of the task: a proof that there is none, or another configuration."""
    result = solve(task, candidates=4, budget_s=budget_s, should_stop=should_stop)
    if result.verdict is Verdict.INFEASIBLE:
        return Nearby(NearbyVerdict.NONE, reason="proved: no configuration touches in these regions")
    for configuration in result.configurations:
        made = make_grasp(configuration, retraction=RetractionSettings(restarts=_RESTARTS))
        if isinstance(made, ReadyGrasp) and configuration.certified:
            return Nearby(NearbyVerdict.FOUND, made)
    return Nearby(NearbyVerdict.UNDECIDED, reason=reason)


def _count(fingers: int) -> str:
    return "no finger is" if fingers == 0 else "only one finger is"
