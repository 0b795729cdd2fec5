"""Existence of a true solution of a task's equations at a state."""

from functools import lru_cache

import numpy as np

from ...arrays import Array
from ...objects import Task
from ..certify import ExistenceTest, solve_in_box
from ..contacts import Certificate, Configuration, ContactManifold, State
from ..enclosure import StraightLineProgram
from ..formulate import Formulation, formulate

__all__ = ["TaskCertifier", "certify_state"]

# States that miss their contacts by less than this are moved onto them before they are tested.
_NEARLY_M = 1e-4
# The system has the object where the first contact has it; a solution that far from a state is not its own.
_NEARBY_M = 1e-2


class TaskCertifier:
    """Refines and certifies states of one task."""

    def __init__(self, task: Task):
        self.task = task
        self.manifold = ContactManifold(task)
        self.formulation: Formulation = formulate(task)
        self._test = ExistenceTest(StraightLineProgram(self.formulation.system))

    @property
    def q_free(self) -> Array:
        """Where joints of fingers without a contact rest: at zero, or at the limit next to it."""
        return np.clip(0.0, self.task.limits[:, 0], self.task.limits[:, 1])

    def solution_within(self, point: Array, lower: Array, upper: Array) -> Array | None:
        """A solution (n,) proved to lie in a box of the system, from a point of it; see `solve_in_box`."""
        proved = solve_in_box(self._test, point, lower, upper)
        return None if proved is None else proved.middle

    def certify(self, state: State) -> Configuration:
        """The configuration at `state`, refined; certified where the existence test succeeds."""
        residual = self.manifold.error_m(state)
        # Newton's method within the test knows no limits: it would push a joint that stands at one beyond it.
        near = self.manifold.project(state) if residual < _NEARLY_M else None
        proved = self._test.prove(self.formulation.inputs_from_state(near or state))
        if proved is None:
            return Configuration(self.task, state, residual, None)
        refined = self.formulation.state_from_inputs(proved.middle, state.q)
        if np.abs(refined.p_palm_object - state.p_palm_object).max() > _NEARBY_M:
            return Configuration(self.task, state, residual, None)
        names = self.formulation.system.names
        certificate = Certificate(names, proved.lower, proved.upper, tuple(names[i] for i in proved.held))
        return Configuration(self.task, refined, self.manifold.error_m(refined), certificate)


@lru_cache(maxsize=8)
def _certifier(task: Task) -> TaskCertifier:
    """Formulating takes longer than certifying, and a task is certified many times in a run."""
    return TaskCertifier(task)


def certify_state(manifold: ContactManifold, state: State) -> Configuration:
    """Refines a state that nearly solves its task and tries to prove a true solution there."""
    return _certifier(manifold.task).certify(state)
