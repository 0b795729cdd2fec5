"""Existence of a true solution of a task's equations at a state."""

from dataclasses import replace
from functools import lru_cache

import numpy as np

from ...base.numeric.arrays import Array
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
    """Refines and certifies states of one task.

    Where the task leaves normals room, exactly opposed ones are tried first. Where these can't be proved, for
    alignments of flats depend on each other, the other equations are, and the room is kept over the box.
    """

    def __init__(self, task: Task):
        self.task = task
        self.manifold = ContactManifold(task)
        self.formulation: Formulation = formulate(task)
        self._test = ExistenceTest(StraightLineProgram(self.formulation.system))
        self._exact = TaskCertifier(task.aligned_exactly()) if task.has_room else None

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
        near = self.manifold.align(near) if near is not None else None
        configuration = self._certified(near or state)
        return configuration or Configuration(self.task, state, residual, None)

    def _certified(self, state: State) -> Configuration | None:
        """The configuration at a state, if it can be certified."""
        exact = self._exact._certified(state) if self._exact is not None else None
        if exact is not None and exact.certificate is not None:
            certificate = self._with_room(exact.certificate)
            refined = exact.state
        else:
            proved = self._test.prove(self.formulation.inputs_from_state(state))
            if proved is None:
                return None
            refined = self.formulation.state_from_inputs(proved.middle, state.q)
            names = self.formulation.system.names
            held = tuple(names[i] for i in proved.held)
            certificate = Certificate(
                names, proved.lower, proved.upper, held, self.opposed_within(proved.lower, proved.upper)
            )
        if np.abs(refined.p_palm_object - state.p_palm_object).max() > _NEARBY_M:
            return None
        return Configuration(self.task, refined, self.manifold.error_m(refined), certificate)

    def _with_room(self, exact: Certificate) -> Certificate:
        """A certificate of exactly opposed normals in the variables of this task's system."""
        number = {name: i for i, name in enumerate(exact.names)}
        system = self.formulation.system
        at = [number[system.names[i]] for i in system.inputs]
        lower, upper = system.lower.copy(), system.upper.copy()
        lower[system.inputs], upper[system.inputs] = exact.lower[at], exact.upper[at]
        around = self._test.program.enclose(lower, upper)
        return replace(exact, names=system.names, lower=around.lower, upper=around.upper)

    def opposed_within(self, lower: Array, upper: Array) -> tuple[float, ...]:
        """Angles (rad) by which normals fail to be opposed at most, over a box (n,) that keeps their room."""
        out = []
        for contact, sines in zip(self.task.contacts, self.formulation.sines, strict=True):
            most = np.maximum(np.abs(lower[sines]), np.abs(upper[sines]))
            angle = float(np.arcsin(min(1.0, float(np.sqrt(most @ most))))) * (1.0 + 1e-12)
            out.append(min(angle, contact.align_within_rad))
        return tuple(out)


@lru_cache(maxsize=8)
def _certifier(task: Task) -> TaskCertifier:
    """Formulating takes longer than certifying, and a task is certified many times in a run."""
    return TaskCertifier(task)


def certify_state(manifold: ContactManifold, state: State) -> Configuration:
    """Refines a state that nearly solves its task and tries to prove a true solution there."""
    return _certifier(manifold.task).certify(state)
