"""What is wrong with a given grasp, by what was measured of it."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass

from ...hands import Hand
from ...objects import ObjectModel
from .balance import Carried, carried_multiples
from .measured import INTENDED_M, Measured, Touch
from .reading import finger_links

__all__ = ["NOTHING", "Fault", "find_faults"]

# Deeper than this is said to sink in.
_DEPTH_M = 5e-4
NOTHING = 1e-3
"""Contacts that carry less of the object's weight balance nothing."""
# A finger that is off is missed where the others carry less than the weight, and less than this share of what
# they would carry with it.
_MISSED = 1.0 / 3.0


@dataclass(frozen=True)
class Fault:
    """Something wrong with a grasp.

    Attributes:
        kind: `penetration`, `finger off`, `joint limits`, `coupling`, `no contact` or `balance`.
        text: in words, with figures.
    """

    kind: str
    text: str

    def __str__(self) -> str:
        return self.text


def find_faults(
    hand: Hand,
    obj: ObjectModel,
    given: Measured,
    touching: Sequence[Touch],
    carried: Carried,
    off_m: Mapping[str, float],
    meant: Collection[str] | None = None,
) -> tuple[Fault, ...]:
    """The faults of a grasp, the gravest first.

    Args:
        hand: the hand.
        obj: the object, in its size.
        given: the grasp.
        touching: those of its touches that press.
        carried: what they carry, and would with those that are near.
        off_m: by finger that is near but doesn't touch, how far it is off.
        meant: links or regions that touch by the file's own word; None where it doesn't say.
    """
    found = [] if given.touches else [Fault("no contact", "no finger is near the object")]
    found += [
        Fault("joint limits", f"{name} is {excess:.3g} rad or m beyond its limit")
        for name, excess in given.beyond_limits.items()
    ]
    found += [
        Fault("coupling", f"{name} is {off:.3g} rad or m off what drives it")
        for name, off in given.astray.items()
    ]
    found += [Fault("penetration", str(pair)) for pair in given.sunk if pair.depth_m > _DEPTH_M]
    least, most, closed = carried
    if least < NOTHING and len(obj.parts) > 1:
        # A lid is held where its pot would not be carried.
        alone = carried_multiples(hand, obj, given, touching, touched_alone=True)
        least, most = max(least, alone[0]), max(most, alone[1])
    is_missed = least < NOTHING or least < min(1.0, _MISSED * closed)
    found += [Fault("finger off", text) for text in _amiss(hand, given, off_m, is_missed, meant)]
    if given.touches and most < NOTHING:
        found.append(Fault("balance", "no forces within friction balance where fingers touch"))
    return tuple(found)


def _amiss(
    hand: Hand,
    given: Measured,
    off_m: Mapping[str, float],
    is_missed: bool,
    meant: Collection[str] | None,
) -> Iterator[str]:
    """Of fingers that don't touch those that should, in words.

    A file may say what touches. Where it doesn't, a finger that is near may have no part in the grasp; but
    something is missing where those that touch carry nothing in some direction, or too little.
    """
    off = {finger: f"{finger} is {1e3 * gap_m:.2g} mm off the object" for finger, gap_m in off_m.items()}
    if meant is None:
        yield from off.values() if is_missed else ()
        return
    at = {touch.finger for touch in given.touches} - off.keys()
    for finger in sorted(_fingers_of(hand, meant) - at):
        yield off.get(finger, f"{finger} is more than {1e3 * INTENDED_M:.2g} mm off the object")


def _fingers_of(hand: Hand, names: Collection[str]) -> set[str]:
    """The fingers that links and regions of these names are of; unknown names say nothing."""
    links = {link.name: i for i, link in enumerate(hand.links)}
    links |= {name: region.link for name, region in hand.regions.items()}
    known = {links[name] for name in names if name in links}
    return {finger for finger, parts in finger_links(hand).items() if known & set(parts.tolist())}
