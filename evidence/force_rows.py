"""What forces at the contacts must do, as linear rows in balls: balance a load within efforts and limits.

The unknowns are the forces F_i on the object at m force points, three numbers each in the palm frame in N,
and torques t_i on it about the contacts' inward normals, in N m: four numbers a point, all in one vector. So
only the rows depend on where points and normals truly are. The first n points are those of the contacts,
others lie beside them on wide ones (`WidePoint`).
"""

from dataclasses import dataclass

import numpy as np

from ..base.numeric.arrays import Array, Indices
from ..hands import Hand
from ..mjcf import HoldSettings
from ..objects import LiftTest, ObjectModel, PressTest, Task, TurnTest
from ..solver.interval import Balls
from .true_contacts import TrueContacts, TruePlaces

__all__ = ["ARM_M", "ForceRows", "force_rows"]

ARM_M = 0.01
"""Torques count as forces at this arm where both are in one norm."""


@dataclass(frozen=True, eq=False)
class ForceRows:
    """Rows for each of k loads, over all places of the contacts.

    Attributes:
        A: (rows, 4 m) of what must balance: 6 rows where the hand alone carries the object, 1 about a hinge,
            none where a stand takes up all.
        b: (k, rows) what A f must be.
        T: (n_independent, 4 m) efforts of the independent joints, in N m or N; coupled ones pass theirs on.
        effort: (n_independent,) the largest that the servos have.
        contact: (m,) which contact each force point belongs to.
        least: (m,) normal forces in N that are asked for.
        most: largest normal force in N of a contact that is allowed; infinite where there is no limit.
    """

    A: Balls
    b: Balls
    T: Balls
    effort: Array
    contact: Indices
    least: Array
    most: float


def force_rows(
    task: Task,
    settings: HoldSettings,
    carried: ObjectModel,
    at: TruePlaces,
    points: TrueContacts,
    contact: Indices,
) -> ForceRows:
    """The rows of a task's test.

    Args:
        task: the task.
        settings: gravity and its directions.
        carried: what the hand carries, with the mass that the test gives it.
        at: hand and object.
        points: m force points, those of the contacts first.
        contact: (m,) which contact each belongs to.
    """
    A, b = _balance(task, settings, carried, at, points)
    least = np.zeros(len(contact))
    if isinstance(task.test, PressTest):
        least[list(task.test.contacts)] = task.test.force_N
    effort = [task.hand.axes[i].actuator for i in task.hand.independent]
    most = task.max_normal_force_N
    return ForceRows(
        A,
        b,
        _efforts(task.hand, [task.contacts[i].hand.link for i in contact.tolist()], at, points),
        np.array([np.inf if servo is None else servo.effort for servo in effort]),
        contact,
        least,
        np.inf if most is None else most,
    )


def _balance(
    task: Task, settings: HoldSettings, carried: ObjectModel, at: TruePlaces, points: TrueContacts
) -> tuple[Balls, Balls]:
    match task.test:
        case LiftTest():
            centre = at.R @ carried.inertia.centre + at.p
            A = _wrenches(points, centre)
            weight = settings.gravity * Balls.exact(carried.inertia.mass) * np.array(settings.directions)
            zero = np.zeros((len(settings.directions), 3))
            return A, Balls(np.hstack([-weight.mid, zero]), np.hstack([weight.rad, zero]))
        case TurnTest():
            test = task.test
            hinge = at.R @ np.array(test.hinge_point) + at.p
            axis = at.R @ np.array(test.hinge_axis)
            row = axis @ (_wrenches(points, hinge)[3:])
            friction = Balls.exact(np.array([[test.friction_torque_Nm]]))
            return Balls(row.mid[None], row.rad[None]), friction / ARM_M
    return Balls.exact(np.zeros((0, 4 * points.inward.shape[0]))), Balls.exact(np.zeros((1, 0)))


def _wrenches(points: TrueContacts, centre: Balls) -> Balls:
    """Force in N and torque in N `ARM_M` about a point, (6, 4 m)."""
    n = points.inward.shape[0]
    mid, rad = np.zeros((6, n, 4)), np.zeros((6, n, 4))
    mid[:3, :, :3] = np.eye(3)[:, None]
    arms = (points.p_object - centre) / ARM_M
    for c in range(3):  # arm x force, a column for each of its coordinates
        moment = arms.cross(np.eye(3)[c])
        mid[3:, :, c], rad[3:, :, c] = moment.mid.T, moment.rad.T
    normals = points.inward / ARM_M
    mid[3:, :, 3], rad[3:, :, 3] = normals.mid.T, normals.rad.T
    return Balls(mid.reshape(6, 4 * n), rad.reshape(6, 4 * n))


def _efforts(hand: Hand, links: list[int], at: TruePlaces, points: TrueContacts) -> Balls:
    """Efforts (n_independent, 4 m) with which the joints bring forces about.

    The hand presses on the object with F at the point p, about the inward normal with t: a turning joint with
    axis a through o needs (a x (p - o)) . F + t a . n, a sliding one a . F.
    """
    n, n_joints = len(links), len(hand.axes)
    axes = at.links.directions
    slides = hand.tree.prismatic
    mid, rad = np.zeros((n_joints, n, 4)), np.zeros((n_joints, n, 4))
    for i, link in enumerate(links):
        lever = axes.cross(points.p_hand[i] - at.links.origins)
        spin = (axes * points.inward[i]).sum(axis=1)
        moves = hand.tree.moves[link]
        for which, along, about in ((moves & ~slides, lever, spin), (moves & slides, axes, None)):
            mid[which, i, :3], rad[which, i, :3] = along.mid[which], along.rad[which]
            if about is not None:
                mid[which, i, 3], rad[which, i, 3] = about.mid[which], about.rad[which]
    joints = Balls(mid.reshape(n_joints, 4 * n), rad.reshape(n_joints, 4 * n))
    return hand.coupling_matrix.T @ joints
