"""Gradient boosting by LightGBM: of the chance to hold, the lead over rivals, or the order (LambdaRank).

LightGBM only trains. The trees are taken over as plain numbers (see `heads.Trees`), so that who uses a model
needs no LightGBM, and none of its parsers reads a file that came from elsewhere.
"""

from typing import Any

import numpy as np

from ...base.machine.extras import from_extra
from .heads import Trees
from .training_set import TrainingSet

__all__ = ["train_advantage", "train_boosting", "train_ranker"]

_COMMON = {
    "learning_rate": 0.03,
    "num_leaves": 15,
    "min_data_in_leaf": 30,
    "feature_fraction": 0.3,
    "bagging_fraction": 0.8,
    "bagging_freq": 1,
    "lambda_l2": 5.0,
    # The same on every machine with the same version.
    "num_threads": 1,
    "deterministic": True,
    "force_row_wise": True,
    "verbose": -1,
}
_ROUNDS = 300
# Margins say more than outcomes, so that less data bears a split.
_OF_MARGINS = {"learning_rate": 0.02, "num_leaves": 7, "min_data_in_leaf": 10}


def train_boosting(data: TrainingSet) -> Trees:
    """The chance of each candidate to hold.

    Raises:
        MissingBackend: LightGBM is not installed.
    """
    lightgbm = _lightgbm()
    training = lightgbm.Dataset(data.inputs, data.chance)
    settings = {**_COMMON, "objective": "cross_entropy", "seed": data.seed}
    return _trees(lightgbm.train(settings, training, _ROUNDS), data.inputs.shape[1], "chance")


def train_advantage(data: TrainingSet) -> Trees:
    """By how much each candidate is better than its rivals, by outcomes and margins in equal parts.

    How hard a situation is has no say, and how near to its limits it came says more than whether it held.

    Raises:
        MissingBackend: LightGBM is not installed.
    """
    lightgbm = _lightgbm()
    target = data.above_rivals(0.5 * (data.chance + data.margin.mean(axis=1)))
    settings = {**_COMMON, **_OF_MARGINS, "objective": "regression", "seed": data.seed}
    training = lightgbm.Dataset(data.inputs, target)
    return _trees(lightgbm.train(settings, training, _ROUNDS), data.inputs.shape[1], "none")


def train_ranker(data: TrainingSet) -> Trees:
    """A score that puts candidates of a situation into order, those first that held in most draws.

    Raises:
        MissingBackend: LightGBM is not installed.
    """
    lightgbm = _lightgbm()
    draws = data.held.shape[1]
    training = lightgbm.Dataset(data.inputs, data.held.sum(axis=1), group=np.diff(data.first))
    settings = {
        **_COMMON,
        "objective": "lambdarank",
        "seed": data.seed,
        # A grasp that holds in two draws is worth twice one that holds in one.
        "label_gain": list(range(draws + 1)),
        "lambdarank_truncation_level": int(np.diff(data.first).max()),
    }
    return _trees(lightgbm.train(settings, training, _ROUNDS), data.inputs.shape[1], "none")


def _lightgbm() -> Any:
    return from_extra("lightgbm", "learn", "training of boosting, advantage and ranker")


class _Grower:
    """Puts nodes of LightGBM's nested trees into lists, parents before children."""

    def __init__(self) -> None:
        self.feature: list[int] = []
        self.threshold: list[float] = []
        self.left: list[int] = []
        self.right: list[int] = []
        self.value: list[float] = []

    def add(self, node: dict[str, Any]) -> int:
        """Adds a node and all below; its number."""
        own = len(self.feature)
        inner = "split_feature" in node
        self.feature.append(int(node["split_feature"]) if inner else -1)
        self.threshold.append(float(node["threshold"]) if inner else 0.0)
        self.value.append(0.0 if inner else float(node["leaf_value"]))
        self.left.append(own)
        self.right.append(own)
        if inner:
            self.left[own] = self.add(node["left_child"])
            self.right[own] = self.add(node["right_child"])
        return own


def _trees(booster: Any, width: int, link: Any) -> Trees:
    grower = _Grower()
    roots = [grower.add(tree["tree_structure"]) for tree in booster.dump_model()["tree_info"]]
    return Trees(
        inputs=width,
        roots=roots,
        feature=grower.feature,
        threshold=grower.threshold,
        left=grower.left,
        right=grower.right,
        value=grower.value,
        link=link,
    )
