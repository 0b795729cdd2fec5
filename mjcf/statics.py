"""Statics of a grasp: what forces at its contacts do to the object and to the joints.

A soft-finger contact carries four numbers (f_n, f_1, f_2, tau): the force on the object along its inward
normal, along two tangents, in N, and the torque on it about the inward normal, in N m. Stacked over the
contacts they make a vector of size 4 n.
"""

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from ..geometry.transforms import perpendicular
from ..hands.kinematics import jacobian_from_axes, joint_axes
from ..solver import Configuration
from .carried import carried_object
from .settings import HoldSettings

__all__ = ["Statics", "grasp_statics"]

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Statics:
    """Linear maps of a grasp, in the palm frame.

    Attributes:
        points: contact points (n, 3) in m.
        frames: (n, 3, 3), one contact's inward normal and tangents as rows.
        G: grasp matrix (6, 4 n): contact vector to force (N) and torque about the centre of mass (N m).
        T: (n_independent, 4 n): contact vector to the efforts (N m or N) with which the independent joints
            must press to bring it about; coupled joints pass their share on to the joint that drives them.
        stiffness: servo gains (n_independent,) in N m/rad or N/m.
        effort: largest efforts (n_independent,) in N m or N.
        centre: centre of mass (3,) of the object in m.
        mass: of the object, in kg.
    """

    points: Array
    frames: Array
    G: Array
    T: Array
    stiffness: Array
    effort: Array
    centre: Array
    mass: float

    @property
    def n_contacts(self) -> int:
        """Number of contacts."""
        return len(self.points)

    def forces(self, contact_vector: Array) -> Array:
        """Forces (n, 3) on the object in N, in the palm frame."""
        f = contact_vector.reshape(-1, 4)[:, :3]
        return np.einsum("ik,ikx->ix", f, self.frames)


def grasp_statics(
    configuration: Configuration, settings: HoldSettings | None = None, *, shifts_m: Array | None = None
) -> Statics:
    """The statics of a configuration's contacts, with the object that the settings make the hand carry.

    Args:
        configuration: the grasp.
        settings: which object the hand carries; None takes the defaults.
        shifts_m: (k, 3) in the palm frame; every contact then stands k times in the result, one after the
            other, each time moved by one of them with its normal as it is. None is one without a shift.
    """
    hand, state = configuration.task.hand, configuration.state
    obj = carried_object(configuration.task, settings or HoldSettings())
    centre = state.R_palm_object @ obj.inertia.centre + state.p_palm_object
    _, origins, directions = joint_axes(hand, configuration.joint_vector)
    points, frames, G, T = [], [], [], []
    touching = zip(configuration.task.contacts, configuration.contact_points, strict=True)
    for (contact, point), shift in product(touching, np.zeros((1, 3)) if shifts_m is None else shifts_m):
        inward = -point.n_object
        frame = np.vstack([inward, perpendicular(inward)])
        J_p, J_w = jacobian_from_axes(hand, origins, directions, contact.hand.link, point.p_hand + shift)
        G.append(_wrenches(frame, point.p_object + shift - centre))
        T.append(hand.coupling_matrix.T @ np.column_stack([J_p.T @ frame.T, J_w.T @ inward]))
        points.append(point.p_object + shift)
        frames.append(frame)
    servos = [hand.axes[i].actuator for i in hand.independent]
    return Statics(
        np.array(points),
        np.array(frames),
        np.column_stack(G),
        np.column_stack(T),
        np.array([servo.stiffness for servo in servos if servo is not None]),
        np.array([servo.effort for servo in servos if servo is not None]),
        centre,
        obj.inertia.mass,
    )


def _wrenches(frame: Array, arm: Array) -> Array:
    """Columns (6, 4) of one contact: forces along the rows of `frame` at `arm` (3,), torque about normal."""
    forces = np.vstack([frame.T, np.cross(arm, frame).T])
    torque = np.concatenate([np.zeros(3), frame[0]])
    return np.column_stack([forces, torque])
