"""Replays the tree of a log of statics: boxes of points of an object's regions, split or shown something of.

What is shown of a leaf is seen to by `statics` and `load`. Everything is worked out in whole numbers or
fractions, so nothing is rounded; numbers of the log are taken as they stand.
"""

from abc import abstractmethod
from fractions import Fraction
from itertools import product
from typing import Any, NamedTuple

from .exact_regions import PER_UNIT, ExactChart, ExactPart, read_chart
from .hand import HandSystem
from .log_replay import LogReplay, box_name
from .reading import Rejected, indices, items, numbers

__all__ = ["Leaf", "StaticsTree", "whole_numbers"]

_MOST_CONTACTS, _MOST_ROOTS = 12, 4096
_MOST_OPEN = 2_000_000
_DEEPEST = 400
_LARGEST_TWIST = 1 << 40
# Parts of regions that are kept, for boxes share them.
_MOST_KEPT = 4096

Sides = tuple[tuple[Fraction, Fraction], ...]


class Leaf(NamedTuple):
    """A box of which something is claimed.

    Attributes:
        name: of the box.
        sides: of the box.
        twist: six whole numbers.
        hints: what else its record holds.
    """

    name: str
    sides: Sides
    twist: list[int]
    hints: dict[str, Any]


class StaticsTree(LogReplay):
    """Walks through the tree of boxes; what has been split or is a leaf is no longer open.

    Attributes:
        boxes: boxes replayed.
        steps: twists among them, and steps of trees that show that a hand reaches nothing in a box.
        hand: the hand that it is about; None where it is about any.
        claimed: what the log claims, once all of it is seen to.
    """

    claim = ""
    """What the last record says a number of."""
    largest = 0.0
    """No claim is of more."""
    hints: frozenset[str] = frozenset()
    """Keys of a leaf's record beside its box and twist."""

    def __init__(self) -> None:
        super().__init__()
        self.claimed: float | None = None
        self.hand: HandSystem | None = None
        self._open: dict[str, Sides] = {}
        self._leaves: list[Leaf] = []
        self._parts: dict[tuple[int, int, Sides], ExactPart] = {}
        self._charts: list[list[ExactChart]] = []

    @abstractmethod
    def _read_form(self, form: dict[str, Any], n_contacts: int) -> None:
        """Takes what the form says beside regions, centre and spin arms."""

    @abstractmethod
    def _is_shown(self, leaf: Leaf, value: Fraction) -> bool:
        """Whether a leaf shows what the log claims."""

    def _is_expected(self, form: Any, expected: Any) -> bool:
        """Whether the form is that of the task."""
        return bool(form == expected)

    def _begin(self, form: Any, expected: Any) -> None:
        if self._charts:
            raise Rejected("a second set of regions")
        if not isinstance(form, dict):
            raise Rejected("the regions are missing")
        form, hand = _without_hand(form)
        if expected is not None:
            expected, of_task = _without_hand(expected)
            if not self._is_expected(form, expected):
                raise Rejected("the log's regions and load are not those of the task")
            if hand is not None and hand != of_task:
                raise Rejected("the log's hand is not that of the task")
        contacts = items(form.get("contacts"))
        if not 1 <= len(contacts) <= _MOST_CONTACTS:
            raise Rejected("the number of contacts is out of range")
        centre = [Fraction(x) for x in numbers(form.get("centre_m"), 3).tolist()]
        arms = numbers(form.get("spin_arms_m"), len(contacts)).tolist()
        if not all(0.0 <= arm <= 1.0 for arm in arms):
            raise Rejected("a spin arm is out of range")
        self._arms = [PER_UNIT * Fraction(arm) for arm in arms]
        if not float(numbers([form.get("mass_kg")])[0]) > 0.0:
            raise Rejected("the load has no weight")
        self._read_form(form, len(contacts))
        self._charts = [[read_chart(data, centre) for data in items(charts)] for charts in contacts]
        roots = list(product(*(range(len(charts)) for charts in self._charts)))
        if not 1 <= len(roots) <= _MOST_ROOTS:
            raise Rejected("a contact has no region, or too many parts")
        self._roots = roots
        whole = ((Fraction(0), Fraction(1)),) * (2 * len(contacts))
        self._open = {f"{k}/": whole for k in range(len(roots))}
        if hand is not None:
            self.hand = HandSystem(hand, [_is_one_patch(charts) for charts in contacts])

    def _take(self, record: dict[str, Any]) -> None:
        """A box that is split, or a leaf, which is seen to at the end."""
        name = record.get("box")
        if not isinstance(name, str) or name not in self._open:
            raise Rejected("a record is of a box that is not open")
        sides = self._open.pop(name)
        self.boxes += 1
        if set(record) == {"box", "split"}:
            self._split(name, sides, record["split"])
        elif set(record) == {"box", "unreached"} and self.hand is not None:
            self.steps += self.hand.check(name, sides, record["unreached"])
        elif set(record) == {"box", "twist"} | self.hints:
            twist = whole_numbers(name, record["twist"], 6)
            self._leaves.append(Leaf(name, sides, twist, record))
            self.steps += 1
        else:
            raise Rejected(f"box {box_name(name)}: is neither split nor refuted")

    def _split(self, name: str, sides: Sides, cut: Any) -> None:
        """Below and above a value of one parameter, which must lie inside."""
        k, value = items(cut, 2)
        k, at = int(indices([k], len(sides))[0]), Fraction(float(numbers([value])[0]))
        low, high = sides[k]
        if not low < at < high:
            raise Rejected(f"box {box_name(name)}: is split outside itself")
        if len(self._open) >= _MOST_OPEN or len(name) > _DEEPEST:
            raise Rejected("more boxes are open than fit into memory")
        self._open[name + "0"] = (*sides[:k], (low, at), *sides[k + 1 :])
        self._open[name + "1"] = (*sides[:k], (at, high), *sides[k + 1 :])

    def _finish(self, end: Any, digest: str) -> None:
        if not self._charts:
            raise Rejected("the regions are missing")
        if self._open:
            raise Rejected(
                f"{len(self._open)} boxes are left open, the first is {box_name(next(iter(self._open)))}"
            )
        claimed = end.get(self.claim) if isinstance(end, dict) else None
        value = float(numbers([claimed])[0])
        if not 0.0 <= value <= self.largest:
            raise Rejected(f"the {self.claim} is out of range")
        if end != {self.claim: claimed, "boxes": self.boxes, "sha256": digest}:
            raise Rejected("the log was changed after it was written: its checksum or its counts differ")
        for leaf in self._leaves:
            if not self._is_shown(leaf, Fraction(value)):
                raise Rejected(f"box {box_name(leaf.name)}: its twist does not show what is claimed")
        self.claimed = value

    def _parts_of(self, leaf: Leaf) -> list[ExactPart]:
        """The part of each contact's region that a leaf is of."""
        root = self._roots[int(leaf.name.partition("/")[0])]
        return [self._part(i, number, leaf.sides[2 * i : 2 * i + 2]) for i, number in enumerate(root)]

    def _part(self, contact: int, number: int, sides: Sides) -> ExactPart:
        key = (contact, number, sides)
        if key not in self._parts:
            if len(self._parts) >= _MOST_KEPT:
                self._parts.clear()
            self._parts[key] = self._charts[contact][number].over(*sides)
        return self._parts[key]


def _without_hand(form: dict[str, Any]) -> tuple[dict[str, Any], Any]:
    """A form of regions, and what it says of a hand."""
    return {key: value for key, value in form.items() if key != "hand"}, form.get("hand")


def _is_one_patch(charts: Any) -> bool:
    """Whether a region is one patch, whose parameters are those of its chart."""
    return len(items(charts)) == 1 and isinstance(charts[0], dict) and "patch" in charts[0]


def whole_numbers(name: str, data: Any, count: int) -> list[int]:
    """So many whole numbers of a box's record.

    Raises:
        Rejected: they are none.
    """
    found = items(data, count)
    if not all(type(x) is int and abs(x) <= _LARGEST_TWIST for x in found):
        raise Rejected(f"box {box_name(name)}: has something other than {count} whole numbers")
    return found
