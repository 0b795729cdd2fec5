"""Between configurations and their written form."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from ...base.files.fields import Vector3
from ...base.text.significant import significant
from ...errors import InputError, UnknownName
from ...geometry import quaternion_from_rotation, rotation_from_quaternion
from ...objects import Task
from ...retraction import contact_gaps
from ...solver import Configuration, ContactManifold, State, certify_state
from .solution import Contact, ObjectPose, Solution

__all__ = ["as_written", "to_configuration", "to_solution", "to_state", "vector3"]

# Typed decimals of a limit or of a coupled joint may be off by a rounding.
_ANGLE_TOLERANCE = 1e-6
# A grasp whose contacts are farther apart was made for another task, or its numbers were changed.
_LARGEST_RESIDUAL_M = 1e-3


def to_solution(configuration: Configuration, identifier: str) -> Solution:
    """The written form of a configuration."""
    task, state = configuration.task, configuration.state
    certificate = configuration.certificate
    contacts = [
        Contact(
            hand=contact.hand.name,
            object=contact.object.name,
            point=vector3(point.p_object),
            normal=vector3(point.n_object),
            gap=gap_m,
            region_gap=point.gap_m,
            normal_angle=point.normal_angle_rad,
            opposed_within_deg=None
            if certificate is None
            else float(np.rad2deg(certificate.opposed_within_rad[k])),
        )
        for k, (contact, point, gap_m) in enumerate(
            zip(task.contacts, configuration.contact_points, contact_gaps(configuration), strict=True)
        )
    ]
    return Solution(
        id=identifier,
        joints=configuration.joints,
        object=_object_pose(state),
        parameters=state.params.tolist(),
        contacts=contacts,
        certified=configuration.certified,
        certified_radius=certificate.radius if certificate else None,
        residual=configuration.residual_m,
    )


def _object_pose(state: State) -> ObjectPose:
    """Pose of the object of a state."""
    quaternion = quaternion_from_rotation(state.R_palm_object).tolist()
    return ObjectPose(position=vector3(state.p_palm_object), quaternion=quaternion)


def as_written(state: State) -> State:
    """The state as its written form has it, whose rotation is rounded on its way through a quaternion."""
    R = rotation_from_quaternion(quaternion_from_rotation(state.R_palm_object))
    return replace(state, R_palm_object=R)


def vector3(array: ArrayLike) -> Vector3:
    """Three plain numbers."""
    x, y, z = np.asarray(array, dtype=float).tolist()
    return x, y, z


def to_state(solution: Solution, task: Task, source: str | Path) -> State:
    """The state that a written solution describes, as it is written: refining could make another grasp of it.

    Raises:
        InputError: joints that the hand does not have, that are missing or outside their limits, coupled
            joints that contradict their masters, a number of parameters that is not the task's, or contacts
            of the task that do not hold.
    """
    hand = task.hand
    for name in solution.joints:
        if name not in hand.joint_names:
            raise UnknownName(source, f"joints.{name}", f"joint of hand {hand.name}", name, hand.joint_names)
    missing = [name for name in hand.independent_names if name not in solution.joints]
    if missing:
        raise InputError(source, f"joints.{missing[0]}", "is required")
    q = np.array([solution.joints[name] for name in hand.independent_names])
    for name, position, (lower, upper) in zip(hand.independent_names, q, task.limits, strict=True):
        if not lower - _ANGLE_TOLERANCE <= position <= upper + _ANGLE_TOLERANCE:
            raise InputError(
                source, f"joints.{name}", f"must lie in [{lower:.6g}, {upper:.6g}], not {position:.6g}"
            )
    for name, position in zip(hand.joint_names, hand.expand(q), strict=True):
        if abs(solution.joints.get(name, position) - position) > _ANGLE_TOLERANCE:
            raise InputError(
                source, f"joints.{name}", f"is coupled to another joint and must be {position:.6g}"
            )
    manifold = ContactManifold(task)
    if len(solution.parameters) != manifold.n_params:
        raise InputError(
            source, "parameters", f"must be {manifold.n_params} numbers for task {task.name}, two a patch"
        )
    R = rotation_from_quaternion(np.array(solution.object.quaternion))
    state = State(q, R, np.array(solution.object.position), np.array(solution.parameters))
    residual_m = float(np.abs(manifold.residual(state)).max())
    if residual_m > _LARGEST_RESIDUAL_M:
        raise InputError(
            source,
            "joints",
            f"with this object pose the contacts of task {task.name} are up to "
            f"{significant(1e3 * residual_m, 3)} mm apart, not below {1e3 * _LARGEST_RESIDUAL_M:g} mm",
        )
    return state


def to_configuration(solution: Solution, task: Task, source: str | Path) -> Configuration:
    """The configuration that a written solution describes; its proof is made anew, not taken on trust.

    A rotation does not survive the way through its quaternion to the last bit, and a proof refines the state
    that it is given. So this is not the configuration that was written bit by bit, but the same for all who
    read it.

    Raises:
        InputError: as `to_state`.
    """
    return certify_state(ContactManifold(task), to_state(solution, task, source))
