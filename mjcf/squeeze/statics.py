"""Statics of a grasp: what forces at its contacts do to the object and to the joints.

A soft-finger contact carries four numbers (f_n, f_1, f_2, tau): the force on the object along its inward
normal, along two tangents, in N, and the torque on it about the inward normal, in N m. Stacked over the
contacts they make a vector of size 4 n.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...arrays import Array
from ...geometry import perpendicular
from ...hands import Hand, jacobian_from_axes, joint_axes
from ...solver import Configuration
from ..model import checked_settings, payload
from ..settings import HoldSettings

__all__ = [
    "ARM_M",
    "WRENCH_SCALE",
    "PointContact",
    "Statics",
    "contact_efforts",
    "contact_statics",
    "grasp_statics",
    "servo_limits",
    "task_contacts",
]

ARM_M = 0.01
"""Torques count as forces at this arm where both are in one row or one sum."""
# Makes a wrench in N and N m one in N.
WRENCH_SCALE = np.array([1.0, 1.0, 1.0, 1.0 / ARM_M, 1.0 / ARM_M, 1.0 / ARM_M])


@dataclass(frozen=True, eq=False)
class PointContact:
    """A place where a link touches the object, in the palm frame.

    Attributes:
        link: index of the link.
        p_hand: point (3,) of the link in m.
        p_object: point (3,) of the object in m.
        inward: unit normal (3,) into the object.
    """

    link: int
    p_hand: Array
    p_object: Array
    inward: Array

    def moved(self, shift_m: Array) -> "PointContact":
        """The same elsewhere, by (3,) in m."""
        return replace(self, p_hand=self.p_hand + shift_m, p_object=self.p_object + shift_m)


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


def task_contacts(configuration: Configuration) -> list[PointContact]:
    """Where the contacts of the task are."""
    pairs = zip(configuration.task.contacts, configuration.contact_points, strict=True)
    return [
        PointContact(contact.hand.link, point.p_hand, point.p_object, -point.n_object)
        for contact, point in pairs
    ]


def grasp_statics(configuration: Configuration, settings: HoldSettings | None = None) -> Statics:
    """The statics of a configuration's contacts, with the object that the settings make the hand carry.

    Args:
        configuration: the grasp.
        settings: which object the hand carries; None takes the defaults.
    """
    return contact_statics(configuration, checked_settings(settings), task_contacts(configuration))


def contact_statics(
    configuration: Configuration, settings: HoldSettings, contacts: Sequence[PointContact]
) -> Statics:
    """The statics of a configuration that touches the object at `contacts`, at least one."""
    hand, state = configuration.task.hand, configuration.state
    obj = payload(configuration.task, settings)
    centre = state.R_palm_object @ obj.inertia.centre + state.p_palm_object
    _, origins, directions = joint_axes(hand, configuration.joint_vector)
    frames, G, T = [], [], []
    for contact in contacts:
        frame = np.vstack([contact.inward, perpendicular(contact.inward)])
        G.append(_wrenches(frame, contact.p_object - centre))
        T.append(contact_efforts(hand, (origins, directions), contact.link, contact.p_hand, frame))
        frames.append(frame)
    stiffness, effort = servo_limits(hand)
    return Statics(
        points=np.array([contact.p_object for contact in contacts]),
        frames=np.array(frames),
        G=np.column_stack(G),
        T=np.column_stack(T),
        stiffness=stiffness,
        effort=effort,
        centre=centre,
        mass=obj.inertia.mass,
    )


def contact_efforts(hand: Hand, axes: tuple[Array, Array], link: int, point: Array, frame: Array) -> Array:
    """Columns (n_independent, 4) of one contact in `Statics.T`.

    Args:
        hand: the hand.
        axes: origins and directions of its joints, as `joint_axes` has them.
        link: which link touches.
        point: where (3,), in the palm frame, in m.
        frame: (3, 3) inward normal and tangents as rows.
    """
    J_p, J_w = jacobian_from_axes(hand, *axes, link, point)
    return hand.coupling_matrix.T @ np.column_stack([J_p.T @ frame.T, J_w.T @ frame[0]])


def servo_limits(hand: Hand) -> tuple[Array, Array]:
    """Servo gains and largest efforts of the independent joints, as `Statics` has them."""
    servos = [hand.axes[i].actuator for i in hand.independent]
    stiffness = np.array([servo.stiffness for servo in servos if servo is not None])
    return stiffness, np.array([servo.effort for servo in servos if servo is not None])


def _wrenches(frame: Array, arm: Array) -> Array:
    """Columns (6, 4) of one contact: forces along the rows of `frame` at `arm` (3,), torque about normal."""
    forces = np.vstack([frame.T, np.cross(arm, frame).T])
    torque = np.concatenate([np.zeros(3), frame[0]])
    return np.column_stack([forces, torque])
