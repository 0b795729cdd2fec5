"""Contacts that can carry their object, chosen from given ones or from an object's named regions."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from itertools import combinations_with_replacement, islice

import numpy as np

from ...geometry import even_directions
from ...hands import Hand, HandRegion
from ..contact import Contact, ObjectRegion
from .carrying import WANTED, Load
from .finger_force import ANY_POSTURE
from .places import Places, contact_places

__all__ = ["PLANNED_FRICTION", "first_that_carries", "others_that_carry"]

PLANNED_FRICTION = 0.7
"""Share of the friction with which contacts that are chosen have to carry: a squeeze is planned with it."""

# Sets of regions that are looked at for one number of contacts.
_MOST_SETS = 50
_FEWEST, _MOST = 2, 5
# Of what is wanted: sets that carry less by a first rough look are not looked at again.
_SHORT_OF = 1.0 - 1e-9


def first_that_carries(hand: Hand, load: Load, grasps: Sequence[Sequence[Contact]]) -> int:
    """The first of several sets of contacts that carry enough with friction to spare; else the strongest.

    Fingers press as in the middle one of their postures: where a finger meets the object it seldom stands as
    its servos would like, and there are other sets.

    Args:
        hand: the hand.
        load: what is to be carried.
        grasps: sets of contacts, at least one, the usual one first.
    """
    spared = replace(load, friction=PLANNED_FRICTION * load.friction)
    multiples = []
    for contacts in grasps:
        points = spared.best(contact_places(contacts, hand, share=ANY_POSTURE), WANTED, polished=False)
        multiples.append(spared.multiple(points))
        if multiples[-1] >= WANTED:
            break
    return multiples.index(max(multiples))


def others_that_carry(
    hand: Hand, load: Load, contacts: Sequence[Contact], regions: Sequence[ObjectRegion]
) -> tuple[Contact, ...] | None:
    """As few contacts as carry enough, at named regions of an object; None where none of those looked at do.

    Which fingers reach them is not asked. Fingers of the given contacts come first, then other fingertips.

    Args:
        hand: the hand.
        load: what is to be carried.
        contacts: those that do not carry enough.
        regions: of the object.
    """
    spared = replace(load, friction=PLANNED_FRICTION * load.friction)
    fingers = _fingers(hand, contacts)

    @cache
    def places(finger: int, region: int) -> Places:
        (found,) = contact_places([Contact(fingers[finger], regions[region])], hand)
        return found

    for count in range(_FEWEST, min(_MOST, len(fingers)) + 1):
        best, most = None, WANTED
        for chosen in islice(combinations_with_replacement(range(len(regions)), count), _MOST_SETS):
            points = _apart([places(finger, region) for finger, region in enumerate(chosen)], chosen)
            if spared.multiple(points, directions=even_directions(0), least=_SHORT_OF * most) < most:
                continue
            if (multiple := spared.multiple(points)) >= most:
                best, most = chosen, multiple
        if best is not None:
            return tuple(Contact(f, regions[k]) for f, k in zip(fingers, best, strict=False))
    return None


def _fingers(hand: Hand, contacts: Sequence[Contact]) -> list[HandRegion]:
    """Regions of different links: those of the contacts, then fingertips."""
    found: dict[int, HandRegion] = {}
    tips = (region for region in hand.regions.values() if region.name.endswith("/tip"))
    for region in (*(contact.hand for contact in contacts), *tips):
        found.setdefault(region.link, region)
    return list(found.values())


def _apart(contacts: Sequence[Places], regions: Sequence[int]) -> list[Places]:
    """A point of each contact: the middle of its region, or where others are there already, far from it."""
    taken: Counter[int] = Counter()
    chosen = []
    for place, region in zip(contacts, regions, strict=True):
        distance = np.linalg.norm(place.points - place.points.mean(axis=0), axis=1)
        order = np.argsort(distance, kind="stable")
        chosen.append(place.at(int(order[-taken[region] % len(order)])))
        taken[region] += 1
    return chosen
