"""All that is found out about policies on a data set, for the page and for programs."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from .... import __version__
from ....base.numeric.arrays import Array
from ....errors import InputError
from ..model_file import Model
from ..policies import FORMULA, SPRINGS, Prepared, has_springs, is_learned, prepare, train
from ..situations import Situations
from .evaluation import Comparison, Runs, Standing, compare, compare_runs
from .importance import Importance, importances
from .learning_curve import CurvePoint, learning_curve
from .splits import PROTOCOLS, object_folds

__all__ = ["Study", "default_policies", "study_data", "study_models"]

_PLAIN, _LEARNED = ("random", "first"), ("logistic", "boosting", "advantage", "ranker", "linucb")
_LEAST_SITUATIONS = 10


@dataclass(frozen=True)
class Study:
    """What was found out.

    Attributes:
        situations: in the data.
        objects: in the data.
        candidates: in the data.
        draws: of the hidden conditions, of each candidate.
        hands: in the data.
        seeds: with which policies were trained; 0 where none was.
        comparisons: of the policies, by what was unseen and by load.
        curve: success by the number of objects that were trained on, under each load.
        explained: the policy whose features were looked at; empty where none was.
        importances: what it loses without each of them, at the first load, the most first.
    """

    situations: int
    objects: int
    candidates: int
    draws: int
    hands: tuple[str, ...]
    seeds: int
    comparisons: tuple[Comparison, ...]
    curve: tuple[CurvePoint, ...] = ()
    explained: str = ""
    importances: tuple[Importance, ...] = ()

    def as_json(self) -> dict[str, Any]:
        """As plain data; intervals are lists of value, lower and upper end."""
        return {
            "holdfast": __version__,
            "data": {
                "situations": self.situations,
                "objects": self.objects,
                "candidates": self.candidates,
                "draws": self.draws,
                "hands": list(self.hands),
            },
            "seeds": self.seeds,
            "comparisons": [_comparison(entry) for entry in self.comparisons],
            "learning_curve": [
                {
                    "policy": point.policy,
                    "load": point.load,
                    "objects": point.objects,
                    "success": point.success.as_list,
                    "auc": point.auc.as_list,
                }
                for point in self.curve
            ],
            "importance": {
                "policy": self.explained,
                "features": [asdict(entry) for entry in self.importances],
            },
        }


def default_policies(situations: Situations) -> tuple[str, ...]:
    """All that need no more than the extra `learn`."""
    formulas = tuple(FORMULA + formula.name for formula in situations.formulas)
    springs = (SPRINGS,) if has_springs(situations) else ()
    return (*_PLAIN, *springs, *formulas, *(("blend", "team") if formulas else ()), *_LEARNED)


def study_data(
    situations: Situations,
    policies: Sequence[str],
    *,
    unseen: Sequence[str] = ("object", "hand", "task"),
    seeds: int = 5,
    say: Callable[[str], None] = lambda text: None,
) -> Study:
    """Trains policies anew, for each question about what is unseen, and compares them.

    Args:
        situations: the data.
        policies: names of policies.
        unseen: the questions: an unseen `object`, `hand` or `task`.
        seeds: how often all is dealt out and trained.
        say: told what is being done.

    Raises:
        InputError: the data is too small to leave something out.
        UnknownName: there is no such policy.
        MissingBackend: an extra that a policy needs is not installed.
    """
    if len(np.unique(situations.objects)) < 2 or len(situations) < _LEAST_SITUATIONS:
        raise InputError(
            "data set",
            "",
            f"must have two objects and {_LEAST_SITUATIONS} situations at least to leave some out",
        )
    whole = prepare(situations)
    free = prepare(situations, free=True)
    comparisons: list[Comparison] = []
    for protocol in PROTOCOLS:
        if protocol.name in unseen:
            prepared = free if protocol.free else whole
            comparisons += compare(policies, prepared, protocol, seeds=seeds, say=say)
    learned = [name for name in policies if is_learned(name)]
    curve = learning_curve(learned, whole, seeds=seeds, say=say)
    explained = _best(comparisons, learned)
    return Study(
        **_counts(situations),
        seeds=seeds,
        comparisons=tuple(comparisons),
        curve=tuple(curve),
        explained=explained,
        importances=tuple(_importances(explained, whole)) if explained else (),
    )


def study_models(situations: Situations, models: Mapping[str, Model]) -> Study:
    """Compares models on the objects that none of them was trained on, with what needs no training.

    Args:
        situations: the data.
        models: by the names under which they are shown.

    Raises:
        InputError: they were trained on all objects of the data, or need features that it does not have.
    """
    units = {column.name: column.unit for column in situations.columns}
    seen: set[str] = set()
    for name, model in models.items():
        model.check_fits(units, name)
        seen |= set(model.trained_on.objects)
    tested = np.flatnonzero(~np.isin(situations.objects, sorted(seen)))
    if not len(tested):
        raise InputError("data set", "", "has no object that the models have not been trained on")
    nothing = np.zeros(0, dtype=np.int64)
    prepared = Prepared(situations, (), np.zeros((len(situations.features), 0)))
    rows = np.arange(len(situations.features))
    runs = {}
    for name in default_policies(situations):
        if not is_learned(name):
            trained = train(name, prepared, nothing)
            loads = range(len(situations.loads))
            runs[name] = Runs([np.stack([prepared.scores(trained, load, rows) for load in loads])], False)
    for name, model in models.items():
        runs[name] = Runs([_scores(model, situations)], model.is_chance)
    return Study(
        **_counts(situations), seeds=0, comparisons=tuple(compare_runs(runs, situations, tested, "object"))
    )


def _scores(model: Model, situations: Situations) -> Array:
    return np.stack(
        [
            model.scores(situations.names, situations.features, situations.first, float(load))
            for load in situations.loads
        ]
    )


def _counts(situations: Situations) -> dict[str, Any]:
    return {
        "situations": len(situations),
        "objects": len(np.unique(situations.objects)),
        "candidates": len(situations.features),
        "draws": situations.held.shape[1],
        "hands": tuple(np.unique(situations.hands).tolist()),
    }


def _best(comparisons: Sequence[Comparison], learned: Sequence[str]) -> str:
    """The policy that learns with the most success on unseen objects, over all loads."""
    success = dict.fromkeys(learned, 0.0)
    for entry in comparisons:
        for one in entry.standings:
            if entry.protocol == comparisons[0].protocol and one.policy in success:
                success[one.policy] += one.success.value
    return max(success, key=success.__getitem__, default="")


def _importances(policy: str, prepared: Prepared) -> list[Importance]:
    split = next(object_folds(prepared.situations, 0))
    return importances(train(policy, prepared, split.train), prepared, split, 0)


def _comparison(entry: Comparison) -> dict[str, Any]:
    return {
        "unseen": entry.protocol,
        "load": entry.load,
        "situations": entry.situations,
        "objects": entry.objects,
        "best_formula": entry.best_formula,
        "policies": [_standing(one) for one in entry.standings],
    }


def _standing(one: Standing) -> dict[str, Any]:
    return {
        "policy": one.policy,
        "success": one.success.as_list,
        "iqm": one.iqm.as_list,
        "regret": one.regret.as_list,
        "auc": one.auc.as_list,
        "tests_before": one.before.as_list,
        "tests_saved": one.saved.as_list,
        "above_formula": one.above_formula.as_list,
        "gap_closed": one.gap_closed.as_list,
        "calibration": None if one.calibration is None else asdict(one.calibration),
    }
