"""Which fingers of a hand may touch an object together."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import permutations
from math import perm

import numpy as np

from ...errors import InputError
from ...hands import Hand, HandRegion

__all__ = ["MOST_CONTACTS", "finger_choices", "finger_regions", "most_contacts"]

MOST_CONTACTS = 5
"""Pairs of regions that a task has at most here."""
# Choices of fingers looked at: of more, a sample.
_MOST_CHOICES = 60
_MOST_ORDERS = 5000


def finger_regions(hand: Hand, contacts: int) -> tuple[list[HandRegion], list[HandRegion]]:
    """The fingertips, and all regions; the thumb first, as it opposes the others.

    Where fingertips are fewer than contacts, all regions stand for them.

    Args:
        hand: regions named `<finger>/tip` are its fingertips.
        contacts: pairs of regions in a task.

    Raises:
        InputError: the hand has regions on fewer links than contacts are asked for, or these are too many.
    """
    everything = sorted(hand.regions.values(), key=lambda region: not _is_thumb(region))
    tips = [region for region in everything if region.name.endswith("/tip")]
    if _links(tips) < contacts:
        tips = everything
    links = _links(tips)
    if links < contacts:
        raise InputError(
            "suggest",
            "contacts",
            f"hand {hand.name} has regions on {links} links, so at most {links} contacts",
        )
    if contacts > MOST_CONTACTS:
        raise InputError("suggest", "contacts", f"must be at most {MOST_CONTACTS}, not {contacts}")
    return tips, everything


def most_contacts(hand: Hand) -> int:
    """How many contacts a task of the hand can have here."""
    return min(MOST_CONTACTS, _links(hand.regions.values()))


def finger_choices(regions: Sequence[HandRegion], contacts: int, seed: int) -> list[tuple[HandRegion, ...]]:
    """Regions of as many links as contacts, in every order; with a thumb, where there is one.

    Args:
        regions: to choose from.
        contacts: how many touch at once.
        seed: of the sample that is taken where there are very many.
    """
    choices = [choice for choice in _ordered(regions, contacts, seed) if _links(choice) == contacts]
    choices = [choice for choice in choices if any(map(_is_thumb, choice))] or choices
    if len(choices) <= _MOST_CHOICES:
        return choices
    chosen = np.random.default_rng(seed).choice(len(choices), _MOST_CHOICES, replace=False)
    return [choices[i] for i in sorted(chosen)]


def _ordered(regions: Sequence[HandRegion], contacts: int, seed: int) -> Iterator[tuple[HandRegion, ...]]:
    """Regions in every order, or in orders drawn at random where they are very many."""
    if perm(len(regions), contacts) <= _MOST_ORDERS:
        return permutations(regions, contacts)
    rng = np.random.default_rng(seed)
    drawn = {tuple(rng.permutation(len(regions))[:contacts].tolist()) for _ in range(_MOST_ORDERS)}
    return (tuple(regions[i] for i in order) for order in sorted(drawn))


def _links(regions: Iterable[HandRegion]) -> int:
    """On how many links they are."""
    return len({region.link for region in regions})


def _is_thumb(region: HandRegion) -> bool:
    return region.name.startswith("thumb")
