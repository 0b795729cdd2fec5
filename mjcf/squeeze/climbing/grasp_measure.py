"""What measures of a grasp share: the linear program of a state of the contact manifold, found quickly."""

from dataclasses import dataclass
from typing import Protocol

from ....base.numeric.arrays import Array
from ....solver import Configuration, ContactManifold, State
from ...model import payload
from ...settings import HoldSettings
from ..contact_maps import contact_maps
from ..linear_program import Optimum
from ..load_program import LoadProgram, load_program
from ..pads import contact_pads
from ..statics import Statics, servo_limits

__all__ = ["GraspMeasure", "ProgramAt", "Strength"]

_CONE_SUBDIVISIONS = 1


@dataclass(frozen=True, eq=False)
class Strength:
    """How well a state could hold, and what the derivative of that needs.

    Attributes:
        state: the state.
        statics: linear maps of the grasp there.
        value: the more, the better; which measure it is of says in what.
        program: the linear program of the load there.
        balanced: whether the value was found in terms of `program`; not where it is the imbalance of forces
            without a load.
        optimum: of the linear program that gave the value; None in numerical trouble.
    """

    state: State
    statics: Statics
    value: float
    program: LoadProgram
    balanced: bool
    optimum: Optimum | None

    def is_like(self, other: "Strength") -> bool:
        """Whether both values come from linear programs of the same kind."""
        if self.optimum is None or other.optimum is None:
            return False
        return len(self.optimum.x) == len(other.optimum.x)


class GraspMeasure(Protocol):
    """How good a state is, and in which direction it gets better."""

    def at(self, state: State) -> Strength:
        """Value of a state."""
        ...

    def gradient(self, at: Strength) -> Array:
        """Derivative (n_tangent,) of the value."""
        ...


class ProgramAt:
    """The linear program of states near each other.

    Args:
        manifold: the contacts.
        settings: of the test.
        start: a state whose pads stand for those of the others, as patches change slowly.
    """

    def __init__(self, manifold: ContactManifold, settings: HoldSettings, start: State):
        self.manifold = manifold
        self.settings = settings
        self._mass = payload(manifold.task, settings).inertia
        self._stiffness, self._effort = servo_limits(manifold.task.hand)
        self.begin_at(start)

    def begin_at(self, start: State) -> None:
        """Goes on from another state, whose pads then count."""
        pads = contact_pads(Configuration(self.manifold.task, start, 0.0, None), self.settings)
        self._spin_arms_m = pads.spin_arms_m()
        self._points = pads.force_points()

    def __call__(self, state: State) -> tuple[Statics, LoadProgram]:
        """Statics and program of a state."""
        statics = self._statics(state)
        program = load_program(
            statics,
            self.manifold.task,
            state,
            self.settings,
            subdivisions=_CONE_SUBDIVISIONS,
            spin_arms_m=self._spin_arms_m,
        )
        return statics, program

    def _statics(self, state: State) -> Statics:
        """The same as `grasp_statics` of the state, in compiled loops."""
        where = (self._points.contact, self._points.offsets_m)
        maps = contact_maps(self.manifold.tables, *state.copies(), self._mass.centre, *where)
        return Statics(
            points=maps.points,
            frames=maps.frames,
            G=maps.G,
            T=maps.T,
            stiffness=self._stiffness,
            effort=self._effort,
            centre=state.R_palm_object @ self._mass.centre + state.p_palm_object,
            mass=self._mass.mass,
            force_points=self._points,
        )
