"""What a data set is to hold, and the situations of choice that make it up."""

import re
import zlib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ...arguments import check_whole_number
from ...errors import InputError, UnknownName
from ...hands import load_hand
from ...objects import load_object
from ...objects.families import FAMILIES, FAMILY_PREFIX
from ..choice import FREE_FEATURES, DrawRanges

__all__ = ["DatasetPlan", "SituationPlan"]

_MOST_LOADS = 8


@dataclass(frozen=True)
class SituationPlan:
    """One situation to be made.

    Attributes:
        object: reference of the object.
        hand: reference of the hand.
        rank: place of the object among those of its kind, which decides its part of the split.
    """

    object: str
    hand: str
    rank: int

    @property
    def key(self) -> str:
        """A name for its file, the same in every data set."""
        plain = re.sub(r"[^A-Za-z0-9]+", "-", f"{self.object}-{Path(self.hand).stem}").strip("-")[-80:]
        # Two meshes may have one name.
        return f"{plain}-{zlib.crc32(f'{self.object}@{self.hand}'.encode()):08x}"


@dataclass(frozen=True)
class DatasetPlan:
    """What is asked for.

    Attributes:
        families: of which objects are taken in turn.
        objects: how many of families.
        first_seed: seed of the first member of each family.
        references: further objects: built-in ones, meshes, object files, or tasks.
        hands: names or files of hands.
        one_hand: whether each object is for one of the hands alone, in turn, in place of all.
        candidates: of a situation, at most.
        draws: hidden draws of a situation.
        loads: multiples of the load, ascending.
        seed: of solver, search and draws.
        ranges: what is drawn.

    Raises:
        InputError: a value that can't be used.
    """

    families: tuple[str, ...] = tuple(FAMILIES)
    objects: int = 12
    first_seed: int = 0
    references: tuple[str, ...] = ()
    hands: tuple[str, ...] = ("sa",)
    one_hand: bool = False
    candidates: int = 8
    draws: int = 3
    loads: tuple[float, ...] = (1.0, 2.0)
    seed: int = 0
    ranges: DrawRanges = field(default_factory=DrawRanges)

    def __post_init__(self) -> None:
        check_whole_number("objects", self.objects, least=0)
        check_whole_number("candidates", self.candidates, least=2)
        check_whole_number("draws", self.draws, least=1)
        for family in self.families:
            if family not in FAMILIES:
                raise UnknownName("families", "", "family", family, FAMILIES)
        for name in ("families", "references", "hands"):
            values = getattr(self, name)
            if len(set(values)) < len(values):
                raise InputError(name, "", "names something twice")
        if not self.hands:
            raise InputError("hands", "", "must name at least one hand")
        if not (self.objects and self.families) and not self.references:
            raise InputError(
                "objects", "", "must be at least 1, of at least one family, or name other objects"
            )
        loads = self.loads
        if not 0 < len(loads) <= _MOST_LOADS or list(loads) != sorted(set(loads)) or not loads[0] > 0.0:
            raise InputError("loads", "", f"must be at most {_MOST_LOADS} numbers above 0, ascending")

    def check(self) -> None:
        """Looks whether everything that is named can be loaded.

        Raises:
            InputError: what can't, and why.
        """
        names: dict[str, str] = {}
        for hand in self.hands:
            name = load_hand(hand, source="hands").name
            if name in names:
                raise InputError("hands", "", f"{names[name]} and {hand} have the same name, {name}")
            names[name] = hand
        for reference in self.references:
            load_object(reference, source="objects")

    def situations(self) -> list[SituationPlan]:
        """What is to be made, objects in turn and each with all hands, or with the one whose turn it is."""
        every, hands = self.pairs(), len(self.hands)
        if not self.one_hand:
            return every
        # A step more after each row of families, or a family would always get the same hand.
        row = len(self.families) or 1
        return [every[i * hands + (i + i // row) % hands] for i in range(len(every) // hands)]

    def pairs(self) -> list[SituationPlan]:
        """Every object with every hand, objects in turn."""
        count = len(self.families)
        members = [
            (
                f"{FAMILY_PREFIX}{self.families[i % count]}:{self.first_seed + i // count}",
                self.first_seed + i // count,
            )
            for i in range(self.objects if count else 0)
        ]
        others = [(reference, k) for k, reference in enumerate(self.references)]
        return [
            SituationPlan(reference, hand, rank)
            for reference, rank in [*members, *others]
            for hand in self.hands
        ]

    @property
    def recipe(self) -> dict[str, Any]:
        """What every part depends on: parts of plans with the same recipe may be put together."""
        return {
            "candidates": self.candidates,
            "draws": self.draws,
            "loads": list(self.loads),
            "seed": self.seed,
            "ranges": self.ranges.as_record(),
            "features": len(FREE_FEATURES),
        }
