"""Policies compared on what they have not seen."""

import numpy as np
import pytest
from holdfast.pipeline.choose.policies import Prepared, prepare, train
from holdfast.pipeline.choose.situations import to_situations
from holdfast.pipeline.choose.study.evaluation import ORACLE, OTHER_DRAWS, Comparison, compare
from holdfast.pipeline.choose.study.importance import importances
from holdfast.pipeline.choose.study.learning_curve import learning_curve
from holdfast.pipeline.choose.study.splits import PROTOCOLS, object_folds

from ...choice.synthetic import make_choice_data

POLICIES = ("random", "first", "formula:epsilon", "logistic")


@pytest.fixture(scope="module")
def prepared() -> Prepared:
    """80 situations of a known law, with noise."""
    return prepare(to_situations(make_choice_data(groups=80, candidates=6, noise=0.4)))


@pytest.fixture(scope="module")
def comparisons(prepared: Prepared) -> list[Comparison]:
    return compare(POLICIES, prepared, PROTOCOLS[0], seeds=2)


def test_figures_hang_together(comparisons: list[Comparison], prepared: Prepared) -> None:
    assert [entry.load for entry in comparisons] == [1.0, 2.0]
    for load, entry in enumerate(comparisons):
        assert (entry.situations, entry.objects, entry.best_formula) == (80, 80, "formula:epsilon")
        standing = {one.policy: one for one in entry.standings}
        assert set(standing) == {*POLICIES, ORACLE, OTHER_DRAWS}
        oracle, learnt = standing[ORACLE], standing["logistic"]
        assert standing["random"].success.value == pytest.approx(prepared.situations.chance(load).mean())
        assert oracle.regret.as_list == [0.0, 0.0, 0.0]
        assert oracle.gap_closed.as_list == pytest.approx([1.0, 1.0, 1.0])
        assert standing["formula:epsilon"].above_formula.as_list == [0.0, 0.0, 0.0]
        assert standing["first"].saved.as_list == [0.0, 0.0, 0.0]
        assert learnt.above_formula.low > 0.0
        assert 0.0 < learnt.gap_closed.value < 1.0
        assert learnt.regret.value == pytest.approx(oracle.success.value - learnt.success.value)
        assert learnt.calibration is not None and learnt.calibration.error < 0.15
        assert standing["random"].calibration is None
        for one in entry.standings:
            assert one.success.low <= one.success.value <= one.success.high
            assert one.success.value <= oracle.success.value


def test_paired_intervals_are_narrower(comparisons: list[Comparison]) -> None:
    """Hard situations are hard for all, which a comparison of the same ones does not count twice."""
    standing = {one.policy: one for one in comparisons[0].standings}
    first, second = standing["logistic"], standing[ORACLE]
    apart = (first.success.high - first.success.low) + (second.success.high - second.success.low)
    assert first.regret.high - first.regret.low < apart


def test_an_unseen_hand_is_tested_without_its_own_features() -> None:
    s = to_situations(make_choice_data(groups=80, candidates=6))
    found = compare(("formula:epsilon", "logistic"), prepare(s, free=True), PROTOCOLS[1], seeds=1)
    assert found[0].standings[1].auc.low > 0.8
    assert compare(("first",), prepare(s), PROTOCOLS[2], seeds=1) == []  # one kind of task alone


def test_more_objects_teach_more(prepared: Prepared) -> None:
    found = learning_curve(("linucb",), prepared, seeds=3)
    for load in prepared.situations.loads:
        points = [point for point in found if point.load == load]
        counts = [round(point.objects) for point in points]
        assert counts == sorted(set(counts))
        assert points[-1].objects == pytest.approx(80 * 2 / 3, abs=1)
        assert points[-1].success.value > points[0].success.value
        assert points[-1].auc.value > points[0].auc.value


def test_what_matters_is_found(prepared: Prepared) -> None:
    split = next(object_folds(prepared.situations, 0))
    trained = train("logistic", prepared, split.train)
    found = importances(trained, prepared, split, 0)
    assert {entry.feature for entry in found} == set(prepared.situations.names)
    assert found[0].feature == "span" and found[0].auc > 0.1
    assert abs(next(entry.auc for entry in found if entry.feature == "reach")) < 0.03


def test_objects_that_agree_leave_nothing_to_doubt(prepared: Prepared) -> None:
    entry = compare(("random",), prepared, PROTOCOLS[0], seeds=1)[0]
    one = entry.standings[0]
    assert entry.best_formula is None
    assert one.above_formula.as_list == one.gap_closed.as_list == one.saved.as_list == [None, None, None]
    assert np.isfinite(one.iqm.value)
