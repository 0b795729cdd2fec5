"""Choosing the reading of a file by geometry: that in which hands hold the object, over all of its grasps."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ....base.numeric.arrays import Indices
from ....errors import InputError, UnknownName
from ...formats import GraspFile, QuestionName
from .alike import touch_alike
from .candidates import Factor, Reading, candidate_readings, factors, possible_answers
from .interpret import Interpreter
from .jaw import Jaw
from .near_object import NearObject
from .own_hand import OwnHand
from .plausibility import fingers_near, log_likelihood
from .states import States

__all__ = ["AmbiguousReading", "ChosenReading", "choose_reading", "option"]

# Grasps by which all readings are compared, and those by which the best of them are.
_FIRST_GRASPS, _MORE_GRASPS, _BEST = 4, 16, 6
# Log-likelihoods of grasps of one file tell the same story: no more than so many count as independent.
_INDEPENDENT = 10
# Of two readings the better one is taken if it is so much better; e^3 = 20 to one.
_MARGIN = 3.0
# Share of a file's grasps that must have two fingers near the object.
_LEAST_SHARE = 0.3
# Readings that place hands within this of each other say the same.
_SAME_M, _SAME_RAD = 2e-4, 2e-3


class AmbiguousReading(InputError):
    """Several readings of a file are about equally good: somebody has to say which is meant.

    Attributes:
        answers: by question that is open, the answers of these readings, the likeliest first.
    """

    def __init__(self, source: Path, what: str, answers: Mapping[QuestionName, Sequence[str]]):
        self.answers = {name: tuple(several) for name, several in answers.items()}
        options = "; ".join(f"--{option(name)} {' or '.join(several)}" for name, several in answers.items())
        super().__init__(source, ", ".join(answers), f"{what}; say which is meant: {options}")


@dataclass(frozen=True, eq=False)
class ChosenReading:
    """How a file is read.

    Attributes:
        answers: to each question about it.
        found: questions that geometry answered otherwise than the file is usually taken, or states.
        against: those of them that go against what the file or its format states.
        share: of the grasps compared, those that have two fingers near the object, or more.
        states: all grasps in this reading, those of poses alone with the jaws closed and the object between.
        moved_m: by how much objects were moved at most to lie between the jaws.
        left_open: questions that geometry does not decide, with the answers that fit about equally well, the
            one that was taken first: the same bodies touch at the same places with all of them.
    """

    answers: Mapping[QuestionName, str]
    found: Mapping[QuestionName, str]
    against: tuple[QuestionName, ...]
    share: float
    states: States
    moved_m: float = 0.0
    left_open: Mapping[QuestionName, tuple[str, ...]] = field(default_factory=dict)

    @property
    def fits(self) -> bool:
        """Whether hands are where they could hold the object."""
        return self.share >= _LEAST_SHARE


@dataclass(eq=False)
class _Candidate:
    reading: Reading
    states: States
    score: float = -np.inf
    share: float = 0.0


def choose_reading(
    file: GraspFile,
    interpreter: Interpreter,
    near: NearObject,
    fixed: Mapping[QuestionName, str] | None = None,
) -> ChosenReading:
    """The reading of a file.

    Args:
        file: what is written.
        interpreter: of that file.
        near: hand and object.
        fixed: answers that someone has given.

    Raises:
        AmbiguousReading: several readings are about equally good; names the options that decide.
        InputError: an answer that was given is none of the file's.
    """
    if not file.grasps:
        raise InputError(file.path, "", "holds no grasps")
    fixed = fixed or {}
    jaw = None if interpreter.has_joints else Jaw(near.hand)
    _check(fixed, possible_answers(file, interpreter), file)
    questions = factors(file, interpreter, fixed)
    rows = _spread(len(file.grasps), _FIRST_GRASPS)
    tried = _unlike(
        [
            _Candidate(reading, interpreter.states(reading.answers, rows))
            for reading in candidate_readings(questions)
        ],
        near,
    )
    _rate(tried, near, jaw)
    best = sorted(tried, key=lambda candidate: -candidate.score)[:_BEST]
    if len(file.grasps) > len(rows) and len(best) > 1:
        rows = _spread(len(file.grasps), _MORE_GRASPS)
        for candidate in best:
            candidate.states = interpreter.states(candidate.reading.answers, rows)
        _rate(best, near, jaw)
    if len(best) > 1:
        _rate_own_hand(best, OwnHand(near.hand), jaw)
        best.sort(key=lambda candidate: -candidate.score)
    left_open = _left_open(best, questions, file, near)
    chosen = best[0]
    answers = chosen.reading.answers
    found = {
        factor.name: answers[factor.name] for factor in questions if answers[factor.name] != factor.first
    }
    against = tuple(factor.name for factor in questions if factor.stated and factor.name in found)
    states, moved_m = interpreter.states(answers), 0.0
    if jaw is not None:
        closed = jaw.close(states, near)
        states = jaw.centre(closed, near)
        way = states.T_palm_object[:, :3, 3] - closed.T_palm_object[:, :3, 3]
        moved_m = float(np.linalg.norm(way, axis=1).max())
    return ChosenReading(answers, found, against, chosen.share, states, moved_m, left_open)


def _rate(candidates: Sequence[_Candidate], near: NearObject, jaw: Jaw | None) -> None:
    """Rates candidates, all by the same grasps."""
    states = States.joined([candidate.states for candidate in candidates])
    if jaw is not None:
        states = jaw.close(states, near)
    distances = near.distances(states)
    shape = len(candidates), -1
    each = log_likelihood(near.hand, states, distances).reshape(shape)
    fingers = fingers_near(near.hand, distances).reshape(shape)
    for k, candidate in enumerate(candidates):
        candidate.share = float((fingers[k] >= 2).mean())
        independent = min(each.shape[1], _INDEPENDENT)
        candidate.score = float(each[k].mean()) * independent - candidate.reading.cost


def _rate_own_hand(candidates: Sequence[_Candidate], own: OwnHand, jaw: Jaw | None) -> None:
    """Takes off what the hand's bodies are in each other: it costs too much to look at in all candidates.

    That of jaws, which close until they touch, says nothing of a reading.
    """
    if jaw is not None:
        return
    for candidate in candidates:
        each = own.log_likelihood(candidate.states)
        candidate.score += float(each.mean()) * min(len(each), _INDEPENDENT)


def _spread(count: int, most: int) -> Indices:
    """So many grasps from all over a file."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(np.int64))


def _unlike(candidates: list[_Candidate], near: NearObject) -> list[_Candidate]:
    """Candidates no two of which say the same; of those that do, the likeliest."""
    angle_m = _SAME_M / _SAME_RAD
    places = np.array([c.states.places(reach_m=near.obj.size_m, angle_m=angle_m) for c in candidates])
    kept: list[int] = []
    for k, place in enumerate(places):
        if not kept or np.abs(places[kept] - place).max(axis=1).min() > _SAME_M:
            kept.append(k)
    return [candidates[k] for k in kept]


def _check(
    fixed: Mapping[QuestionName, str], possible: Mapping[QuestionName, Collection[str]], file: GraspFile
) -> None:
    for name, answer in fixed.items():
        if name not in possible:
            raise InputError("verify", f"--{option(name)}", f"makes no difference to {file.path}")
        if answer not in possible[name]:
            raise UnknownName("verify", f"--{option(name)}", name.replace("_", " "), answer, possible[name])


def _left_open(
    best: list[_Candidate], questions: list[Factor], file: GraspFile, near: NearObject
) -> dict[QuestionName, tuple[str, ...]]:
    """Answers between which geometry does not decide, by question; none where one reading stands out.

    Raises:
        AmbiguousReading: another reading is about as good, and something else touches in it.
    """
    chosen = best[0]
    rivals = [other for other in best[1:] if other.score > chosen.score - _MARGIN]
    what = f"{1 + len(rivals)} readings fit about equally well"
    if chosen.share < _LEAST_SHARE:
        # Where no reading puts the hand at the object none of them is better than what the file says.
        rivals = [] if _is_first(chosen, questions) else best[1:]
        what = "no reading puts the hand at the object"
    several = {
        factor.name: tuple(dict.fromkeys(c.reading.answers[factor.name] for c in [chosen, *rivals]))
        for factor in questions
    }
    open_ones = {name: answers for name, answers in several.items() if len(answers) > 1}
    if not all(touch_alike(near, chosen.states, other.states) for other in rivals):
        raise AmbiguousReading(file.path, what, open_ones)
    return open_ones


def _is_first(candidate: _Candidate, questions: list[Factor]) -> bool:
    return all(candidate.reading.answers[factor.name] == factor.first for factor in questions)


def option(name: QuestionName) -> str:
    """The option of the command line that answers a question."""
    return {"scale": "scale-is"}.get(name, name.replace("_", "-"))
