"""Which part of a split a candidate belongs to: by its object, by its hand, by the kind of its task."""

import zlib
from collections import Counter
from collections.abc import Sequence

from ...objects.families import FAMILIES
from .part import Part

__all__ = ["held_out_kinds", "split_by_hand", "split_by_object", "split_by_task"]

# Of ten objects of a kind in turn, by their rank; a larger data set leaves those of a smaller one in place.
_VALID, _TEST = (5,), (3, 8)
_CYCLE = 10
# Each family begins elsewhere, so that of the first objects of all families some are for tests as well.
_APART = 3
_LEAST_SHARE = 0.2


def split_by_object(part: Part) -> str:
    """A part of the split by object: seven, one and two of ten of each family."""
    assert part.told is not None
    names = list(FAMILIES)
    family = part.told.family
    first = _APART * names.index(family) if family in names else zlib.crc32(family.encode())
    turn = (part.rank + first) % _CYCLE
    return "test" if turn in _TEST else "valid" if turn in _VALID else "train"


def split_by_hand(part: Part, hands: Sequence[str]) -> str:
    """A part of the split by hand: the last of several hands is for tests."""
    assert part.told is not None
    if len(hands) > 1 and part.told.hand == hands[-1]:
        return "test"
    return "valid" if split_by_object(part) == "valid" else "train"


def split_by_task(part: Part, held_out: frozenset[str]) -> str:
    """A part of the split by kind of task."""
    assert part.told is not None
    if part.told.kind in held_out:
        return "test"
    return "valid" if split_by_object(part) == "valid" else "train"


def held_out_kinds(parts: Sequence[Part]) -> frozenset[str]:
    """Kinds of tasks for tests: the rarest, until they make up a fifth; none where there is but one kind."""
    counts = Counter(part.told.kind for part in parts if part.told is not None)
    chosen: set[str] = set()
    for kind, _ in sorted(counts.items(), key=lambda entry: (entry[1], entry[0]))[:-1]:
        if sum(counts[other] for other in chosen) >= _LEAST_SHARE * counts.total():
            break
        chosen.add(kind)
    return frozenset(chosen)
