"""The compact formulation of a configuration problem (the default).

Unknowns are (cos, sin) of the joint angles of those fingers that have a contact, or such an angle itself
where others follow it by no small fraction, the object's rotation matrix and the parameters of Bezier
patches. The object's position follows from the first contact; for every other one, the object turns the
difference of the two contacts in its frame into that in the palm frame. Links are placed by
`link_frames.py`, contacts by `contact_equations.py`. Lengths are in units of `UNIT_M`.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...base.numeric.arrays import Array, Indices
from ...objects import Task
from ..contacts import ContactManifold, State
from ..enclosure import StraightLineProgram
from ..polynomial import PolynomialSystem, SystemBuilder, Vector, constant_vector, presolve
from .contact_equations import ContactSides, add_contact, keep_together
from .link_frames import ChainBuilder
from .object_axes import in_axes, working_axes
from .object_pose import free_rotation, hold_at, place
from .region_equations import UNIT_M, FillDependent, index_of
from .to_state import InputTables, put_state

__all__ = ["UNIT_M", "Formulation", "formulate"]


@dataclass(frozen=True, eq=False)
class Formulation:
    """A task as a polynomial system, with the way there and back.

    Attributes:
        task: the task.
        system: the polynomial system; its inputs are listed in the attributes below.
        angle_inputs: independent joint -> (index of cosine, index of sine) of its angle by its divisor.
        divisors: independent joint -> whole number; above 1 where joints follow it by a fraction.
        turn_inputs: independent joint -> index of its angle itself, which others follow by any ratio.
        slide_inputs: independent joint -> index.
        axes: (3, 3) in rows, the axes of the object in which its contacts are written.
        rotation_inputs: (6,) indices of the first two axes in the palm frame; none if the object is fixed.
        position: (3,) indices of the object's position, which contacts define; likewise.
        param_inputs: (n_params,) indices of the patch parameters, in the order of `State.params`.
        sines: contact by contact, indices of the variables whose squares add up to that of the sine between
            the normals, at most; none where normals have no room.
        fillers: fill the inputs that follow from the others at a state, normals of caps and curved patches.
    """

    task: Task
    system: PolynomialSystem
    angle_inputs: dict[int, tuple[int, int]]
    divisors: dict[int, int]
    turn_inputs: dict[int, int]
    slide_inputs: dict[int, int]
    axes: Array
    rotation_inputs: Indices
    position: Indices
    param_inputs: Indices
    sines: tuple[Indices, ...]
    fillers: tuple[FillDependent, ...]

    def inputs_from_state(self, state: State) -> Array:
        """A vector (n,) of the system with the inputs of `state` filled in."""
        x = np.zeros(self.system.size)
        for j, (c, s) in self.angle_inputs.items():
            angle = state.q[j] / self.divisors[j]
            x[c], x[s] = np.cos(angle), np.sin(angle)
        for j, turn in self.turn_inputs.items():
            x[turn] = state.q[j]
        for j, slide in self.slide_inputs.items():
            x[slide] = state.q[j] / UNIT_M
        if self.task.T_palm_object is None:
            x[self.rotation_inputs] = (self.axes[:2] @ state.R_palm_object.T).ravel()
        x[self.param_inputs] = state.params
        points = self._manifold.contact_points(state) if self.fillers else []
        for fill in self.fillers:
            fill(x, state, points)
        return x

    def state_from_inputs(self, x: Array, q_free: Array) -> State:
        """The state at a vector (n,) of the system; `q_free` (n_independent,) fills the other joints."""
        x = self._program.complete(x)  # the object's position is defined by the contacts
        q, params = np.array(q_free, dtype=float), np.empty(len(self.param_inputs))
        T = np.eye(4) if self.task.T_palm_object is None else self.task.T_palm_object
        R, p = T[:3, :3].copy(), T[:3, 3].copy()
        put_state(self._input_tables, x, q, R, p, params)
        return State(q, R, p, params)

    @cached_property
    def _program(self) -> StraightLineProgram:
        return StraightLineProgram(self.system)

    @cached_property
    def _manifold(self) -> ContactManifold:
        return ContactManifold(self.task)

    @cached_property
    def _input_tables(self) -> InputTables:
        angles = np.array(list(self.angle_inputs.values()), dtype=np.int64).reshape(-1, 2)
        return InputTables(
            joints=np.array(list(self.angle_inputs), dtype=np.int64),
            divisors=np.array([self.divisors[j] for j in self.angle_inputs], dtype=float),
            cosines=angles[:, 0].copy(),
            sines=angles[:, 1].copy(),
            direct=np.array([*self.slide_inputs, *self.turn_inputs], dtype=np.int64),
            direct_inputs=np.array([*self.slide_inputs.values(), *self.turn_inputs.values()], dtype=np.int64),
            direct_units=np.array([UNIT_M] * len(self.slide_inputs) + [1.0] * len(self.turn_inputs)),
            axes=self.axes,
            rotation=np.array(self.rotation_inputs, dtype=np.int64),
            position=np.array(self.position, dtype=np.int64),
            params=np.array(self.param_inputs, dtype=np.int64),
            lower=self.task.limits[:, 0].copy(),
            upper=self.task.limits[:, 1].copy(),
            unit_m=UNIT_M,
        )


def formulate(task: Task) -> Formulation:
    """Writes a task as a polynomial system."""
    formulation = _formulate(task, bends_fixed=True)
    is_fixed = task.limits[:, 0] == task.limits[:, 1]
    if is_fixed.any() and formulation.system.is_overdetermined:
        # Equations that have to hold of given numbers do so up to rounding only: joints need their room.
        return _formulate(task, bends_fixed=False)
    return formulation


def _formulate(task: Task, *, bends_fixed: bool) -> Formulation:
    builder = SystemBuilder()
    chain = ChainBuilder(builder, task.hand, task.limits, UNIT_M, bends_fixed=bends_fixed)
    frames = [chain.frame(contact.hand.link) for contact in task.contacts]
    first = len(builder.names)
    is_free = task.T_palm_object is None
    axes = working_axes(task)
    R = free_rotation(builder) if is_free else _fixed_rotation(task)
    sides = [
        add_contact(builder, k, in_axes(contact, axes), frame, R)
        for k, (contact, frame) in enumerate(zip(task.contacts, frames, strict=True))
    ]
    position = place(builder, R, sides[0]) if is_free else _hold(builder, task, R, sides)
    for a in range(len(sides)):
        for b in range(a + 1, len(sides)):
            decides = is_free and a == 0
            keep_together(builder, f"contacts {a} {b}", sides[a], sides[b], R, decides=decides)
    return Formulation(
        task,
        presolve(builder.build()),
        {j: (index_of(a.cos), index_of(a.sin)) for j, a in chain.angles.items()},
        chain.divisors,
        {j: index_of(v) for j, v in chain.turns.items()},
        {j: index_of(v) for j, v in chain.slides.items()},
        axes,
        np.arange(first, first + 6 * is_free),
        np.array(position, dtype=np.int64),
        np.array([i for side in sides for i in side.params], dtype=np.int64),
        tuple(np.array(side.sines, dtype=np.int64) for side in sides),
        tuple(fill for side in sides for fill in side.fillers),
    )


def _fixed_rotation(task: Task) -> list[Vector]:
    """Columns of a fixed object's rotation."""
    assert task.T_palm_object is not None
    return [constant_vector(column) for column in task.T_palm_object[:3, :3].T]


def _hold(builder: SystemBuilder, task: Task, R: list[Vector], sides: list[ContactSides]) -> list[int]:
    """Every contact of a fixed object is where its pose has it; its position is no variable."""
    assert task.T_palm_object is not None
    for side in sides:
        hold_at(builder, R, constant_vector(task.T_palm_object[:3, 3] / UNIT_M), side)
    return []
