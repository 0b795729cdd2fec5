"""Policies compared on what they have not seen."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ....base.numeric.arrays import Array, Indices
from ..policies import FORMULA, Prepared, is_learned, train
from ..situations import Names, Situations
from .calibration import Calibration, calibration
from .intervals import Estimate, iqm_over_seeds, mean_over_objects, ratio_over_objects
from .measures import Figures, figures, figures_by_other_draws, oracle_scores
from .splits import Protocol, Split

__all__ = [
    "ORACLE",
    "OTHER_DRAWS",
    "Comparison",
    "Runs",
    "Standing",
    "compare",
    "compare_runs",
    "unseen_scores",
]

ORACLE = "oracle"
"""The name of whoever knows the outcomes."""

OTHER_DRAWS = "other_draws"
"""The name of whoever has tried every candidate in all other draws, but does not know the one to come."""

_USUAL = "first"


@dataclass(frozen=True)
class Standing:
    """What a policy achieves on situations that it has not seen; intervals of 95 % over objects.

    Attributes:
        policy: its name.
        success: share of the draws in which its first choice held.
        iqm: interquartile mean of the same over seeds and families, with runs resampled.
        regret: what is missing to the oracle's share.
        auc: within situations, how likely what held scores above what did not.
        before: tests that fail before the first one that holds.
        saved: share of the failing tests of the usual order that its order saves.
        above_formula: success minus that of the best formula, situation by situation.
        gap_closed: the same as a share of what the oracle has above the best formula.
        calibration: None of a policy that gives no chances.
    """

    policy: str
    success: Estimate
    iqm: Estimate
    regret: Estimate
    auc: Estimate
    before: Estimate
    saved: Estimate
    above_formula: Estimate
    gap_closed: Estimate
    calibration: Calibration | None


@dataclass(frozen=True)
class Comparison:
    """All policies under one load.

    Attributes:
        protocol: what was unseen.
        load: multiple of the object's weight.
        situations: how many were tested.
        objects: of how many objects.
        best_formula: its policy's name: the one with the most success in this very comparison; None where
            there are no formulas.
        standings: of each policy.
    """

    protocol: str
    load: float
    situations: int
    objects: int
    best_formula: str | None
    standings: tuple[Standing, ...]


@dataclass(frozen=True, eq=False)
class Runs:
    """How a policy has scored candidates that it has not seen.

    Attributes:
        scores: (L, N) of each seed.
        are_chances: whether a score is the chance to hold.
    """

    scores: list[Array]
    are_chances: bool


def unseen_scores(policy: str, prepared: Prepared, splits: Sequence[Split], seed: int) -> tuple[Array, bool]:
    """Scores (L, N) of candidates by a policy that was trained without them, and whether these are chances.

    Candidates that no split tests are NaN.
    """
    situations = prepared.situations
    scores = np.full((len(situations.loads), len(situations.features)), np.nan)
    chances = False
    for split in splits:
        trained = train(policy, prepared, split.train, seed=seed)
        rows = situations.rows(split.test)
        for load, head in enumerate(trained.heads):
            scores[load, rows] = prepared.scores(trained, load, rows)
            chances = head.is_chance
    return scores, chances


def compare(
    policies: Sequence[str],
    prepared: Prepared,
    protocol: Protocol,
    *,
    seeds: int = 5,
    say: Callable[[str], None] = lambda text: None,
) -> list[Comparison]:
    """Compares policies, beside them those who know outcomes; a comparison a load.

    Where nothing can be left out there is none.

    Args:
        policies: their names.
        prepared: situations and inputs.
        protocol: what is unseen.
        seeds: how often all is dealt out and trained anew; figures are means over the seeds.
        say: told what is being done.
    """
    situations = prepared.situations
    splits = [list(protocol.splits(situations, seed)) for seed in range(seeds)]
    if not splits or not splits[0]:
        return []
    tested = np.sort(np.concatenate([split.test for split in splits[0]]))
    runs: dict[str, Runs] = {}
    for policy in policies:
        say(f"  unseen {protocol.name}: {policy}")
        # What learns nothing comes out the same with every seed.
        count = seeds if is_learned(policy) else 1
        found = [unseen_scores(policy, prepared, splits[seed], seed) for seed in range(count)]
        runs[policy] = Runs([scores for scores, _ in found], found[0][1])
    return compare_runs(runs, situations, tested, protocol.name)


def compare_runs(runs: dict[str, Runs], whole: Situations, tested: Indices, unseen: str) -> list[Comparison]:
    """Compares policies by the scores that they gave; a comparison a load.

    Args:
        runs: by name.
        whole: G situations with N candidates.
        tested: the situations that count.
        unseen: what was, for the comparison's name.
    """
    return [_compare_under(runs, whole, tested, unseen, load) for load in range(len(whole.loads))]


def _compare_under(
    runs: dict[str, Runs], whole: Situations, tested: Indices, protocol: str, load: int
) -> Comparison:
    situations, rows = whole.take(tested), whole.rows(tested)
    measured = {
        name: [figures(situations, scores[load, rows], load) for scores in entry.scores]
        for name, entry in runs.items()
    }
    measured[ORACLE] = [figures(situations, oracle_scores(situations, load), load)]
    foresight = figures_by_other_draws(situations, load)
    if foresight is not None:
        measured[OTHER_DRAWS] = [foresight]
    means = {name: _mean(found) for name, found in measured.items()}
    formulas = [name for name in means if name.startswith(FORMULA)]
    best = max(formulas, key=lambda name: float(means[name]["success"].mean()), default=None)
    usual = means.get(_USUAL, means[ORACLE])
    standings = []
    for name, found in measured.items():
        entry = runs.get(name)
        standings.append(
            _standing(
                name,
                found,
                situations,
                formula=None if best is None else means[best]["success"],
                usual=usual["before"] if _USUAL in means else None,
                calibrated=_calibration(entry, situations, rows, load) if entry is not None else None,
            )
        )
    return Comparison(
        protocol=protocol,
        load=float(situations.loads[load]),
        situations=len(situations),
        objects=len(np.unique(situations.objects)),
        best_formula=best,
        standings=tuple(standings),
    )


def _standing(
    name: str,
    found: Sequence[Figures],
    situations: Situations,
    *,
    formula: Array | None,
    usual: Array | None,
    calibrated: Calibration | None,
) -> Standing:
    objects = situations.objects
    mean = _mean(found)
    nothing = np.full(len(situations), np.nan)
    above = nothing if formula is None else mean["success"] - formula
    gap = nothing if formula is None else found[0].oracle - formula
    saved = nothing if usual is None else usual - mean["before"]
    return Standing(
        policy=name,
        success=mean_over_objects(mean["success"], objects),
        iqm=iqm_over_seeds(np.array([_by_family(one.success, situations.families) for one in found])),
        regret=mean_over_objects(mean["regret"], objects),
        auc=mean_over_objects(mean["auc"], objects),
        before=mean_over_objects(mean["before"], objects),
        saved=ratio_over_objects(saved, nothing if usual is None else usual, objects),
        above_formula=mean_over_objects(above, objects),
        gap_closed=ratio_over_objects(above, gap, objects),
        calibration=calibrated,
    )


def _mean(found: Sequence[Figures]) -> dict[str, Array]:
    """Means over the seeds, situation by situation."""
    return {name: np.mean([one.by_name[name] for one in found], axis=0) for name in found[0].by_name}


def _by_family(values: Array, families: Names) -> Array:
    return np.array([values[families == family].mean() for family in np.unique(families)])


def _calibration(runs: Runs, situations: Situations, rows: Indices, load: int) -> Calibration | None:
    """Calibration of the chances of all seeds together."""
    if not runs.are_chances:
        return None
    chances = np.concatenate([scores[load, rows] for scores in runs.scores])
    return calibration(chances, np.concatenate([situations.held[:, :, load]] * len(runs.scores)))
