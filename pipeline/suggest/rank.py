"""Suggestions: combinations of sites, with the fingers that reach them, ranked by what they promise."""

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import permutations

from ...errors import InputError
from ...hands import Hand, HandRegion
from ...mjcf import Quality, grasp_quality
from ...objects import Contact, ObjectModel, ObjectRegion, Task
from ...solver import Configuration, solve
from .screen import Combination, screen
from .surface import middle, sites

__all__ = ["Suggestion", "suggest"]

# Configurations asked for in each try, and the time it may take.
_CANDIDATES = 4
_TRY_S = 2.0
# Combinations of sites that are tried, and those that are reached before the best are picked, for each
# suggestion wanted.
_TRIED = 6
_REACHED = 2


@dataclass(frozen=True, eq=False)
class Suggestion:
    """A task that the hand can do.

    Attributes:
        task: hand, object and pairs of regions.
        configuration: a certified configuration of it, the best of those found.
        quality: analytic measures of that configuration.
        reach: certified configurations found for each box that the solver looked into, in (0, 1]: how
            easily the hand reaches the regions.
    """

    task: Task
    configuration: Configuration
    quality: Quality
    reach: float

    @property
    def score(self) -> float:
        """What suggestions are ranked by: force closure times reach."""
        return self.quality.epsilon * self.reach

    @property
    def touching(self) -> str:
        """The pairs of regions for a person: names, or where a patch lies on the object, in mm."""
        pairs = []
        for contact in self.task.contacts:
            point, _ = middle(contact.object.region)
            place = " ".join(f"{1e3 * x:.0f}" for x in point)
            name = contact.object.name
            pairs.append(f"{contact.hand.name} " + (f"at {place}" if name == "inline" else f"on {name}"))
        return ", ".join(pairs)


def suggest(
    hand: Hand,
    obj: ObjectModel,
    *,
    contacts: int = 2,
    count: int = 5,
    seed: int = 0,
    budget_s: float = 60.0,
    on_progress: Callable[[int, int], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> list[Suggestion]:
    """Tasks with force closure that the hand can reach, the best first; empty where none was found.

    The object's named regions and patches fitted to its surface are combined; what friction can hold is
    tried with the fingertips of the hand, and counts once the solver has certified a configuration of it.

    Args:
        hand: the hand; regions named `<finger>/tip` are its fingertips, else all its regions are.
        obj: the object.
        contacts: how many pairs a task has, at least two.
        count: how many suggestions are wanted.
        seed: the same seed gives the same suggestions, unless the budget ends the search.
        budget_s: time after which nothing new is tried.
        on_progress: called with the tries done and the suggestions found.
        should_stop: asked between tries.

    Raises:
        InputError: the hand has fewer fingertips than contacts are asked for.
    """
    started = time.monotonic()
    tips = _fingertips(hand, contacts)
    combinations = screen(obj, sites(obj, seed), contacts, _TRIED * count, seed)
    found: dict[Combination, Suggestion] = {}
    for tried, (combination, regions) in enumerate(_tries(combinations, tips, contacts), start=1):
        over = time.monotonic() - started > budget_s or (should_stop is not None and should_stop())
        if over or len(found) >= _REACHED * count:
            break
        if combination in found:
            continue
        suggestion = _try(hand, obj, combination, regions, seed)
        if suggestion is not None and suggestion.score > 0.0:
            found[combination] = suggestion
        if on_progress is not None:
            on_progress(tried, len(found))
    return sorted(found.values(), key=lambda s: -s.score)[:count]


def _fingertips(hand: Hand, contacts: int) -> list[HandRegion]:
    tips = [region for name, region in hand.regions.items() if name.endswith("/tip")]
    tips = tips or list(hand.regions.values())
    links = {region.link for region in tips}
    if len(links) < contacts:
        raise InputError(
            "suggest",
            "contacts",
            f"hand {hand.name} has regions on {len(links)} links, so at most {len(links)} contacts",
        )
    # The thumb first: it opposes the others.
    return sorted(tips, key=lambda region: not region.name.startswith("thumb"))


def _tries(
    combinations: list[Combination], tips: list[HandRegion], contacts: int
) -> Iterator[tuple[Combination, tuple[HandRegion, ...]]]:
    """Every combination with every choice of fingers: first all combinations with one choice, and so on."""
    choices = [c for c in permutations(tips, contacts) if len({region.link for region in c}) == contacts]
    # A thumb, where there is one, takes part in all.
    thumbs = [c for c in choices if any(region.name.startswith("thumb") for region in c)]
    for choice in thumbs or choices:
        for combination in combinations:
            yield combination, choice


def _try(
    hand: Hand, obj: ObjectModel, combination: Combination, regions: tuple[HandRegion, ...], seed: int
) -> Suggestion | None:
    pairs = tuple(
        Contact(region, ObjectRegion(site.name or "inline", site.region))
        for region, site in zip(regions, combination.sites, strict=True)
    )
    fingers = "_".join(region.name.partition("/")[0] for region in regions)
    task = Task(name=f"{obj.name}_{fingers}", hand=hand, object=obj, contacts=pairs)
    result = solve(task, candidates=_CANDIDATES, seed=seed, budget_s=_TRY_S)
    rated = [(grasp_quality(c), c) for c in result.configurations if c.certified]
    if not rated:
        return None
    quality, configuration = max(rated, key=lambda entry: entry[0].epsilon)
    return Suggestion(task, configuration, quality, len(rated) / result.boxes)
