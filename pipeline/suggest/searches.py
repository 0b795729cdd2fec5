"""Which searches an object and a hand are worth, and suggestions of the first of them."""

from collections.abc import Callable

from ...errors import InputError
from ...hands import Hand
from ...objects import ObjectModel
from .fingers import MOST_CONTACTS
from .prospects import SurfaceProspects
from .search import Search
from .suggestion import Suggestions
from .wall_prospects import WALL_CONTACTS, WallProspects, has_pad_edges

__all__ = ["searches", "suggest"]

_FEWEST_CONTACTS = 2
# Found suggestions for each one wanted, before the best are picked.
_REACHED = 2


def suggest(
    hand: Hand,
    obj: ObjectModel,
    *,
    contacts: int | None = None,
    count: int = 5,
    seed: int = 0,
    budget_s: float = 60.0,
    on_progress: Callable[[int, int], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> Suggestions:
    """Tasks that the hand can do on an object, the best first; empty only after all of the budget.

    The object's named regions and places all over its surface are combined; what friction can hold is tried
    with the fingertips of the hand, later with all its regions. It counts once the solver has certified a
    configuration, retraction has made it clear, and forces of the hand carry the load in it.

    Args:
        hand: the hand; regions named `<finger>/tip` are its fingertips, else all its regions are.
        obj: the object.
        contacts: how many pairs a task has, at least two; None for as few as can carry the object.
        count: how many suggestions are wanted.
        seed: the same seed gives the same suggestions, unless the budget ends the search.
        budget_s: time after which nothing new is tried.
        on_progress: called with the tries done and the suggestions found.
        should_stop: asked between tries.

    Raises:
        InputError: the hand has fewer fingertips than contacts are asked for.
    """
    search = searches(hand, obj, contacts, seed)[0]
    found = search.more(
        _REACHED * count,
        budget_s=budget_s,
        should_stop=should_stop or (lambda: False),
        on_progress=on_progress,
    )
    return Suggestions(tuple(sorted(found, key=lambda s: -s.score)[:count]), search.tried)


def searches(hand: Hand, obj: ObjectModel, contacts: int | None = None, seed: int = 0) -> list[Search]:
    """Searches that are worth their time, the fewest contacts first.

    Of one number of contacts where it is given; else of the fewest with which places on the object can carry
    it, and of one more. Where none can, of all numbers that the hand has fingers for. Jaws with flat pads
    also look for hollow walls, where the object has such.

    Raises:
        InputError: as of `SurfaceProspects`.
    """
    walls = _walls(hand, obj, seed) if contacts in (None, WALL_CONTACTS) else []
    if contacts is not None:
        try:
            return [*walls, Search(SurfaceProspects(hand, obj, contacts), seed)]
        except InputError:
            if walls:
                return walls
            raise
    found: list[Search] = []
    for count in range(_FEWEST_CONTACTS, MOST_CONTACTS + 1):
        try:
            found.append(Search(SurfaceProspects(hand, obj, count), seed))
        except InputError:
            if not found:
                raise
            break  # the hand has no more fingers
    for i, search in enumerate(found):
        if search.can_carry():
            found = found[i : i + 2]
            break
    return [found[0], *walls, *found[1:]]


def _walls(hand: Hand, obj: ObjectModel, seed: int) -> list[Search]:
    """The search for hollow walls, where the hand has pads for it and the object such a wall."""
    if not has_pad_edges(hand):
        return []
    search = Search(WallProspects(hand, obj), seed)
    return [search] if search.can_carry() else []
