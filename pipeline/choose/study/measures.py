"""How well a policy chooses: figures of each situation.

Candidates to which a policy gives the same score are equally likely to come first, and every figure is the
mean over their orders. So a policy that knows nothing scores as the draw of lots does, exactly.
"""

from dataclasses import dataclass, replace

import numpy as np

from ....base.numeric.arrays import Array, Mask
from ..situations import Situations

__all__ = ["Figures", "figures", "figures_by_other_draws", "oracle_scores", "usual_scores"]


@dataclass(frozen=True, eq=False)
class Figures:
    """What a policy achieves in each of G situations, under one load.

    Attributes:
        success: (G,), share of the draws in which its first choice held.
        oracle: (G,), the same of the best candidate by outcome.
        auc: (G,), how likely a candidate that held scores above one of the same situation and draw that did
            not, mean over draws; NaN where no draw has both.
        before: (G,), tests that fail before the first one that holds, where candidates are tested by their
            scores; mean over the draws in which one holds, NaN where there is none.
    """

    success: Array
    oracle: Array
    auc: Array
    before: Array

    @property
    def regret(self) -> Array:
        """What is missing to the oracle (G,)."""
        return self.oracle - self.success

    @property
    def by_name(self) -> dict[str, Array]:
        """All figures by name."""
        return {
            "success": self.success,
            "regret": self.regret,
            "auc": self.auc,
            "before": self.before,
        }


def usual_scores(situations: Situations) -> Array:
    """Scores (N,) of taking candidates as they come."""
    return -situations.place.astype(np.float64)


def oracle_scores(situations: Situations, load: int) -> Array:
    """Scores (N,) of whoever knows the outcomes."""
    return situations.chance(load)


def figures_by_other_draws(situations: Situations, load: int, tests: int | None = None) -> Figures | None:
    """The figures of whoever has tried every candidate in other draws, and goes by what became of it.

    Unlike the oracle, he does not know the draw that is to come, as nobody does who chooses before the test.
    So this is about what knowing the candidates alone can bring: less than with any number of trials, and no
    less than with so many.

    Args:
        situations: G situations with N candidates.
        load: index of the load.
        tests: in how many other draws, those that follow in turn; None for all others.

    Returns:
        Means over the draws; None where there is but one.
    """
    draws = situations.held.shape[1]
    if draws < 2:
        return None
    others = np.arange(1, draws if tests is None else tests + 1)
    # How near to its limits a trial came tells more than whether it was held: equal parts of both.
    worth = 0.5 * (situations.held[:, :, load] + situations.margin[:, :, load])
    found = []
    for draw in range(draws):
        # Sums of rounded numbers depend on their order, and equal outcomes are to tie.
        scores = np.sort(worth[:, (draw + others) % draws], axis=1).mean(axis=1)
        alone = replace(situations, held=situations.held[:, [draw]], margin=situations.margin[:, [draw]])
        found.append(figures(alone, scores, load))
    return Figures(
        success=np.mean([one.success for one in found], axis=0),
        oracle=figures(situations, oracle_scores(situations, load), load).oracle,
        **{name: _mean_of_known([one.by_name[name] for one in found]) for name in ("auc", "before")},
    )


def figures(situations: Situations, scores: Array, load: int) -> Figures:
    """The figures of a policy.

    Args:
        situations: G situations with N candidates.
        scores: (N,), the higher the sooner.
        load: index of the load.
    """
    padded = situations.padded(scores)
    there = padded.there
    score = np.where(there, padded.values.astype(np.float64), -np.inf)
    held = situations.padded(situations.held[:, :, load]).values.astype(np.bool_)
    failed = ~held & there[..., None]
    chance = held.mean(axis=2)
    foremost = there & (score == score.max(axis=1, keepdims=True))
    return Figures(
        success=(chance * foremost).sum(axis=1) / foremost.sum(axis=1),
        oracle=chance.max(axis=1),
        auc=_auc(score, held, failed),
        before=_before(score, held, failed),
    )


def _auc(score: Array, held: Mask, failed: Mask) -> Array:
    # Shape (G, K, K): how each candidate stands to each other one.
    with np.errstate(invalid="ignore"):
        above = np.nan_to_num(np.sign(score[:, :, None] - score[:, None, :]), nan=0.0)
    pairs = held.sum(axis=1) * failed.sum(axis=1)
    surplus = np.einsum("gid,gij,gjd->gd", held.astype(float), above, failed.astype(float))
    return _mean_where(0.5 + 0.5 * surplus / np.maximum(pairs, 1), pairs > 0)


def _before(score: Array, held: Mask, failed: Mask) -> Array:
    """Of those that tie with the first one that holds, h hold and f fail: f / (h + 1) come before it."""
    best = np.where(held, score[..., None], -np.inf).max(axis=1)
    sooner = (failed & (score[..., None] > best[:, None])).sum(axis=1)
    level = score[..., None] == best[:, None]
    ties = (failed & level).sum(axis=1) / ((held & level).sum(axis=1) + 1.0)
    return _mean_where(sooner + ties, held.max(axis=1))


def _mean_of_known(rows: list[Array]) -> Array:
    values = np.stack(rows, axis=1)
    return _mean_where(values, np.isfinite(values))


def _mean_where(values: Array, known: Mask) -> Array:
    number = known.sum(axis=1)
    return np.where(number > 0, np.where(known, values, 0.0).sum(axis=1) / np.maximum(number, 1), np.nan)
