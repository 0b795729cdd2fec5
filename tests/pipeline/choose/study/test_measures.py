"""Laws of the figures by which policies are compared."""

from dataclasses import replace

import numpy as np
import pytest
from holdfast.mjcf.squeeze import auc
from holdfast.pipeline.choose.situations import Situations, to_situations
from holdfast.pipeline.choose.study.calibration import calibration
from holdfast.pipeline.choose.study.measures import (
    figures,
    figures_by_other_draws,
    oracle_scores,
    usual_scores,
)

from ...choice.synthetic import make_choice_data


@pytest.fixture(scope="module")
def situations() -> Situations:
    """Situations of different sizes."""
    data = make_choice_data(groups=40, candidates=7, seed=3)
    kept = np.random.default_rng(0).random(len(data)) < 0.8
    return to_situations(data.select(kept))


def test_an_oracle_is_never_worse(situations: Situations) -> None:
    rng = np.random.default_rng(1)
    oracle = figures(situations, oracle_scores(situations, 0), 0)
    for _ in range(20):
        other = figures(situations, rng.normal(size=len(situations.features)), 0)
        assert (other.regret >= 0.0).all()
        assert (oracle.success >= other.success).all()
        assert np.array_equal(other.oracle, oracle.success)


def test_who_has_tried_in_other_draws_does_not_know_this_one(situations: Situations) -> None:
    """Where every draw is the same he is the oracle; where each is by chance he knows nothing."""
    same = replace(
        situations,
        held=np.repeat(situations.held[:, :1], 3, axis=1),
        margin=np.repeat(situations.margin[:, :1], 3, axis=1),
    )
    knowing, oracle = figures_by_other_draws(same, 0), figures(same, oracle_scores(same, 0), 0)
    assert knowing is not None
    assert np.array_equal(knowing.success, oracle.success)
    assert np.array_equal(knowing.auc, oracle.auc, equal_nan=True) and np.nanmin(knowing.auc) == 1.0
    lots = np.random.default_rng(5).random((len(same.features), 4, 2)) < 0.5
    blind = figures_by_other_draws(replace(situations, held=lots, margin=np.where(lots, 0.5, -0.5)), 0)
    assert blind is not None
    assert np.nanmean(blind.auc) == pytest.approx(0.5, abs=0.06)
    assert blind.success.mean() == pytest.approx(0.5, abs=0.1) and (blind.regret >= 0.0).all()
    one = replace(situations, held=situations.held[:, :1], margin=situations.margin[:, :1])
    assert figures_by_other_draws(one, 0) is None


def test_more_tests_in_other_draws_tell_more(situations: Situations) -> None:
    """Each candidate has its chance, and the more often it was tried the better that is known."""
    rng = np.random.default_rng(7)
    chance = rng.random(len(situations.features))
    held = np.repeat(rng.random((len(chance), 16)) < chance[:, None], 2).reshape(-1, 16, 2)
    tried = replace(situations, held=held, margin=np.where(held, 0.5, -0.5))
    found = [figures_by_other_draws(tried, 0, tests) for tests in (1, 4, 15)]
    success = [one.success.mean() for one in found if one is not None]
    whole = figures_by_other_draws(tried, 0)
    assert whole is not None and success == sorted(success) and success[-1] == whole.success.mean()
    known = figures(tried, chance, 0).success.mean()
    assert success[0] < success[1] < known + 0.03
    assert known - 0.03 < figures(tried, oracle_scores(tried, 0), 0).success.mean()


def test_lots_score_the_mean(situations: Situations) -> None:
    drawn = figures(situations, np.zeros(len(situations.features)), 1)
    for g in range(len(situations)):
        held = situations.held[situations.first[g] : situations.first[g + 1], :, 1]
        assert drawn.success[g] == pytest.approx(held.mean())
        ranks = [auc(np.zeros(len(held)), one) for one in held.T]
        assert np.isnan(drawn.auc[g]) == (set(ranks) == {None})
    assert drawn.auc[np.isfinite(drawn.auc)] == pytest.approx(0.5)


def test_ties_are_means_over_orders(situations: Situations) -> None:
    """Against drawing the order of equals many times."""
    rng = np.random.default_rng(2)
    coarse = np.round(rng.normal(size=len(situations.features)))
    exact = figures(situations, coarse, 0)
    drawn = [figures(situations, coarse + 1e-3 * rng.random(len(coarse)), 0).by_name for _ in range(600)]
    for name in ("success", "auc", "before"):
        sampled = np.mean([one[name] for one in drawn], axis=0)
        assert np.allclose(sampled, exact.by_name[name], atol=0.2, equal_nan=True)
        assert np.nanmean(sampled) == pytest.approx(np.nanmean(exact.by_name[name]), abs=0.02)


def test_auc_is_that_of_each_draw(situations: Situations) -> None:
    scores = situations.features[:, 3]
    found = figures(situations, scores, 0).auc
    for g in range(len(situations)):
        rows = slice(int(situations.first[g]), int(situations.first[g + 1]))
        ranks = [auc(scores[rows], held) for held in situations.held[rows, :, 0].T]
        known = [rank for rank in ranks if rank is not None]
        assert found[g] == pytest.approx(np.mean(known)) if known else np.isnan(found[g])


def test_tests_before_the_first_one_that_holds(situations: Situations) -> None:
    found = figures(situations, usual_scores(situations), 0).before
    for g in range(len(situations)):
        held = situations.held[situations.first[g] : situations.first[g + 1], :, 0]
        counts = [int(one.argmax()) for one in held.T if one.any()]
        assert found[g] == pytest.approx(np.mean(counts)) if counts else np.isnan(found[g])


def test_the_order_of_candidates_has_no_say(situations: Situations) -> None:
    rng = np.random.default_rng(5)
    order = np.lexsort((rng.random(len(situations.features)), situations.situation))
    shuffled = replace(situations, held=situations.held[order], features=situations.features[order])
    scores = rng.normal(size=len(order))
    before, after = figures(situations, scores, 0), figures(shuffled, scores[order], 0)
    for name, values in before.by_name.items():
        assert np.allclose(values, after.by_name[name], equal_nan=True)


def test_calibration_of_true_chances_is_good() -> None:
    rng = np.random.default_rng(0)
    chances = rng.random(20_000)
    found = calibration(chances, rng.random((20_000, 3)) < chances[:, None])
    assert found.error < 0.01
    # The variance of a coin of chance p, over all p.
    assert found.brier == pytest.approx(1.0 / 6.0, abs=0.005)
    assert sum(entry.count for entry in found.bins) == 20_000
    assert calibration(np.ones(4), np.ones((4, 2), dtype=bool)).brier == 0.0
    assert calibration(np.ones(4), np.zeros((4, 2), dtype=bool)).error == 1.0
