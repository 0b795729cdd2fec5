"""How a task is named, with a hand in place of its own where that is asked for: `pinch.yaml@shadow`."""

from pathlib import Path

from ..errors import UnknownName
from ..hands import HAND_SUFFIXES, builtin_hands

__all__ = ["split_reference", "with_hand"]


def split_reference(reference: str) -> tuple[str, str | None]:
    """The task and the hand that a reference names; None stands for the task's own hand.

    What follows the last `@` is a hand if it is a built-in name or the path of a hand file, and if the whole
    is no file that exists.
    """
    task, mark, hand = reference.rpartition("@")
    is_hand = hand in builtin_hands() or hand.lower().endswith(HAND_SUFFIXES)
    if not mark or not task or not is_hand or Path(reference).is_file():
        return reference, None
    return task, hand


def with_hand(task: str, hand: str | None) -> str:
    """The reference of a task with this hand in place of any other.

    Raises:
        UnknownName: neither a built-in hand nor the path of a hand file.
    """
    if hand is None:
        return task
    if hand not in builtin_hands() and not hand.lower().endswith(HAND_SUFFIXES):
        raise UnknownName("hand", "", "hand", hand, builtin_hands())
    return f"{split_reference(task)[0]}@{hand}"
