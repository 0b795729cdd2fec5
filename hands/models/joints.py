"""Joints of an imported hand: what the model says of them, and what the hand file says before it."""

from dataclasses import replace
from functools import cached_property

import numpy as np

from ...base.numeric.arrays import Array
from ...errors import InputError, UnknownName
from ...geometry import axis_rotation, pose
from ..hand import Actuator, Axis, Coupling
from ..joint_file import build_actuator, build_coupling
from .file import ImportedHandFile
from .model_tree import ModelJoint, ModelTree
from .names import new_names

__all__ = ["ImportedJoints"]

_HALF_TURNS = "the model has no limits here; 180 degrees both ways were taken"
_WRONG_SIGN = "its limits would keep what it follows from moving, and were taken with the other sign"
# Limits of a follower that leave less of its master's range than the first share have the wrong sign, if the
# other sign leaves more than the second.
_LEAST_ROOM, _TURNED_ROOM = 0.1, 0.5
_ONE_TURN = "turns more than once around in the model; a turn either way was taken"
# Axes of one body that miss each other by more than this have no common point.
_SAME_POINT_M = 1e-9


class ImportedJoints:
    """The joints of the bodies of a hand.

    Args:
        spec: the hand file.
        source: its path, for error messages.
        tree: the model, whose notes take what was assumed.
        bodies: those of the hand, the palm first.
    """

    def __init__(self, spec: ImportedHandFile, source: str, tree: ModelTree, bodies: list[int]):
        self._spec = spec
        self._source = source
        self._tree = tree
        self._bodies = bodies
        self._assumed: dict[str, list[str]] = {}
        moving = [joint.name for body in bodies[1:] for joint in tree.joints(body)]
        numbers = [tree.joint_names.index(name) for name in moving]
        self._joint_names = new_names("joint_names", spec.joint_names, tree.joint_names, numbers, source)
        self._check_joint_fields()
        self._couplings = self._all_couplings()

    def common_anchor(self, body: int, joints: list[ModelJoint]) -> Array:
        """A point (3,) that the axes of all hinges of a body pass through, in the body's frame."""
        hinges = [joint for joint in joints if joint.kind == "revolute"]
        if not hinges:
            return np.zeros(3)
        across = [np.eye(3) - np.outer(joint.axis, joint.axis) for joint in hinges]
        # Near the first anchor, of all points of a common axis.
        A = np.vstack(across)
        b = np.concatenate(
            [P @ (joint.anchor - hinges[0].anchor) for P, joint in zip(across, hinges, strict=True)]
        )
        point = np.linalg.lstsq(A, b, rcond=1e-9)[0]
        if np.abs(A @ point - b).max() > _SAME_POINT_M:
            raise InputError(
                self._source,
                f"import: body {self._tree.body_names[body]}",
                "has hinges whose axes don't cross: put a body between them",
            )
        return point + hinges[0].anchor

    def axes(self, T: Array, joints: list[ModelJoint]) -> tuple[Array, tuple[Axis, ...]]:
        """T_parent_link0 (4, 4) and axes, from the link's pose `T` with all joints at the model's zero."""
        axes: list[Axis] = []
        for joint in joints:
            axes.append(self._axis(joint))
            if joint.kind == "prismatic":
                if joint.zero != 0.0 and len(axes) > 1:
                    raise InputError(
                        self._source,
                        f"import: joint {joint.name}",
                        "has a ref behind another joint of its body",
                    )
                T = T @ pose(np.eye(3), -joint.zero * joint.axis)
            else:
                # The joint's own zero; an earlier axis keeps its place in the parent.
                turn = axis_rotation(joint.axis, -joint.zero)
                T = T @ pose(turn, np.zeros(3))
                axes[:-1] = [replace(earlier, direction=turn.T @ earlier.direction) for earlier in axes[:-1]]
        return T, tuple(axes)

    def _axis(self, joint: ModelJoint) -> Axis:
        name = self._joint_names[self._tree.joint_names.index(joint.name)]
        limits = self._limits(name)
        largest = 2.0 * np.pi if joint.kind == "revolute" else 1.0
        if joint.kind == "revolute" and name not in self._spec.limits:
            limits = self._within_a_turn(name, limits)
        if max(-limits[0], limits[1]) > largest * (1.0 + 1e-12) or limits[0] > limits[1]:
            unit = "rad" if joint.kind == "revolute" else "m"
            raise InputError(
                self._source,
                f"limits.{name}",
                f"must lie in [-{largest:.4g}, {largest:.4g}] {unit}, not {limits}{_meant(joint, limits)}",
            )
        coupling = self._couplings.get(name)
        servo = None if coupling else self._servo(name, joint)
        return Axis(name, joint.kind, joint.axis, limits[0], limits[1], coupling, servo)

    def _assume(self, what: str, name: str) -> None:
        """Notes what was taken for the limits of a joint, all such joints in one note."""
        names = self._assumed.setdefault(what, [])
        before = f"{', '.join(names)}: {what}"
        if name not in names:
            names.append(name)
        told = f"{', '.join(names)}: {what}"
        if before in self._tree.notes:
            self._tree.notes[self._tree.notes.index(before)] = told
        else:
            self._tree.notes.append(told)

    def _within_a_turn(self, name: str, limits: tuple[float, float]) -> tuple[float, float]:
        """Limits of a hinge within a turn either way, where the model's are not far beyond."""
        turn = 2.0 * np.pi
        if limits[0] > turn or limits[1] < -turn or not turn < max(-limits[0], limits[1]) <= 2.0 * turn:
            return limits
        self._assume(_ONE_TURN, name)
        return max(limits[0], -turn), min(limits[1], turn)

    def _limits(self, name: str, seen: frozenset[str] = frozenset()) -> tuple[float, float]:
        """Limits of a joint: the file's, the model's, or for one that follows, those that its master sets."""
        joint, coupling = self._joints[name], self._couplings.get(name)
        limits = self._spec.limits.get(name, joint.limits)
        if limits is not None:
            if name not in self._spec.limits and self._have_wrong_sign(coupling, limits, seen):
                self._assume(_WRONG_SIGN, name)
                return -limits[1], -limits[0]
            return limits
        if coupling is None and joint.kind == "revolute":
            self._assume(_HALF_TURNS, name)
            return -np.pi, np.pi
        if coupling is None or coupling.master in seen or coupling.master not in self._joints:
            raise InputError(
                self._source, f"limits.{name}", "is required: the model has no limits for this joint"
            )
        return self._followed(coupling, seen | {name})

    def _followed(self, coupling: Coupling, seen: frozenset[str]) -> tuple[float, float]:
        """Where a joint goes that follows its master all the way."""
        ends = [coupling.ratio * end + coupling.offset for end in self._limits(coupling.master, seen)]
        return min(ends), max(ends)

    def _have_wrong_sign(
        self, coupling: Coupling | None, limits: tuple[float, float], seen: frozenset[str]
    ) -> bool:
        """Whether a follower's limits leave its master no room, and would with the other sign.

        Published models have that, for other programs ignore the limits of a joint that follows another one.
        """
        if coupling is None or coupling.master in seen or coupling.master not in self._joints:
            return False
        if self._joints[coupling.master].limits is None and coupling.master not in self._spec.limits:
            return False
        lower, upper = self._followed(coupling, seen | {coupling.master})
        room = min(upper, limits[1]) - max(lower, limits[0])
        turned = min(upper, -limits[0]) - max(lower, -limits[1])
        return room < _LEAST_ROOM * (upper - lower) and turned > _TURNED_ROOM * (upper - lower)

    @cached_property
    def _joints(self) -> dict[str, ModelJoint]:
        """The joints of the hand by their new names."""
        joints = [joint for body in self._bodies[1:] for joint in self._tree.joints(body)]
        return {self._joint_names[self._tree.joint_names.index(joint.name)]: joint for joint in joints}

    def _servo(self, name: str, joint: ModelJoint) -> Actuator | None:
        """The servo that the file or the model gives; None leaves it to `with_nominal_servos`."""
        if name in self._spec.actuators:
            return build_actuator(self._spec.actuators[name])
        if joint.servo is not None:
            return joint.servo
        return None if self._spec.actuator is None else build_actuator(self._spec.actuator)

    def _check_joint_fields(self) -> None:
        known = list(self._joint_names.values())
        for field in ("actuators", "coupled", "limits"):
            for name in getattr(self._spec, field):
                if name not in known:
                    raise UnknownName(self._source, f"{field}.{name}", "joint", name, known)
        for name, (lower, upper) in self._spec.limits.items():
            if lower > upper:
                raise InputError(
                    self._source,
                    f"limits.{name}",
                    f"the lower limit {lower:g} is above the upper limit {upper:g}",
                )

    def _all_couplings(self) -> dict[str, Coupling]:
        """Couplings by new names, the file's before the model's."""
        new = {self._tree.joint_names[i]: name for i, name in self._joint_names.items()}
        own = {name: build_coupling(entry) for name, entry in self._spec.coupled.items()}
        given = {old for old, name in new.items() if name in own}
        out = {}
        for follower, coupling in self._tree.couplings.of_joints(set(self._bodies[1:]), given).items():
            if follower not in new or coupling.master not in new:
                raise InputError(
                    self._source,
                    "import",
                    f"joint {follower!r} is coupled to {coupling.master!r}, which the palm does not carry; "
                    f"say in coupled how {follower!r} follows a joint of the hand",
                )
            out[new[follower]] = replace(coupling, master=new[coupling.master])
        for name, coupling in own.items():
            # The file may turn a coupling of the model round.
            turned = out.get(coupling.master)
            if turned is not None and turned.master == name:
                del out[coupling.master]
        out |= own
        coupled = {old for old, name in new.items() if name in out}
        self._tree.notes += self._tree.couplings.linkages.notes
        self._tree.notes += self._tree.couplings.tendon_notes(set(self._bodies[1:]), coupled)
        return out


def _meant(joint: ModelJoint, limits: tuple[float, float]) -> str:
    """The unit that limits probably have, in words, where they are too large for their own."""
    largest, width = max(-limits[0], limits[1]), limits[1] - limits[0]
    if joint.kind == "revolute" and 2.0 * np.pi < largest <= 360.0 and width > 0.0:
        return ": are they in degrees? They must be in radians"
    if joint.kind == "prismatic" and 1.0 < largest <= 1000.0 and width > 0.0:
        return ": are they in millimetres? They must be in metres"
    return ""
