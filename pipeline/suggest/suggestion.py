"""Suggestions: tasks that a hand can do, each with a grasp that shows it."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import overload

from ...grasping import ReadyGrasp
from ...mjcf import Quality
from ...objects import Task
from ...solver import Configuration
from .tried import Tried

__all__ = ["Suggestion", "Suggestions"]


@dataclass(frozen=True, eq=False)
class Suggestion:
    """A task that the hand can do.

    Attributes:
        task: hand, object and pairs of regions.
        grasp: of a certified configuration that is clear, with a squeeze that carries the load; the best of
            those found.
        reach: certified configurations found for each box that the solver looked into, in (0, 1]: how
            easily the hand reaches the regions.
    """

    task: Task
    grasp: ReadyGrasp
    reach: float

    @property
    def configuration(self) -> Configuration:
        """Where hand and object are: certified, and nothing sinks in."""
        return self.grasp.configuration

    @property
    def quality(self) -> Quality:
        """Analytic measures of the configuration."""
        return self.grasp.quality

    @property
    def score(self) -> float:
        """What suggestions are ranked by: force closure times reach."""
        return self.quality.epsilon * self.reach

    @property
    def touching(self) -> str:
        """The pairs of regions for a person: names, or where a region lies on the object, in mm."""
        pairs = []
        for contact in self.task.contacts:
            point, _ = contact.object.region.middle()
            place = " ".join(f"{1e3 * x:.0f}" for x in point)
            name = contact.object.name
            pairs.append(f"{contact.hand.name} " + (f"at {place}" if name == "inline" else f"on {name}"))
        return ", ".join(pairs)


@dataclass(frozen=True, eq=False)
class Suggestions(Sequence[Suggestion]):
    """What a search has found, the best first.

    Attributes:
        found: the suggestions.
        tried: what was looked at.
    """

    found: tuple[Suggestion, ...]
    tried: Tried

    def __len__(self) -> int:
        return len(self.found)

    @overload
    def __getitem__(self, index: int) -> Suggestion: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Suggestion]: ...
    def __getitem__(self, index: int | slice) -> Suggestion | Sequence[Suggestion]:
        return self.found[index]

    def __str__(self) -> str:
        lines = [f"{s.touching}: epsilon {s.quality.epsilon:.3f} N, reach {s.reach:.2f}" for s in self.found]
        return "\n".join(lines) if lines else f"no suggestion: {self.tried}; {self.tried.remedy}"

    def __repr__(self) -> str:
        return f"<{len(self)} suggestions>"
