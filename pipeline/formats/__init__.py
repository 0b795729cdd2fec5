"""Grasp files of others: read as they are written, with what their layouts leave open, and written."""

from .grasp_file import (
    QUESTIONS,
    Grasp,
    GraspFile,
    JointValues,
    Posture,
    Question,
    QuestionName,
    WrittenHand,
    WrittenObject,
    WrittenPose,
)
from .labels import said_to_hold
from .own import is_own_file
from .placing import hand_in_object, object_factor, to_matrix
from .reading import FORMATS, read_grasps

__all__ = [
    "FORMATS",
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
    "hand_in_object",
    "is_own_file",
    "object_factor",
    "read_grasps",
    "said_to_hold",
    "to_matrix",
]
