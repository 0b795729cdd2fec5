"""What a search has looked at, which step refused how much of it, and what to change."""

from dataclasses import dataclass, field
from math import ceil, floor

from ...base.text.plain_text import counted
from .outcome import Outcome

__all__ = ["Tried"]

# A smaller share of the surface that can't be touched goes without saying.
_MENTIONED = 0.2
# So many contacts hands reach as a rule, if they reach at all.
_FEW_CONTACTS = 3


@dataclass
class Tried:
    """What a search has looked at, and which step refused how much of it.

    Attributes:
        contacts: pairs of regions in a task.
        most_contacts: how many a task with the hand can have.
        sites: places on the object.
        covered: share of the surface that lies under convex pieces, so that nothing can touch it.
        combinations: sets of places with force closure.
        carrying: of these, those with which fingers of the hand's strength carry the object.
        choices: choices of fingers, for each combination.
        tasks: combinations with fingers that were tried.
        askew: of these, those whose places are more askew than flat pads of the hand can be.
        unreached: those for which the solver found no certified configuration in its time.
        sinking: those whose configurations could not be freed of penetration.
        weak: those whose configurations are clear, but can't carry the load.
        askew_deg: of two places that the object can be held by, by how much they miss to face each other, at
            least, where that is more than the regions of the hand can; None where other places were found.
        apart_m: how far two such places are apart, at least, where that is more than the hand opens.
        opening_m: how far it opens; None where it is not known, or not the matter.
        blocking: how often which two bodies kept a configuration from being clear.
    """

    contacts: int
    most_contacts: int = 5
    sites: int = 0
    covered: float = 0.0
    combinations: int = 0
    carrying: int = 0
    choices: int = 0
    tasks: int = 0
    askew: int = 0
    unreached: int = 0
    sinking: int = 0
    weak: int = 0
    askew_deg: float | None = None
    apart_m: float | None = None
    opening_m: float | None = None
    blocking: dict[tuple[str, str], int] = field(default_factory=dict)

    def count(self, outcome: Outcome) -> None:
        """Takes a try into account."""
        self.tasks += 1
        self.askew += outcome.step == "askew"
        self.unreached += outcome.step == "unreached"
        self.sinking += outcome.step == "sinking"
        self.weak += outcome.step == "weak"
        if outcome.askew_deg is not None:
            self.askew_deg = min(outcome.askew_deg, self.askew_deg or outcome.askew_deg)
        for pair in outcome.blocking:
            self.blocking[pair] = self.blocking.get(pair, 0) + 1

    def __str__(self) -> str:
        """A line for people."""
        tried = (
            f"{counted(self.contacts, 'contact')}: {counted(self.sites, 'place')} on the surface, "
            f"{counted(self.combinations, 'combination')} with force closure, "
            f"{counted(self.choices, 'choice')} of fingers, {self.tasks} tried"
        )
        if self.combinations and not self.carrying:
            tried += " (all weak for the weight)"
        if self.covered > _MENTIONED:
            tried += f", {self.covered:.0%} of the surface lies under convex pieces"
        counts = (
            (self.askew, "askew"),
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
    def more_contacts(self) -> str:
        """The advice to take one contact more, with a comma behind it; empty where the hand has no more."""
        return f"--contacts {self.contacts + 1}, " if self.contacts < self.most_contacts else ""

    @property
    def remedy(self) -> str:
        """What to change where nothing was found."""
        if not self.sites and not self.covered:
            return "reading the mesh and cutting it took all of the time: try a larger --budget"
        if not self.sites:
            return "all of the surface lies under convex pieces: see what `holdfast objects` says of the mesh"
        if not self.combinations:
            return self._remedy_of_places()
        worst = max(self.askew, self.unreached, self.sinking, self.weak)
        if worst and worst == self.askew:
            return self._remedy_of_askew()
        if not self.carrying:
            return f"the places are weak: try {self.more_contacts}a larger --friction, or a smaller --mass"
        if not worst:
            return "nothing was tried in time: try a larger --budget"
        if worst == self.weak:
            return (
                f"what the hand reaches slips or is too heavy: try {self.more_contacts}a larger --friction, "
                "or a smaller --mass"
            )
        if worst == self.sinking:
            other = "try another --contacts, " if self.most_contacts > 2 else "try "
            return f"the hand gets there only through something: {other}another --hand, or a larger --budget"
        fewer = f"--contacts {self.contacts - 1}, " if self.contacts > _FEW_CONTACTS else ""
        others = "another --hand, check the mesh's units, or a larger --budget"
        return f"the fingers do not reach: try {fewer}{others}"

    def _remedy_of_places(self) -> str:
        """Where no places go together that the hand could take."""
        if self.apart_m is not None and self.opening_m is not None:
            return (
                f"the hand opens to {1e3 * self.opening_m:.0f} mm, and places that carry it are "
                f"{floor(1e3 * self.apart_m + 1e-6)} mm apart at least: try another --hand, or check the "
                "mesh's units (--units, --scale)"
            )
        if self.askew_deg is not None:
            return self._remedy_of_askew()
        more = "or more --contacts" if self.contacts < self.most_contacts else "or another --hand"
        return f"no places oppose each other within friction: try a larger --friction, {more}"

    def _remedy_of_askew(self) -> str:
        askew_deg = self.askew_deg or 0.0
        return (
            "the hand's flat pads stay parallel, and places that carry it face each other "
            f"{askew_deg:.0f} deg askew at best: try a hand whose fingers bend, or a task with "
            f"align_within_deg: {max(1, ceil(0.5 * askew_deg))} at both contacts"
        )
