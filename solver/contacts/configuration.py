"""A configuration: a state of hand and object at which the contacts of a task hold."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...arrays import Array
from ...objects import Task
from .manifold import ContactManifold, ContactPoint
from .state import State

__all__ = ["Certificate", "Configuration"]


@dataclass(frozen=True, eq=False)
class Certificate:
    """Evidence of existence: the exact equations have a true solution inside this box.

    Attributes:
        names: variables of the polynomial system.
        lower: (n,) lower ends of the box.
        upper: (n,) upper ends of the box.
        fixed: names of the variables held at their value, the rest being a square system.
    """

    names: tuple[str, ...]
    lower: Array
    upper: Array
    fixed: tuple[str, ...]

    @property
    def radius(self) -> float:
        """Half the widest side of the box."""
        return float(0.5 * np.max(self.upper - self.lower))


@dataclass(frozen=True, eq=False)
class Configuration:
    """A state that solves a task, to rounding.

    Attributes:
        task: the task.
        state: joints, object pose and contact parameters.
        residual_m: largest absolute value of the contact equations.
        certificate: the existence proof, None where none was found.
    """

    task: Task
    state: State
    residual_m: float
    certificate: Certificate | None

    @property
    def certified(self) -> bool:
        """Whether a true solution is proved to lie at this state, within the certificate's radius."""
        return self.certificate is not None

    @cached_property
    def joint_vector(self) -> Array:
        """Positions (n_joints,) of all joints, coupled ones included."""
        return self.task.hand.expand(self.state.q)

    @cached_property
    def contact_points(self) -> tuple[ContactPoint, ...]:
        """The contacts in the palm frame, in the order of the task."""
        return tuple(ContactManifold(self.task).contact_points(self.state))
