"""Words for people: what passing a test is called depends on its kind. Files say `held` for all of them."""

from ..directions import TestKind
from .outcome import Outcome

__all__ = ["load_word", "outcome_word", "passed_word", "verdict_word"]

_PASSED: dict[TestKind, str] = {"lift": "held", "turn": "turned", "press": "pressed"}
_LOADS: dict[TestKind, str] = {
    "lift": "gravity",
    "turn": "the friction of the hinge",
    "press": "the force asked for",
}


def passed_word(kind: TestKind) -> str:
    """What a grasp has done that has passed a test of this kind: held, turned or pressed."""
    return _PASSED[kind]


def load_word(kind: TestKind) -> str:
    """What the margin of a test of this kind is a multiple of."""
    return _LOADS[kind]


def verdict_word(verdict: str, kind: TestKind) -> str:
    """The verdict of a run in the words of the kind of test; files say `held` and `not held`."""
    words = {"held": passed_word(kind), "not held": f"not {passed_word(kind)}"}
    return words.get(verdict, verdict)


def outcome_word(outcome: Outcome | str, kind: TestKind) -> str:
    """An outcome, or its value as files have it, in the words of the kind of test."""
    value = outcome.value if isinstance(outcome, Outcome) else outcome
    return passed_word(kind) if value == Outcome.HELD.value else value
