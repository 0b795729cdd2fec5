"""What `run.json` says of why a task is infeasible."""

from typing import Literal

from ...base.files.file_model import FileModel

__all__ = ["Explained", "Relaxed"]


class Relaxed(FileModel):
    """One relaxation of the task, and what became of it.

    Attributes:
        kind: `contact` (left out), `joint limit` (widened) or `region` (made larger).
        name: of what is relaxed.
        verdict: `solved` where the task is then possible, `infeasible` where it is proved not to be, or
            `undecided`.
        words: the same for people.
    """

    kind: Literal["contact", "joint limit", "region"]
    name: str
    verdict: Literal["solved", "infeasible", "undecided"]
    words: str


class Explained(FileModel):
    """What, relaxed alone, would make an infeasible task possible.

    Attributes:
        budget: time that all relaxations had together, in s.
        whole: whether all were looked at within it.
        relaxations: what helps first.
        friction: where friction is what lacks: how much would do, as far as is known; else empty.
    """

    budget: float
    whole: bool
    relaxations: list[Relaxed] = []
    friction: str = ""
