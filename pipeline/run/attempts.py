"""Grasps made of configurations and put to the test, one by one in this process or in several."""

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError, Future
from concurrent.futures import TimeoutError as FutureTimeout
from dataclasses import dataclass

from ...cancellation import Cancelled, cancellable
from ...compile_clock import compile_s
from ...grasping import Refusal, Trial, make_grasp, try_hold
from ...mjcf import HoldSettings, trial_mjcf
from ...objects import Task
from ...retraction import RetractionSettings
from ...solver import Configuration, ContactManifold, State, certify_state
from ...workers import WorkerPool

__all__ = ["Attempt", "AttemptSetup", "AttemptWorker", "attempt_all"]

# Jobs that are handed out ahead of those whose turn it is, by worker: none of them waits for long.
_AHEAD = 2
# How often whoever waits for a process looks whether to go on.
_GLANCE_S = 0.1


@dataclass(frozen=True, eq=False)
class Attempt:
    """What became of a state.

    Attributes:
        outcome: the trial of the grasp that was made of it, or why there is none; None where every process
            that worked on it was lost.
        mjcf: its model.
    """

    outcome: Trial | Refusal | None
    mjcf: str


@dataclass(frozen=True, eq=False)
class AttemptSetup:
    """What all attempts of a run have in common.

    Attributes:
        task: the task, whose values travel to each process once.
        hold: settings of the physical test.
        retraction: settings of retraction.
    """

    task: Task
    hold: HoldSettings
    retraction: RetractionSettings

    @property
    def shared(self) -> tuple[object, ...]:
        """The task, to which every configuration refers."""
        return (self.task,)

    def new_worker(self) -> "AttemptWorker":
        """Makes the worker of a process."""
        return AttemptWorker(self)

    def give_up(self, job: State, /) -> Attempt:
        """What becomes of a state that ended every process that worked on it."""
        unproved = Configuration(self.task, job, ContactManifold(self.task).error_m(job), None)
        return Attempt(None, trial_mjcf(unproved, settings=self.hold))


class AttemptWorker:
    """Makes a grasp of each state and tries it.

    Args:
        setup: what all attempts have in common.
    """

    def __init__(self, setup: AttemptSetup):
        self._setup = setup

    def work(self, state: State, /) -> Attempt:
        """Certifies a state, makes a grasp of it and puts that to the test.

        The state is that of the grasp's record (see `records.to_state`), whose rotation differs from the
        solver's by a rounding or two. So a resumed run, which has no other state, goes the same way bit by
        bit. It is certified here, once; what later steps need is handed on as values.
        """
        settings = self._setup.hold
        configuration = certify_state(ContactManifold(self._setup.task), state)
        made = make_grasp(configuration, settings=settings, retraction=self._setup.retraction)
        if isinstance(made, Refusal):
            is_clear = made.clearing is None or made.clearing.is_clear
            shown = made.configuration if is_clear else configuration
            return Attempt(made, trial_mjcf(shown, settings=settings))
        trial = try_hold(made, settings=settings, fingers=True, margin=True, agreement=True)
        made = trial.grasp
        mjcf = trial_mjcf(
            made.configuration,
            settings=settings,
            targets=made.squeeze.targets,
            pregrasp=made.approach.pregrasp,
            pads=made.squeeze.pads,
        )
        return Attempt(trial, mjcf)


def attempt_all(
    states: Sequence[State],
    setup: AttemptSetup,
    *,
    workers: int = 1,
    is_over: Callable[[], bool] = lambda: False,
    should_stop: Callable[[], bool] = lambda: False,
) -> Iterator[Attempt]:
    """Makes grasps of states and tries them; gives what became of each in their order, as soon as it is done.

    What comes out does not depend on the number of workers, unless a process is lost three times over the
    same state (see `AttemptSetup.give_up`).

    Args:
        states: on the contact manifold, as records have them.
        setup: task and settings.
        workers: number of processes; with 1, this one does it all.
        is_over: whether no state should be begun any more; those that were begun are finished.
        should_stop: whether those that were begun should be given up, too.
    """
    # Where the solver had to be compiled, so has the rest: once and here, not in every process at once.
    here = len(states) if workers == 1 or len(states) < 2 else 1 if compile_s() > 0.0 else 0
    done = 0
    for attempt in _alone(states[:here], setup, is_over, should_stop):
        done += 1
        yield attempt
    if here == done < len(states):
        yield from _together(states[here:], setup, workers, is_over, should_stop)


def _alone(
    states: Sequence[State],
    setup: AttemptSetup,
    is_over: Callable[[], bool],
    should_stop: Callable[[], bool],
) -> Iterator[Attempt]:
    worker = setup.new_worker()
    for state in states:
        if is_over() or should_stop():
            return
        try:
            with cancellable(should_stop):
                attempt = worker.work(state)
        except Cancelled:
            return
        yield attempt


def _together(
    states: Sequence[State],
    setup: AttemptSetup,
    workers: int,
    is_over: Callable[[], bool],
    should_stop: Callable[[], bool],
) -> Iterator[Attempt]:
    waiting: deque[Future[Attempt]] = deque()
    # Leaving the pool ends its processes, whatever they are at.
    with WorkerPool(setup, min(workers, len(states))) as pool:
        for state in states:
            if is_over() or should_stop():
                break
            waiting.append(pool.submit(state))
            if len(waiting) >= _AHEAD * workers:
                attempt = _first(waiting, is_over, should_stop)
                if attempt is None:
                    return
                yield attempt
        while waiting:
            attempt = _first(waiting, is_over, should_stop)
            if attempt is None:
                return
            yield attempt


def _first(
    waiting: "deque[Future[Attempt]]", is_over: Callable[[], bool], should_stop: Callable[[], bool]
) -> Attempt | None:
    """Waits for the first of those that wait; None where it is not to be finished."""
    first = waiting.popleft()
    while not should_stop():
        if is_over():
            # From the last one on, so that none takes the place of one that is called off.
            for later in reversed(waiting):
                later.cancel()
            if first.cancel():
                return None
        try:
            return first.result(timeout=_GLANCE_S)
        except FutureTimeout:
            continue
        except CancelledError:
            return None
    return None
