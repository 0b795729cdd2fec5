"""Suggestions: tasks that a hand can do, each with a grasp that shows it, and what was tried on the way."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import ceil
from typing import overload

from ...grasping import ReadyGrasp
from ...mjcf import Quality
from ...objects import Task
from ...plain_text import counted
from ...solver import Configuration

__all__ = ["Suggestion", "Suggestions", "Tried"]

# A smaller share of the surface that can't be touched goes without saying.
_MENTIONED = 0.2


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


@dataclass
class Tried:
    """What a search has looked at, and which step refused how much of it.

    Attributes:
        contacts: pairs of regions in a task.
        sites: places on the object.
        covered: share of the surface that lies under convex pieces, so that nothing can touch it.
        combinations: sets of places with force closure.
        carrying: of these, those with which fingers of the hand's strength carry the object.
        choices: choices of fingers, for each combination.
        tasks: combinations with fingers that were tried.
        unreached: of these, those for which the solver found no certified configuration in its time.
        sinking: those whose configurations could not be freed of penetration.
        weak: those whose configurations are clear, but can't carry the load.
        askew_deg: of two places that the object can be held by, by how much they miss to face each other, at
            least, where that is more than the regions of the hand can; None where other places were found.
        blocking: how often which two bodies kept a configuration from being clear.
    """

    contacts: int
    sites: int = 0
    covered: float = 0.0
    combinations: int = 0
    carrying: int = 0
    choices: int = 0
    tasks: int = 0
    unreached: int = 0
    sinking: int = 0
    weak: int = 0
    askew_deg: float | None = None
    blocking: dict[tuple[str, str], int] = field(default_factory=dict)

    def __str__(self) -> str:
        """A line for people."""
        tried = (
            f"{counted(self.contacts, 'contact')}: {counted(self.sites, 'place')} on the surface, "
            f"{counted(self.combinations, 'combination')} "
            f"with force closure, {counted(self.choices, 'choice')} of fingers, {self.tasks} tried"
        )
        if self.combinations and not self.carrying:
            tried += " (all weak for the weight)"
        if self.covered > _MENTIONED:
            tried += f", {self.covered:.0%} of the surface lies under convex pieces"
        counts = (
            (self.unreached, "not reached"),
            (self.sinking, f"sink in{self._worst_pair()}"),
            (self.weak, "can't carry the load"),
        )
        refused = ", ".join(f"{count} {word}" for count, word in counts if count)
        return f"{tried}; {refused}" if refused else tried

    def _worst_pair(self) -> str:
        if not self.blocking:
            return ""
        a, b = max(self.blocking, key=lambda pair: self.blocking[pair])
        return f" (most often {a} and {b})"

    @property
    def remedy(self) -> str:
        """What to change where nothing was found."""
        if not self.sites and not self.covered:
            return "reading the mesh and cutting it took all of the time: try a larger --budget"
        if not self.sites:
            return "all of the surface lies under convex pieces: see what `holdfast objects` says of the mesh"
        if not self.combinations and self.askew_deg is not None:
            room = ceil(0.5 * self.askew_deg)
            return (
                "the jaws stay parallel, and places that carry it face each other "
                f"{self.askew_deg:.0f} deg askew at best: try a hand whose fingers bend, or a task with "
                f"align_within_deg: {room} at both contacts"
            )
        if not self.combinations:
            return "no places oppose each other within friction: try a larger --friction, or more --contacts"
        if not self.carrying:
            return "the places are weak: try more --contacts, a larger --friction, or a smaller --mass"
        worst = max(self.unreached, self.sinking, self.weak)
        if not worst:
            return "nothing was tried in time: try a larger --budget"
        if worst == self.weak:
            return "what the hand reaches slips or is too heavy: try more --contacts, or a smaller --mass"
        if worst == self.sinking:
            return "the hand gets there only through something: try other --contacts, or another --hand"
        return "the fingers do not reach: try another --hand, check the mesh's units, or a larger --budget"


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
