"""What a reading makes of a file: joints in the hand's order, poses in the palm frame, the object's size."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from ....base.numeric.arrays import Array, Indices
from ....errors import InputError
from ....geometry import invert
from ....hands import Hand
from ...formats import Grasp, GraspFile, JointValues, Posture, QuestionName, hand_in_object, object_factor
from .hand_frames import BASE, hand_frames
from .jaw import Jaw
from .joint_names import match_joints
from .joint_orders import HAND_ORDER, are_a_pair, joint_orders
from .states import States

__all__ = ["NO_SCALE", "Interpreter"]

NO_SCALE = "none"
"""Answer to `scale`: the object already has the size that is meant, whatever number stands beside it."""

# Hands of so many joints are grippers.
_GRIPPER = 2
# Joints so near to the open end of their range, by its width, are at it.
_AT_END = 0.1
_UNITS = {"m": 1.0, "mm": 1e-3, "rad": 1.0, "deg": np.pi / 180.0}


@dataclass(eq=False)
class Interpreter:
    """Reads the grasps of a file for one hand.

    Args:
        file: what is written.
        hand: the hand.
        posture: which moment of each grasp: `grasp`, `pregrasp` or `squeeze`.
        loaded_at: (3,) what the object's mesh was multiplied by when it was loaded.

    Attributes:
        frames: poses of the hand's frames in its palm's, by name.
        orders: what arrays of joint values without names may stand for.
        has_joints: whether the file gives joints at all, of grasps.
        is_open: whether it has those of an open gripper alone.
        unknown: joint names of the file that mean no joint of the hand.
        left_out: values ahead of the joints', as of a wrist, that the hand has no joints for.
        filled: joints of the hand that the file says nothing of, and that stand as others do or at rest.
    """

    file: GraspFile
    hand: Hand
    posture: str = "grasp"
    loaded_at: Array = field(default_factory=lambda: np.ones(3))

    def __post_init__(self) -> None:
        self.frames = hand_frames(self.hand)
        self._stands_in: dict[int, int] = {}
        self._postures = [self._at_moment(grasp) for grasp in self.file.grasps]
        given = [posture.joints for posture in self._postures if posture.joints is not None]
        self.has_joints = bool(given) and all(len(joints.values) for joints in given)
        if self.has_joints and len(given) < len(self._postures):
            raise InputError(self.file.path, "grasps", "some give joints and others don't: split the file")
        self.is_open = self.has_joints and self._is_open(given)
        self.has_joints = self.has_joints and not self.is_open
        self.orders = self._orders_of([joints for joints in given if joints.names is None])
        names = dict.fromkeys(name for joints in given for name in joints.names or ())
        self._matched = match_joints(self.hand, list(names))
        self.unknown = tuple(name for name in names if name not in self._matched)
        if names and not self._matched:
            shown = ", ".join(list(names)[:6])
            raise InputError(
                self.file.path, "joints", f"none of hand {self.hand.name} is called {shown}: is it the hand?"
            )
        self.left_out = max((int(np.sum(order < 0)) for order in self.orders.values()), default=0)
        listed = np.concatenate([*self.orders.values()]) if self.orders else np.zeros(0, dtype=np.int64)
        known = {*self._matched.values(), *listed.tolist()}
        self.filled = self._fill_in(known) if self.has_joints else ()

    def states(self, reading: Mapping[QuestionName, str], rows: Indices | None = None) -> States:
        """The grasps, or some of them, in one reading.

        Args:
            reading: answers to the questions of the file. `frame` is one of `frames`, `joint_order` one of
                `orders`, and `scale` may be `NO_SCALE`.
            rows: which grasps; None for all.
        """
        chosen = range(len(self.file.grasps)) if rows is None else rows.tolist()
        joints = np.array([self._joints(self._postures[i].joints, reading) for i in chosen])
        T_palm_frame = self.frames[reading.get("frame", BASE)]
        Ts, factors = [], []
        for i in chosen:
            grasp = self.file.grasps[i]
            T_object_frame = hand_in_object(grasp, reading, self._postures[i])
            Ts.append(T_palm_frame @ invert(T_object_frame))
            unscaled = reading.get("scale") == NO_SCALE
            factors.append((np.ones(3) if unscaled else object_factor(grasp, reading)) / self.loaded_at)
        n = len(Ts)
        return States(
            joints.reshape(n, len(self.hand.axes)),
            np.array(Ts).reshape(n, 4, 4),
            np.array(factors).reshape(n, 3),
        )

    def _is_open(self, given: list[JointValues]) -> bool:
        """Whether a gripper stands open in every grasp, of two at least: then it has still to close.

        Where it stands alike and is not open, all grasps are of the same width.
        """
        first = given[0].values
        alike = all(np.array_equal(joints.values, first) for joints in given)
        if len(self.hand.independent) > _GRIPPER or len(given) < 2 or not alike:
            return False
        found = [
            (wide, _AT_END * (axis.upper - axis.lower), unit)
            for axis, wide in zip(self.hand.axes, Jaw(self.hand).open, strict=True)
            for unit in (("m", "mm") if axis.kind == "prismatic" else ("rad", "deg"))
        ]
        return all(
            any(abs(_UNITS[unit] * value - wide) <= near for wide, near, unit in found) for value in first
        )

    def _at_moment(self, grasp: Grasp) -> Posture:
        posture: Posture | None = getattr(grasp, self.posture)
        if posture is None:
            raise InputError(self.file.path, f"grasps.{grasp.name}", f"has no {self.posture}")
        return posture

    def _orders_of(self, arrays: list[JointValues]) -> dict[str, Indices]:
        counts = {len(joints.values) for joints in arrays if len(joints.values)}
        if not counts:
            return {}
        if len(counts) > 1:
            raise InputError(self.file.path, "joints", f"are {_listed(counts)} numbers: split the file")
        orders = joint_orders(self.hand, counts.pop())
        if not orders:
            n, k = len(self.hand.axes), len(self.hand.independent)
            several = f"{n}" if n == k else f"{n}, or {k} without the coupled ones"
            raise InputError(
                self.file.path,
                "joints",
                f"are {len(arrays[0].values)} numbers, and hand {self.hand.name} has {several}: "
                "is it the hand?",
            )
        return orders

    def _joints(self, given: JointValues | None, reading: Mapping[QuestionName, str]) -> Array:
        """Positions (n_joints,) in rad and m; at rest where none is given."""
        hand = self.hand
        q = hand.expand(np.clip(0.0, hand.limits[:, 0], hand.limits[:, 1]))
        if given is None or not len(given.values):
            return q
        units = np.array(
            [
                _UNITS[reading.get("joint_length", "m") if axis.kind == "prismatic" else angle]
                for axis in hand.axes
                for angle in [reading.get("angle", "rad")]
            ]
        )
        known = np.zeros(len(q), dtype=bool)
        if given.names is None:
            order = self.orders[reading.get("joint_order", HAND_ORDER)]
            places = [(int(j), value) for j, value in zip(order, given.values, strict=True) if j >= 0]
        else:
            places = [(self._matched[n], v) for n, v in given.by_name.items() if n in self._matched]
        for j, value in places:
            q[j], known[j] = value * units[j], True
        for j, other in self._stands_in.items():
            q[j] = q[other] if other >= 0 else q[j]
        led = hand.coupling_matrix @ q[hand.independent] + hand.coupling_offset
        return np.where(known, q, np.where(_is_coupled(hand), led, q))

    def _fill_in(self, known: set[int]) -> tuple[str, ...]:
        """Where the values of independent joints come from that the file leaves out."""
        hand = self.hand
        for j in hand.independent.tolist():
            if j in known:
                continue
            # The other jaw of a pair, which models often write as a joint of its own.
            alike = [k for k in hand.independent.tolist() if k in known and are_a_pair(hand, j, k)]
            self._stands_in[j] = alike[0] if len(alike) == 1 else -1
        return tuple(hand.joint_names[j] for j in self._stands_in)


def _is_coupled(hand: Hand) -> Array:
    return np.array([axis.coupling is not None for axis in hand.axes], dtype=bool)


def _listed(counts: set[int]) -> str:
    return " or ".join(str(count) for count in sorted(counts))
