"""Models come back as they were saved; what is damaged or foreign is refused."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from holdfast.errors import InputError, UnknownName
from holdfast.pipeline.choose.heads import Layer, Linear, Network, Sum
from holdfast.pipeline.choose.inputs import Input
from holdfast.pipeline.choose.model_file import Model, Provenance, load_model, save_model
from holdfast.pipeline.choose.policies import Trained, prepare, train
from holdfast.pipeline.choose.situations import to_situations

from ..choice.synthetic import make_choice_data

SITUATIONS = to_situations(make_choice_data(groups=24, candidates=5))
PROVENANCE = Provenance(
    data="0" * 64,
    hands={"sa": "abc", "shadow": "def"},
    objects=["a", "b"],
    situations=2,
    candidates=9,
    draws=3,
)


def make_model(policy: str) -> Model:
    if policy == "network":
        rng = np.random.default_rng(0)
        layers = [
            Layer(weights=rng.normal(size=shape).tolist(), bias=rng.normal(size=shape[0]).tolist())
            for shape in ((4, 2), (1, 4))
        ]
        head = Network(mean=[0.1, 0.2], scale=[1.5, 2.5], layers=layers)
        inputs = (Input(feature="span", form="rank"), Input(feature="mass", form="value"))
        return Model.of(Trained(policy, inputs, (head, head)), SITUATIONS, 0, PROVENANCE)
    trained = train(policy, prepare(SITUATIONS), np.arange(24), seed=2)
    return Model.of(trained, SITUATIONS, 2, PROVENANCE)


def scores(model: Model, load: float) -> np.ndarray:
    return model.scores(SITUATIONS.names, SITUATIONS.features, SITUATIONS.first, load)


@pytest.mark.parametrize(
    "policy",
    [
        "random",
        "first",
        "formula:epsilon",
        "logistic",
        "boosting",
        "advantage",
        "ranker",
        "linucb",
        "network",
    ],
)
def test_what_is_loaded_scores_exactly_as_what_was_saved(policy: str, tmp_path: Path) -> None:
    model = make_model(policy)
    save_model(tmp_path / "model.json", model)
    again = load_model(tmp_path / "model.json")
    for load in (1.0, 2.0, 1.7):
        assert np.array_equal(scores(model, load), scores(again, load))
    assert again.digest == model.digest
    assert again.trained_on == PROVENANCE
    assert (again.policy, again.seed, again.columns) == (model.policy, model.seed, model.columns)


def test_scores_are_those_of_training(tmp_path: Path) -> None:
    ready = prepare(SITUATIONS)
    trained = train("boosting", ready, np.arange(24), seed=2)
    rows = np.arange(len(SITUATIONS.features))
    model = make_model("boosting")
    for load in (0, 1):
        own = ready.scores(trained, load, rows)
        assert np.array_equal(own, scores(model, float(SITUATIONS.loads[load])))


def _set(path: str, value: Any) -> Callable[[dict[str, Any]], None]:
    def change(data: Any) -> None:
        *inner, last = path.split(".")
        for part in inner:
            data = data[int(part) if part.isdigit() else part]
        data[int(last) if last.isdigit() else last] = value

    return change


def test_parts_of_a_sum_fit_each_other() -> None:
    one = Linear(mean=[0.0], scale=[1.0], weights=[2.0])
    both = Sum(parts=[one, one])
    inputs = np.array([[1.0], [-3.0]])
    assert both.scores(inputs, np.arange(2)).tolist() == [4.0, -12.0] and both.width == 1
    wide = Linear(mean=[0.0] * 2, scale=[1.0] * 2, weights=[1.0] * 2)
    for parts in ([one, wide], [one, one.model_copy(update={"link": "chance"})], []):
        with pytest.raises(ValueError, match="parts"):
            Sum(parts=parts)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (_set("format", "pickle"), "format: must be 'holdfast choice model'"),
        (_set("version", 2), "version: must be 1"),
        (_set("heads.0.head.kind", "forest"), "heads.0"),
        (_set("heads.0.head.roots", [10**6]), "roots must be below"),
        (_set("heads.0.head.left.0", 0), "must be later nodes"),
        (_set("heads.0.head.left.0", 10**7), "must be later nodes"),
        (_set("heads.0.head.feature.0", 10**6), "feature must be below"),
        (_set("heads.0.head.value", [0.0]), "the same length"),
        (_set("heads.0.head.value.0", 1e300), "heads.0"),
        (_set("heads.0.head.inputs", 500), "takes 500 inputs, but there are"),
        (_set("heads.1.load", 1.0), "a load stands twice"),
        (_set("heads", []), "heads"),
        (_set("inputs.0.feature", "nothing"), "must be the name of a feature, not 'nothing'"),
        (_set("inputs.0.form", "square"), "inputs.0.form"),
        (_set("features.0.name", "lean"), "a name stands twice"),
        (_set("trained_on.data", "x"), "trained_on.data"),
        (_set("surprise", 1), "unknown field"),
    ],
)
def test_a_damaged_model_is_refused(
    change: Callable[[dict[str, Any]], None], words: str, tmp_path: Path
) -> None:
    path = tmp_path / "model.json"
    save_model(path, make_model("boosting"))
    data = json.loads(path.read_text("utf-8"))
    change(data)
    path.write_text(json.dumps(data), "utf-8")
    with pytest.raises(InputError) as caught:
        load_model(path)
    assert str(path) in str(caught.value) and words in str(caught.value)


def test_a_tree_without_end_is_refused(tmp_path: Path) -> None:
    """A chain of a hundred thousand questions would take as many steps."""
    path = tmp_path / "model.json"
    save_model(path, make_model("boosting"))
    data = json.loads(path.read_text("utf-8"))
    count = 100_000
    data["heads"][0]["head"] |= {
        "roots": [0],
        "feature": [0] * (count - 1) + [-1],
        "threshold": [0.0] * count,
        "left": [*range(1, count), count - 1],
        "right": [*range(1, count), count - 1],
        "value": [0.0] * count,
    }
    path.write_text(json.dumps(data), "utf-8")
    with pytest.raises(InputError, match="no deeper than"):
        load_model(path)


@pytest.mark.parametrize("text", ["", "{", "[]", '{"a": NaN}', '{"format": 1}', "\x80\x04K\x01."])
def test_what_is_no_model_is_refused(text: str, tmp_path: Path) -> None:
    path = tmp_path / "model.json"
    path.write_bytes(text.encode("latin-1"))
    with pytest.raises(InputError, match=r"model\.json"):
        load_model(path)
    with pytest.raises(InputError, match="no such file"):
        load_model(tmp_path / "none.json")


def test_features_that_do_not_fit_are_named() -> None:
    model = make_model("formula:epsilon")
    model.check_fits({"epsilon": "1", "other": "m"}, "m.json")
    with pytest.raises(UnknownName, match="unknown feature 'epsilon'"):
        model.check_fits({"epsilo": "1"}, "m.json")
    with pytest.raises(InputError, match="is in 1, but here it is in N"):
        model.check_fits({"epsilon": "N"}, "m.json")
