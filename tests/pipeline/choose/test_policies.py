"""What policies learn, and that nothing but what they may know has a say."""

from dataclasses import replace
from importlib.util import find_spec

import numpy as np
import pytest
from holdfast.errors import InputError, MissingBackend, UnknownName
from holdfast.pipeline.choice import load_dataset
from holdfast.pipeline.choose.heads import Linear
from holdfast.pipeline.choose.policies import Prepared, Trained, policy_names, prepare, train
from holdfast.pipeline.choose.situations import Situations, to_situations
from holdfast.pipeline.choose.study import default_policies
from holdfast.pipeline.choose.study.measures import figures
from holdfast.pipeline.choose.training_set import TrainingSet

from ..choice.synthetic import make_choice_data

LEARNED = ("blend", "logistic", "boosting", "advantage", "team", "ranker", "linucb")
CPU_POLICIES = ("random", "first", "formula:epsilon", *LEARNED)


@pytest.fixture(scope="module")
def prepared() -> Prepared:
    """60 situations of a known law."""
    return prepare(to_situations(make_choice_data(groups=60, candidates=6)))


@pytest.fixture(scope="module")
def trained(prepared: Prepared) -> dict[str, Trained]:
    """Every policy that needs no torch, trained on the first 40."""
    return {name: train(name, prepared, np.arange(40), seed=1) for name in CPU_POLICIES}


def scores(trained: Trained, situations: Situations, load: int = 0) -> np.ndarray:
    return prepare(situations).scores(trained, load, np.arange(len(situations.features)))


def test_there_are_these_policies(prepared: Prepared) -> None:
    assert set(policy_names(prepared.situations.formulas)) == {*CPU_POLICIES, "springs", "maskable_ppo"}


def test_springs_choose_where_they_were_tried(prepared: Prepared) -> None:
    with pytest.raises(InputError, match="has no features f_spring_hold and f_spring_hold_2"):
        train("springs", prepared, np.arange(40))
    shipped = to_situations(load_dataset())
    strains = shipped.features[:, [shipped.names.index(f"f_spring_{name}") for name in ("hold", "hold_2")]]
    ready = prepare(shipped)
    found = ready.scores(train("springs", ready, np.zeros(0, dtype=int)), 0, np.arange(len(strains)))
    assert np.array_equal(found, -strains.sum(axis=1))
    assert "springs" in default_policies(shipped) and "springs" not in default_policies(prepared.situations)
    assert not any("spring" in formula.name for formula in shipped.formulas)


@pytest.mark.parametrize("name", [name for name in LEARNED if name != "blend"])
def test_a_planted_signal_is_found(name: str, prepared: Prepared, trained: dict[str, Trained]) -> None:
    unseen = prepared.situations.take(np.arange(40, 60))
    for load in (0, 1):
        found = figures(unseen, scores(trained[name], unseen, load), load)
        poor = figures(unseen, scores(trained["formula:epsilon"], unseen, load), load)
        assert np.nanmean(found.auc) > 0.8 > np.nanmean(poor.auc)
        assert found.success.mean() > poor.success.mean()


@pytest.mark.parametrize("name", [name for name in CPU_POLICIES if name != "first"])
def test_the_order_of_candidates_never_changes_a_choice(
    name: str, prepared: Prepared, trained: dict[str, Trained]
) -> None:
    s = prepared.situations
    order = np.lexsort((np.random.default_rng(4).random(len(s.features)), s.situation))
    shuffled = replace(s, features=s.features[order], held=s.held[order])
    assert np.array_equal(scores(trained[name], s)[order], scores(trained[name], shuffled))


def test_other_situations_have_no_say(prepared: Prepared, trained: dict[str, Trained]) -> None:
    """What is scored alone is scored as among others, to the last bit."""
    s = prepared.situations
    for name, one in trained.items():
        together = scores(one, s)
        for g in (0, 17, 59):
            assert np.array_equal(scores(one, s.take(np.array([g]))), together[s.rows(np.array([g]))]), name


def test_a_blend_finds_the_formula_that_tells_and_turns_none_round(prepared: Prepared) -> None:
    s = prepared.situations
    signs = {"span": 1, "lean": 1, "reach": -1, "epsilon": 1}
    columns = tuple(replace(column, formula=signs.get(column.name, 0)) for column in s.columns)
    ready = prepare(replace(s, columns=columns))
    found = train("blend", ready, np.arange(40)).heads[0]
    assert isinstance(found, Linear)
    weights = dict(zip(((e.feature, e.form) for e in ready.inputs), found.weights, strict=True))
    assert {name for (name, form), weight in weights.items() if weight} <= set(signs)
    assert all(weights[name, "distance"] * sign >= 0.0 for name, sign in signs.items())
    assert weights["span", "distance"] > 5.0 * max(
        -weights["reach", "distance"], weights["epsilon", "distance"]
    )
    unseen = s.take(np.arange(40, 60))
    values = ready.values[s.rows(np.arange(40, 60))]
    assert np.nanmean(figures(unseen, found.scores(values, unseen.place), 0).auc) > 0.8
    nameless = prepare(replace(s, columns=tuple(replace(column, formula=0) for column in s.columns)))
    with pytest.raises(InputError, match="names no formula"):
        train("blend", nameless, np.arange(40))


def test_the_same_seed_trains_the_same(prepared: Prepared) -> None:
    for name in ("boosting", "advantage", "ranker", "linucb"):
        one, two, other = (train(name, prepared, np.arange(20), seed=seed) for seed in (3, 3, 4))
        assert one.heads == two.heads
        assert one.heads != other.heads


def test_outcomes_of_the_unseen_are_not_looked_at(prepared: Prepared) -> None:
    s = prepared.situations
    held = s.held.copy()
    held[s.rows(np.arange(40, 60))] ^= True
    turned = replace(prepared, situations=replace(s, held=held))
    for name in LEARNED:
        assert train(name, prepared, np.arange(40)).heads == train(name, turned, np.arange(40)).heads


def test_one_feature_of_a_hand_misleads_on_another(prepared: Prepared) -> None:
    """Without it, what was learnt with one hand serves the other."""
    s = prepared.situations
    own, other = np.flatnonzero(s.hands == "sa"), np.flatnonzero(s.hands == "shadow")
    unseen = s.take(other)
    auc = {}
    for free in (False, True):
        ready = prepare(s, free=free)
        found = train("logistic", ready, own)
        values = ready.scores(found, 0, s.rows(other))
        auc[free] = np.nanmean(figures(unseen, values, 0).auc)
    assert auc[True] > 0.8 > auc[False]


def test_trees_are_those_of_lightgbm(prepared: Prepared) -> None:
    """Our walk through them against LightGBM's own."""
    import lightgbm
    from holdfast.pipeline.choose.boosting import _trees

    rng = np.random.default_rng(0)
    x = np.vstack([prepared.values, rng.normal(size=prepared.values.shape)])
    booster = lightgbm.train(
        {"objective": "cross_entropy", "num_leaves": 9, "verbose": -1, "num_threads": 1},
        lightgbm.Dataset(prepared.values, prepared.situations.chance(0)),
        40,
    )
    trees = _trees(booster, x.shape[1], "chance")
    assert np.allclose(trees.scores(x, np.zeros(len(x), dtype=np.int64)), booster.predict(x), atol=1e-12)


def test_logistic_is_that_of_scikit_learn(prepared: Prepared) -> None:
    """The same loss minimised by another program."""
    linear_model = pytest.importorskip("sklearn.linear_model")
    from holdfast.pipeline.choose.logistic import _PENALTY, train_logistic

    s = prepared.situations
    nothing = np.zeros(prepared.values.shape[1])
    data = TrainingSet(prepared.values, s.first, s.held[:, :, 0], s.margin[:, :, 0], nothing, 0)
    x = np.repeat(data.standardised, s.held.shape[1], axis=0)
    peer = linear_model.LogisticRegression(C=1.0 / (_PENALTY * len(x)), tol=1e-8, max_iter=5000)
    peer.fit(x, s.held[:, :, 0].ravel())
    ours = train_logistic(data).scores(prepared.values, s.place)
    assert np.allclose(ours, peer.predict_proba(data.standardised)[:, 1], atol=2e-3)


def test_an_unknown_policy_is_named(prepared: Prepared) -> None:
    with pytest.raises(UnknownName, match="did you mean 'boosting'"):
        train("bosting", prepared, np.arange(4))


def test_nothing_teaches_nothing(prepared: Prepared) -> None:
    with pytest.raises(InputError, match="no situation"):
        train("logistic", prepared, np.arange(0))


@pytest.mark.parametrize("name", LEARNED)
def test_outcomes_that_are_all_alike_can_be_learnt_from(name: str, prepared: Prepared) -> None:
    s = prepared.situations
    alike = replace(prepared, situations=replace(s, held=np.ones_like(s.held)))
    found = scores(train(name, alike, np.arange(30)), s)
    assert np.isfinite(found).all()


@pytest.mark.skipif(find_spec("sb3_contrib") is not None, reason="it is installed")
def test_what_is_missing_is_said(prepared: Prepared) -> None:
    with pytest.raises(MissingBackend, match=r"holdfast\[rl\]"):
        train("maskable_ppo", prepared, np.arange(10))


@pytest.mark.slow
def test_maskable_ppo_finds_a_planted_signal(prepared: Prepared) -> None:
    pytest.importorskip("sb3_contrib")
    unseen = prepared.situations.take(np.arange(40, 60))
    found = train("maskable_ppo", prepared, np.arange(40), seed=0)
    assert np.nanmean(figures(unseen, scores(found, unseen), 0).auc) > 0.8
