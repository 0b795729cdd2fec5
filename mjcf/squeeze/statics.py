"""Statics of a grasp: what forces at its contacts do to the object and to the joints.

A soft-finger contact carries four numbers (f_n, f_1, f_2, tau): the force on the object along its inward
normal, along two tangents, in N, and the torque on it about the inward normal, in N m. Stacked over the
contacts they make a vector of size 4 n.

Where two surfaces meet over an area, the force may be centred anywhere in it: the contact then has further
force points around its own (`ForcePoints`), each with four numbers and a cone of its own, so that m >= n
points make a vector of size 4 m. The first n are those of the contacts.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...base.numeric.arrays import Array, Indices
from ...geometry import perpendicular
from ...hands import Hand, jacobian_from_axes, joint_axes
from ...solver import Configuration
from ..model import checked_settings, payload
from ..settings import HoldSettings

__all__ = [
    "ARM_M",
    "WRENCH_SCALE",
    "ForcePoints",
    "PointContact",
    "Statics",
    "contact_efforts",
    "contact_statics",
    "grasp_statics",
    "servo_limits",
    "spread_out",
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
class ForcePoints:
    """Where forces act on n contacts.

    Attributes:
        contact: (m,) which contact each of m points belongs to: 0, ..., n - 1, then those of wide contacts.
        offsets_m: (m, 2) from the contact's point along its tangents, in m; zero for the first n, except
            where these stand for centres of pressure.
    """

    contact: Indices
    offsets_m: Array

    @classmethod
    def at_contacts(cls, n_contacts: int) -> "ForcePoints":
        """Each contact's own point alone."""
        return cls(np.arange(n_contacts), np.zeros((n_contacts, 2)))

    @property
    def n_contacts(self) -> int:
        """Number of contacts."""
        return int(self.contact.max()) + 1

    def resultants(self, vectors: Array) -> tuple[Array, Array]:
        """What forces at the points come to, each contact's at the centre of its pressure.

        Normals of a contact are parallel, so this has the wrench of the forces it stands for.

        Args:
            vectors: contact vectors (k, m, 4).

        Returns:
            Contact vectors (k, n, 4), and where the centres are (k, n, 2), along the tangents, in m.
        """
        n = self.n_contacts
        summed, centres_m = np.zeros((len(vectors), n, 4)), np.zeros((len(vectors), n, 2))
        for i in range(n):
            mine = self.contact == i
            f, at_m = vectors[:, mine], self.offsets_m[mine]
            total = f.sum(axis=1)
            pressed = np.maximum(total[:, :1], 1e-12)
            centre_m = (f[..., 0, None] * at_m).sum(axis=1) / pressed
            arms_m = at_m - centre_m[:, None]
            # The torque about the normal of tangential forces that act beside the centre.
            total[:, 3] += (arms_m[..., 0] * f[..., 2] - arms_m[..., 1] * f[..., 1]).sum(axis=1)
            summed[:, i], centres_m[:, i] = total, centre_m
        return summed, centres_m


@dataclass(frozen=True, eq=False)
class Statics:
    """Linear maps of a grasp, in the palm frame.

    Attributes:
        points: force points (m, 3) in m, those of the contacts first.
        frames: (m, 3, 3), at each point the inward normal of its contact and tangents as rows.
        G: grasp matrix (6, 4 m): contact vector to force (N) and torque about the centre of mass (N m).
        T: (n_independent, 4 m): contact vector to the efforts (N m or N) with which the independent joints
            must press to bring it about; coupled joints pass their share on to the joint that drives them.
        stiffness: servo gains (n_independent,) in N m/rad or N/m.
        effort: largest efforts (n_independent,) in N m or N.
        centre: centre of mass (3,) of the object in m.
        mass: of the object, in kg.
        force_points: which contact each point belongs to, and where on it.
    """

    points: Array
    frames: Array
    G: Array
    T: Array
    stiffness: Array
    effort: Array
    centre: Array
    mass: float
    force_points: ForcePoints

    @property
    def n_contacts(self) -> int:
        """Number of contacts."""
        return self.force_points.n_contacts

    @property
    def by_contact(self) -> Array:
        """(n, m) 1 where a force point belongs to a contact, else 0."""
        return (self.force_points.contact == np.arange(self.n_contacts)[:, None]).astype(float)


def task_contacts(configuration: Configuration) -> list[PointContact]:
    """Where the contacts of the task are."""
    pairs = zip(configuration.task.contacts, configuration.contact_points, strict=True)
    return [
        PointContact(contact.hand.link, point.p_hand, point.p_object, -point.n_object)
        for contact, point in pairs
    ]


def grasp_statics(
    configuration: Configuration,
    settings: HoldSettings | None = None,
    points: ForcePoints | None = None,
) -> Statics:
    """The statics of a configuration's contacts, with the object that the settings make the hand carry.

    Args:
        configuration: the grasp.
        settings: which object the hand carries; None takes the defaults.
        points: where forces act; None for the contacts alone (see `ContactPads.force_points`).
    """
    return contact_statics(configuration, checked_settings(settings), task_contacts(configuration), points)


def contact_statics(
    configuration: Configuration,
    settings: HoldSettings,
    contacts: Sequence[PointContact],
    points: ForcePoints | None = None,
) -> Statics:
    """The statics of a configuration that touches the object at `contacts`, at least one.

    Args:
        configuration: the grasp.
        settings: which object the hand carries.
        contacts: where it touches.
        points: where forces act on these; None for the contacts alone.
    """
    hand, state = configuration.task.hand, configuration.state
    obj = payload(configuration.task, settings)
    centre = state.R_palm_object @ obj.inertia.centre + state.p_palm_object
    axes = joint_axes(hand, configuration.joint_vector)[1:]
    points = points or ForcePoints.at_contacts(len(contacts))
    spread = spread_out(contacts, points)
    frames, G, T = [], [], []
    for contact in spread:
        frame = np.vstack([contact.inward, perpendicular(contact.inward)])
        G.append(_wrenches(frame, contact.p_object - centre))
        T.append(contact_efforts(hand, axes, contact.link, contact.p_hand, frame))
        frames.append(frame)
    stiffness, effort = servo_limits(hand)
    return Statics(
        points=np.array([contact.p_object for contact in spread]),
        frames=np.array(frames),
        G=np.column_stack(G),
        T=np.column_stack(T),
        stiffness=stiffness,
        effort=effort,
        centre=centre,
        mass=obj.inertia.mass,
        force_points=points,
    )


def spread_out(contacts: Sequence[PointContact], points: ForcePoints) -> list[PointContact]:
    """Where forces act on contacts: on each by itself, and then on wide ones at points around it."""
    pairs = zip(points.contact.tolist(), points.offsets_m, strict=True)
    return [
        contacts[i].moved(offset_m @ perpendicular(contacts[i].inward)) if offset_m.any() else contacts[i]
        for i, offset_m in pairs
    ]


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
