"""Tasks for an object that has none."""

from pathlib import Path

from ..arguments import check_budget, check_whole_number
from ..hands import Hand, load_hand
from ..objects import ObjectModel, ObjectSource, load_object
from ..pipeline.suggest import Suggestions
from ..pipeline.suggest import suggest as suggest_for

__all__ = ["suggest"]


def suggest(
    obj: ObjectModel | ObjectSource,
    hand: Hand | str | Path = "sa",
    *,
    contacts: int | None = None,
    count: int = 5,
    seed: int = 0,
    budget_s: float = 60.0,
) -> Suggestions:
    """Tasks with force closure that a hand can reach, the best first; empty only after all of the budget.

    Each comes with a grasp of it that is certified, clear and carries the load. `tried` says what was looked
    at, and which step refused how much.

    Args:
        obj: an object, or anything that `hf.load_object` takes, such as the path of a mesh.
        hand: a hand, the name of a built-in one, or the path of a hand file.
        contacts: how many pairs a task has, at least two; None for as few as can carry the object.
        count: how many suggestions are wanted.
        seed: the same seed gives the same suggestions, unless the budget ends the search.
        budget_s: time after which nothing new is tried.

    Raises:
        InputError: an argument that can't be used.
    """
    return suggest_for(
        hand if isinstance(hand, Hand) else load_hand(hand),
        obj if isinstance(obj, ObjectModel) else load_object(obj),
        contacts=None if contacts is None else check_whole_number("contacts", contacts, least=2),
        count=check_whole_number("count", count, least=1),
        seed=check_whole_number("seed", seed, least=0),
        budget_s=check_budget("budget_s", budget_s),
    )
