"""Which readings a file may have, and how unlikely each is before anyone has looked at the object."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np

from ...formats import QUESTIONS, Grasp, GraspFile, QuestionName
from .hand_frames import BASE
from .interpret import NO_SCALE, Interpreter
from .joint_orders import HAND_ORDER

__all__ = ["Factor", "Reading", "candidate_readings", "factors", "possible_answers"]

# What an answer costs that is not the usual one, where the layout leaves it open; and one that goes against
# what the file states, or against what its format defines. In logarithms of likelihood.
_UNUSUAL, _AGAINST = 2.5, 6.0
# Readings of which more are not looked at, the likeliest first.
_MOST = 160


@dataclass(frozen=True)
class Factor:
    """A question about a file, with what each answer costs.

    Attributes:
        name: the question.
        costs: by answer; the first is what the file would be taken for without a look at the object.
        stated: whether that is what the file or its format states.
    """

    name: QuestionName
    costs: Mapping[str, float]
    stated: bool

    @property
    def first(self) -> str:
        """The answer that is taken unless something speaks against it."""
        return min(self.costs, key=lambda answer: self.costs[answer])


@dataclass(frozen=True, eq=False)
class Reading:
    """Answers to all questions about a file.

    Attributes:
        answers: by question.
        cost: how unlikely they are beforehand.
    """

    answers: Mapping[QuestionName, str]
    cost: float


def factors(file: GraspFile, interpreter: Interpreter, fixed: Mapping[QuestionName, str]) -> list[Factor]:
    """The questions that matter for a file, with those that someone has answered fixed."""
    found = []
    for name, answers in possible_answers(file, interpreter).items():
        question, settled = file.question(name), file.settled.get(name)
        if name in fixed:
            found.append(Factor(name, {fixed[name]: 0.0}, True))
            continue
        if question is not None:
            usual, other = question.usual or _DEFAULTS.get(name), _UNUSUAL
        else:
            usual, other = settled or _DEFAULTS.get(name, answers[0]), _AGAINST
        costs = {answer: other if usual not in (None, answer) else 0.0 for answer in answers}
        if NO_SCALE in costs:
            costs[NO_SCALE] += _UNUSUAL
        found.append(Factor(name, costs, question is None))
    return found


_DEFAULTS: dict[QuestionName, str] = {"joint_order": HAND_ORDER, "frame": BASE}


def possible_answers(file: GraspFile, interpreter: Interpreter) -> dict[QuestionName, tuple[str, ...]]:
    """The answers that make a difference, by question."""
    hand, grasps = interpreter.hand, file.grasps
    kinds = {axis.kind for axis in hand.axes}
    found: dict[QuestionName, tuple[str, ...]] = {}
    if any(_has_quaternion(grasp) for grasp in grasps):
        found["quaternion"] = QUESTIONS["quaternion"]
    found["length"] = QUESTIONS["length"]
    if (interpreter.has_joints and "revolute" in kinds) or any(_has_euler(grasp) for grasp in grasps):
        found["angle"] = QUESTIONS["angle"]
    if interpreter.has_joints and "prismatic" in kinds:
        found["joint_length"] = QUESTIONS["joint_length"]
    if any(
        grasp.object.scale is not None and np.any(np.array(grasp.object.scale) != 1.0) for grasp in grasps
    ):
        found["scale"] = (*QUESTIONS["scale"], NO_SCALE)
    found["frame"] = tuple(interpreter.frames)
    if all(grasp.object_pose is None for grasp in grasps):
        found["direction"] = QUESTIONS["direction"]
    if len(interpreter.orders) > 1:
        found["joint_order"] = tuple(interpreter.orders)
    return found


def _has_quaternion(grasp: Grasp) -> bool:
    return any(
        pose is not None and pose.quaternion is not None for pose in (grasp.grasp.pose, grasp.object_pose)
    )


def _has_euler(grasp: Grasp) -> bool:
    return grasp.grasp.pose is not None and grasp.grasp.pose.euler is not None


def candidate_readings(questions: list[Factor]) -> list[Reading]:
    """Readings worth a look, the likeliest first.

    All of what the layout leaves open; and on top of each of these, what goes against the file's own word:
    one such answer, or two, for a file with a fault has seldom more.
    """
    open_ones = [factor for factor in questions if not factor.stated]
    stated = [factor for factor in questions if factor.stated]
    first: dict[QuestionName, str] = {factor.name: factor.first for factor in stated}
    found = []
    for answers in product(*(factor.costs for factor in open_ones)):
        named = dict(zip((factor.name for factor in open_ones), answers, strict=True))
        base = sum(factor.costs[named[factor.name]] for factor in open_ones)
        for other, cost in _against(stated):
            found.append(Reading({**first, **named, **other}, base + cost))
    found.sort(key=lambda reading: reading.cost)
    return found[:_MOST]


def _against(stated: list[Factor]) -> Iterator[tuple[dict[QuestionName, str], float]]:
    """No answer against the file's word, then each, then each two."""
    single = [
        (factor.name, answer, cost)
        for factor in stated
        for answer, cost in factor.costs.items()
        if answer != factor.first
    ]
    yield {}, 0.0
    for name, answer, cost in single:
        yield {name: answer}, cost
    for (a, answer_a, cost_a), (b, answer_b, cost_b) in combinations(single, 2):
        if a != b:
            yield {a: answer_a, b: answer_b}, cost_a + cost_b
