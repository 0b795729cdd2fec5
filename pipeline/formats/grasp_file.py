"""Grasps as somebody's file has them: what is written, and what its layout leaves open.

Nothing here is converted. Numbers stay in the units, frames and orders of the file, for one layout name hides
several; `Question` says which readings there are, and `placing.py` applies one.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Literal, TypeAlias, TypeVar, cast

from ...base.numeric.arrays import Array

__all__ = [
    "QUESTIONS",
    "Grasp",
    "GraspFile",
    "JointValues",
    "Posture",
    "Question",
    "QuestionName",
    "WrittenHand",
    "WrittenObject",
    "WrittenPose",
    "questions",
]

_ThingT = TypeVar("_ThingT")

QuestionName: TypeAlias = Literal[
    "quaternion", "length", "angle", "joint_length", "scale", "frame", "direction", "joint_order", "width"
]

QUESTIONS: dict[QuestionName, tuple[str, ...]] = {
    # The order of a quaternion's four numbers.
    "quaternion": ("wxyz", "xyzw"),
    # The unit of positions.
    "length": ("m", "mm"),
    # The unit of joints that turn, and of Euler angles.
    "angle": ("rad", "deg"),
    # The unit of joints that slide, and of widths.
    "joint_length": ("m", "mm"),
    # Whether the object is its mesh times the number that is written, or its mesh divided by it.
    "scale": ("times", "divided"),
    # Which frame of the gripper a pose is of: the root of its model, or one between the fingertips.
    "frame": ("base", "tcp"),
    # Whether a pose is the gripper's in the object's frame, or the object's in the gripper's.
    "direction": ("hand_in_object", "object_in_hand"),
    # What an array of joint values without names follows: the hand decides, so no answers are listed.
    "joint_order": (),
    # Whether a width is the gap between the jaws, or the way of one jaw.
    "width": ("gap", "half"),
}
"""What layouts leave open, each with the readings that occur."""


@dataclass(frozen=True)
class Question:
    """What the layout of a file leaves open.

    Attributes:
        name: a key of `QUESTIONS`.
        answers: the readings possible, the usual one first; empty where the hand decides.
        usual: the reading of the format's authors, or of most files; None where there is none.
        stated: what this file itself says of it, in words; empty where it says nothing.
    """

    name: QuestionName
    answers: tuple[str, ...]
    usual: str | None = None
    stated: str = ""

    @classmethod
    def of(cls, name: QuestionName, usual: str | None = None, stated: str = "") -> "Question":
        """The question with all its readings, the usual one first."""
        rest = tuple(answer for answer in QUESTIONS[name] if answer != usual)
        return cls(name, rest if usual is None else (usual, *rest), usual, stated)


def questions(**usual: str | None) -> tuple[Question, ...]:
    """Questions by name, each with its usual answer."""
    return tuple(Question.of(cast(QuestionName, name), answer) for name, answer in usual.items())


@dataclass(frozen=True)
class WrittenPose:
    """A pose as it is written: a matrix, or a position with one kind of rotation.

    Attributes:
        matrix: homogeneous (4, 4), columns the axes.
        position: (3,), in the file's unit of length.
        quaternion: (4,), in the order of the file, not normalised.
        euler: (3,), turns about the fixed axes x, y, z, in this order, in the file's unit of angles.
        rotation: (3, 3), columns the axes.
    """

    matrix: Array | None = None
    position: Array | None = None
    quaternion: Array | None = None
    euler: Array | None = None
    rotation: Array | None = None


@dataclass(frozen=True)
class JointValues:
    """Joint values as they are written.

    Attributes:
        values: (k,), in the file's units.
        names: of the joints, or None for an array that doesn't say.
    """

    values: Array
    names: tuple[str, ...] | None = None

    @property
    def by_name(self) -> dict[str, float]:
        """Values by joint name; empty where there are no names."""
        return dict(zip(self.names or (), self.values.tolist(), strict=False))


@dataclass(frozen=True)
class Posture:
    """A hand at one moment of a grasp.

    Attributes:
        pose: of the hand; None where the file gives it at another moment alone, whose pose it then is.
        joints: None where the file gives no joints for this moment.
    """

    pose: WrittenPose | None = None
    joints: JointValues | None = None


@dataclass(frozen=True)
class WrittenObject:
    """An object as a file names it, every field as written.

    Attributes:
        name: or identifier; empty where there is none.
        path: of its mesh or model; not to be opened without a look at where it leads.
        scale: the number beside it, or None; along x, y, z where there are three.
        frame: the words for its frame.
        mass: in kg, where the file has one.
    """

    name: str = ""
    path: str = ""
    scale: tuple[float, ...] | None = None
    frame: str = ""
    mass: float | None = None


@dataclass(frozen=True)
class WrittenHand:
    """A hand or gripper as a file names it, every field as written.

    Attributes:
        name: empty where there is none.
        path: of its model.
        frame: the words for its frame.
        numbers: what the file says of it, such as its `width` and `depth`, by the file's names.
    """

    name: str = ""
    path: str = ""
    frame: str = ""
    numbers: Mapping[str, float | tuple[float, ...]] = field(default_factory=dict)


@dataclass(frozen=True)
class Grasp:
    """One grasp of a file.

    Attributes:
        name: its key or index in the file.
        grasp: the hand at the grasp.
        pregrasp: before it closes, where the file has it.
        squeeze: where its servos are sent when it squeezes, where the file has it.
        hand: what the file calls the hand.
        object: what the file calls the object.
        object_pose: of the object, where hand and object are both given in a third frame.
        width: between the jaws, in the file's unit.
        labels: the authors' judgements by the file's names: success or failure, scores.
        numbers: what else the file says of this grasp, by the file's names.
        contacts: what of the hand touches by the file's own word, names of links or of regions of it; None
            where it doesn't say.
    """

    name: str
    grasp: Posture
    pregrasp: Posture | None = None
    squeeze: Posture | None = None
    hand: WrittenHand = WrittenHand()
    object: WrittenObject = WrittenObject()
    object_pose: WrittenPose | None = None
    width: float | None = None
    labels: Mapping[str, float | bool] = field(default_factory=dict)
    numbers: Mapping[str, float | tuple[float, ...]] = field(default_factory=dict)
    contacts: tuple[str, ...] | None = None


@dataclass(frozen=True)
class GraspFile:
    """All grasps of a file.

    Attributes:
        path: the file.
        format: the name of its format, a key of `FORMATS`.
        variant: which of the layouts that have this name, in words.
        grasps: in the order of the file.
        unsettled: what the layout leaves open.
        settled: readings that the file states beyond doubt, by question.
        remarks: what is odd in this file, a line each.
    """

    path: Path
    format: str
    variant: str
    grasps: tuple[Grasp, ...]
    unsettled: tuple[Question, ...] = ()
    settled: Mapping[QuestionName, str] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()

    @property
    def hands(self) -> tuple[WrittenHand, ...]:
        """The hands that its grasps name, each once."""
        return _distinct(grasp.hand for grasp in self.grasps)

    @property
    def objects(self) -> tuple[WrittenObject, ...]:
        """The objects that its grasps name, each once with every scale."""
        return _distinct(grasp.object for grasp in self.grasps)

    def question(self, name: QuestionName) -> Question | None:
        """What is open of this name, if it is."""
        return next((question for question in self.unsettled if question.name == name), None)

    def answers(self, **answers: str) -> dict[QuestionName, str]:
        """A reading: what the file settles, the usual answers to the rest, and those given here."""
        usual = {question.name: question.usual for question in self.unsettled if question.usual}
        return {**usual, **self.settled, **answers}  # type: ignore[dict-item]

    def only(self, indices: Iterable[int]) -> "GraspFile":
        """The file with some of its grasps."""
        return replace(self, grasps=tuple(self.grasps[i] for i in indices))


def _distinct(things: Iterable[_ThingT]) -> tuple[_ThingT, ...]:
    # Their numbers are mappings, which have no hash.
    return tuple({repr(thing): thing for thing in things}.values())
