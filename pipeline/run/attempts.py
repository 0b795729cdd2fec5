"""Grasps made of configurations and put to the test, one by one in this process or in several."""

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future
from dataclasses import dataclass

from ...grasping import Refusal, Trial, make_grasp, try_hold
from ...mjcf import HoldSettings, trial_mjcf
from ...objects import Task
from ...retraction import RetractionSettings
from ...solver import Configuration, ContactManifold, State, certify_state
from ...workers import WorkerPool

__all__ = ["Attempt", "AttemptSetup", "AttemptWorker", "attempt_all"]

# Jobs that are handed out ahead of those whose turn it is, by worker: none of them waits for long.
_AHEAD = 2


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
        trial = try_hold(made, settings=settings, margin=True, agreement=True)
        mjcf = trial_mjcf(
            made.configuration,
            settings=settings,
            targets=made.squeeze.targets,
            pregrasp=made.approach.pregrasp,
        )
        return Attempt(trial, mjcf)


def attempt_all(
    states: Sequence[State], setup: AttemptSetup, *, workers: int = 1, should_stop: Callable[[], bool]
) -> Iterator[Attempt]:
    """Makes grasps of states and tries them; gives what became of each in their order, as soon as it is done.

    What comes out does not depend on the number of workers, unless a process is lost three times over the
    same state (see `AttemptSetup.give_up`).

    Args:
        states: on the contact manifold, as records have them.
        setup: task and settings.
        workers: number of processes; with 1, this one does it all.
        should_stop: looked at before each state is begun; those that were begun are finished.
    """
    if workers == 1 or len(states) < 2:
        worker = setup.new_worker()
        for state in states:
            if should_stop():
                return
            yield worker.work(state)
        return
    with WorkerPool(setup, min(workers, len(states))) as pool:
        waiting: deque[Future[Attempt]] = deque()
        for state in states:
            if should_stop():
                break
            waiting.append(pool.submit(state))
            if len(waiting) >= _AHEAD * workers:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()
