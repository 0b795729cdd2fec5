"""The job that makes a grasp of a configuration and puts it to the test."""

from dataclasses import dataclass, replace

from ...grasping import ReadyGrasp, Refusal, Trial, make_grasp, try_hold
from ...mjcf import LoadLimit, trial_mjcf
from ...solver import Configuration, ContactManifold, State, certify_state
from ..records import as_written
from .crew import CrewSetup

__all__ = ["Attempt", "MadeOfState", "MakeState", "TryState"]


@dataclass(frozen=True, eq=False)
class Attempt:
    """What became of a state.

    Attributes:
        outcome: the trial of the grasp that was made of it, or why there is none; None where every process
            that worked on it was lost.
        mjcf: its model.
        limit: of a grasp that is not held: what keeps it from carrying the load by plan; None where nothing
            does, or no grasp is clear.
    """

    outcome: Trial | Refusal | None
    mjcf: str
    limit: LoadLimit | None = None


@dataclass(frozen=True, eq=False)
class MadeOfState:
    """A grasp that was made of a state, and is to be tried.

    Attributes:
        configuration: of the state itself.
        outcome: the grasp, or why there is none.
    """

    configuration: Configuration
    outcome: ReadyGrasp | Refusal


@dataclass(frozen=True, eq=False)
class MakeState:
    """Makes a grasp of a state, and does not try it.

    Attributes:
        state: see `TryState`.
    """

    state: State

    def work(self, setup: CrewSetup) -> MadeOfState | None:
        """Makes a grasp of the state."""
        return _made(self.state, setup)

    def given_up(self, setup: CrewSetup) -> MadeOfState | None:
        """Nothing was made."""
        return None


@dataclass(frozen=True, eq=False)
class TryState:
    """Makes a grasp of a state and tries it, for the verdict alone.

    Attributes:
        state: on the contact manifold, as records have them: that of the grasp's record (see
            `records.to_state`), whose rotation differs from the solver's by a rounding or two. So a resumed
            run, which has no other state, goes the same way bit by bit.
        made: what was made of it before; None where that is still to be done.
    """

    state: State
    made: MadeOfState | None = None

    def work(self, setup: CrewSetup) -> Attempt:
        """Makes a grasp of the state and puts that to the test."""
        settings = setup.hold
        ready = self.made or _made(self.state, setup)
        configuration, made = ready.configuration, ready.outcome
        if isinstance(made, Refusal):
            is_clear = made.clearing is None or made.clearing.is_clear
            shown = made.configuration if is_clear else configuration
            return Attempt(made, trial_mjcf(shown, settings=settings), made.limit)
        trial = try_hold(_where_written(made), settings=settings, fingers=True)
        limit = None if trial.held else trial.limit
        return Attempt(trial, trial.grasp.grasp.mjcf(settings), limit)

    def given_up(self, setup: CrewSetup) -> Attempt:
        """No outcome, and a model of the state."""
        error_m = ContactManifold(setup.task).error_m(self.state)
        return Attempt(
            None, trial_mjcf(Configuration(setup.task, self.state, error_m, None), settings=setup.hold)
        )


def _made(state: State, setup: CrewSetup) -> MadeOfState:
    """Certifies a state, once and here, and makes a grasp of it."""
    configuration = certify_state(ContactManifold(setup.task), state)
    made = make_grasp(configuration, settings=setup.hold, retraction=setup.retraction)
    return MadeOfState(configuration, made)


def _where_written(made: ReadyGrasp) -> ReadyGrasp:
    """The grasp where its record will have it, so that later tests of the record begin with the same bits."""
    configuration = replace(made.configuration, state=as_written(made.configuration.state))
    return replace(made, grasp=replace(made.grasp, configuration=configuration, known_approach=made.approach))
