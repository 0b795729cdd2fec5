"""Between the solver's configurations and their written form."""

import os
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from ... import __version__
from ...errors import InputError, UnknownName
from ...fields import Vector3
from ...geometry import quaternion_from_rotation, rotation_from_quaternion
from ...hands import Hand
from ...objects import Task, load_task, split_reference, with_hand
from ...retraction import Approach
from ...solver import Configuration, ContactManifold, State, certify_state
from . import records
from .fingerprint import fingerprint
from .records import GraspFile, GraspRecord, Solution

__all__ = [
    "approach_record",
    "file_head",
    "load_grasp_task",
    "object_pose",
    "relative_source",
    "resolve_source",
    "to_approach",
    "to_configuration",
    "to_solution",
    "to_state",
    "updated",
    "vector3",
]

GraspT = TypeVar("GraspT", bound=GraspRecord)
# Typed decimals of a limit or of a coupled joint may be off by a rounding.
_ANGLE_TOLERANCE = 1e-6
# A grasp whose contacts are farther apart was made for another task, or its numbers were changed.
_LARGEST_RESIDUAL_M = 1e-3


def to_solution(configuration: Configuration, identifier: str) -> Solution:
    """The written form of a configuration."""
    task, state = configuration.task, configuration.state
    contacts = [
        records.Contact(
            hand=contact.hand.name,
            object=contact.object.name,
            point=vector3(point.p_object),
            normal=vector3(point.n_object),
            gap=point.gap_m,
            normal_angle=point.normal_angle_rad,
        )
        for contact, point in zip(task.contacts, configuration.contact_points, strict=True)
    ]
    certificate = configuration.certificate
    return Solution(
        id=identifier,
        joints=configuration.joints,
        object=object_pose(state),
        parameters=state.params.tolist(),
        contacts=contacts,
        certified=configuration.certified,
        certified_radius=certificate.radius if certificate else None,
        residual=configuration.residual_m,
    )


def approach_record(approach: Approach, hand: Hand) -> records.Approach:
    """The written form of an approach."""
    names = hand.independent_names
    return records.Approach(
        reachable=approach.reachable,
        opening=approach.opening_m,
        blocking=approach.blocking,
        waypoints=[dict(zip(names, q.tolist(), strict=True)) for q in approach.waypoints],
    )


def to_approach(record: records.Approach, hand: Hand) -> Approach:
    """The approach that this process or another one has just written; it is taken on trust."""
    waypoints = np.array([[place[name] for name in hand.independent_names] for place in record.waypoints])
    return Approach(record.reachable, record.opening, waypoints, record.blocking)


def object_pose(state: State) -> records.ObjectPose:
    """Pose of the object of a state."""
    quaternion = quaternion_from_rotation(state.R_palm_object).tolist()
    return records.ObjectPose(position=vector3(state.p_palm_object), quaternion=quaternion)


def vector3(array: ArrayLike) -> Vector3:
    """Three plain numbers."""
    x, y, z = np.asarray(array, dtype=float).tolist()
    return x, y, z


def to_state(solution: Solution, task: Task, source: str | Path) -> State:
    """The state that a written solution describes.

    Raises:
        InputError: joints that the hand does not have, that are missing or outside their limits, coupled
            joints that contradict their masters, or a number of parameters that is not the task's.
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
    return State(q, R, np.array(solution.object.position), np.array(solution.parameters))


def to_configuration(solution: Solution, task: Task, source: str | Path) -> Configuration:
    """The configuration that a written solution describes; its proof is made anew, not taken on trust.

    Raises:
        InputError: as `to_state`, and where the contacts of the task do not hold.
    """
    manifold, state = ContactManifold(task), to_state(solution, task, source)
    # As it is written: refining could make another grasp of it.
    residual_m = float(np.abs(manifold.residual(state)).max())
    if residual_m > _LARGEST_RESIDUAL_M:
        raise InputError(
            source,
            "joints",
            f"with this object pose the contacts of task {task.name} are up to "
            f"{1e3 * residual_m:.3g} mm apart, not below {1e3 * _LARGEST_RESIDUAL_M:g} mm",
        )
    return certify_state(manifold, state)


def load_grasp_task(grasp: GraspFile, path: Path, override: str | None = None) -> Task:
    """The task of a grasp file at `path`, or the one named instead.

    Raises:
        InputError: no such task, or a file that can't be used.
    """
    return load_task(override or resolve_source(grasp.task_source, path))


def resolve_source(task_source: str, path: Path) -> str:
    """A task as named in the file `path`: built-in names as they are, paths from that file's folder."""
    task, hand = split_reference(task_source)
    return with_hand(_resolved(task, path), None if hand is None else _resolved(hand, path))


def _resolved(name: str, path: Path) -> str:
    return str(path.parent / name) if name.endswith((".yaml", ".yml")) else name


def relative_source(task: str, path: Path) -> str:
    """How the file `path` names the task: built-in names as they are, paths from that file's folder."""
    task, hand = split_reference(task)
    return with_hand(_relative(task, path), None if hand is None else _relative(hand, path))


def _relative(name: str, path: Path) -> str:
    if not name.endswith((".yaml", ".yml")):
        return name
    return os.path.relpath(Path(name).resolve(), path.resolve().parent)


def file_head(task: Task, reference: str, path: Path) -> dict[str, str]:
    """Fields that a grasp has in a file of its own, `path`; `reference` is how the user named the task."""
    return {
        "holdfast": __version__,
        "task": task.name,
        "task_source": relative_source(reference, path),
        "task_fingerprint": fingerprint(task),
        "hand": task.hand.name,
        "object_name": task.object.name,
    }


def updated(grasp: GraspT, **found: object) -> GraspT:
    """The grasp with what a stage has found, validated anew."""
    return type(grasp).model_validate({**dict(grasp), **found})
