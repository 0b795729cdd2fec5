"""A configuration: a state of hand and object at which the contacts of a task hold."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...base.numeric.arrays import Array
from ...base.text.notebook import html_table
from ...objects import Task
from .manifold import ContactManifold, ContactPoint
from .state import State

__all__ = ["Certificate", "Configuration", "configurations_html"]


@dataclass(frozen=True, eq=False, repr=False)
class Certificate:
    """Evidence of existence: the exact equations have a true solution inside this box.

    Attributes:
        names: variables of the polynomial system.
        lower: (n,) lower ends of the box.
        upper: (n,) upper ends of the box.
        fixed: names of the variables held at their value, the rest being a square system.
        opposed_within_rad: (n_contacts,) the normals of the solution fail to be opposed by no more than this;
            0 where they are exactly opposed.
    """

    names: tuple[str, ...]
    lower: Array
    upper: Array
    fixed: tuple[str, ...]
    opposed_within_rad: tuple[float, ...]

    def __repr__(self) -> str:
        return f"<Certificate: a solution within {self.radius:.1e} in {len(self.names)} variables>"

    @property
    def radius(self) -> float:
        """Half the widest side of the box."""
        return float(0.5 * np.max(self.upper - self.lower, initial=0.0))


@dataclass(frozen=True, eq=False, repr=False)
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

    def __str__(self) -> str:
        proof = self.certificate
        proved = "not certified" if proof is None else f"certified within {proof.radius:.1e}"
        return f"configuration of {self.task.name}: {proved}, residual {self.residual_m:.1e} m"

    def __repr__(self) -> str:
        return f"<Configuration of {self.task.name}, {'certified' if self.certified else 'not certified'}>"

    def _repr_html_(self) -> str:
        return html_table(str(self), ("joint", "position (rad, m)"), self.joints.items())

    @property
    def certified(self) -> bool:
        """Whether a true solution is proved to lie at this state, within the certificate's radius."""
        return self.certificate is not None

    @cached_property
    def joint_vector(self) -> Array:
        """Positions (n_joints,) of all joints, coupled ones included."""
        return self.task.hand.expand(self.state.q)

    @property
    def joints(self) -> dict[str, float]:
        """Positions of all joints by name, coupled ones included, in rad, of sliding ones in m."""
        return dict(zip(self.task.hand.joint_names, self.joint_vector.tolist(), strict=True))

    @cached_property
    def contact_points(self) -> tuple[ContactPoint, ...]:
        """The contacts in the palm frame, in the order of the task."""
        return tuple(ContactManifold(self.task).contact_points(self.state))


def configurations_html(title: str, configurations: Sequence[Configuration]) -> str:
    """A table of configurations, a row each.

    Args:
        title: what stands above it.
        configurations: of one task.
    """
    rows = [
        (number, "yes" if c.certified else "no", c.residual_m, c.certificate.radius if c.certificate else "")
        for number, c in enumerate(configurations)
    ]
    return html_table(title, ("number", "certified", "residual (m)", "certified radius"), rows)
