"""The policies by name, and how each is trained."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ...base.numeric.arrays import Array, Indices
from ...errors import InputError, UnknownName
from ..choice import Feature
from .bandit import train_bandit
from .blend import train_blend
from .boosting import train_advantage, train_boosting, train_ranker
from .heads import AnyHead, Flat, Linear, Order, Sum
from .inputs import Input, compute_inputs, default_inputs
from .logistic import train_logistic
from .masked_ppo import train_masked_ppo
from .situations import Situations
from .training_set import TrainingSet

__all__ = [
    "FORMULA",
    "SPRINGS",
    "Prepared",
    "Trained",
    "check_policy",
    "has_springs",
    "is_learned",
    "policy_names",
    "prepare",
    "train",
]

FORMULA = "formula:"
"""What the name of a policy begins with that goes by one measure."""

SPRINGS = "springs"
"""The policy that goes by the strains of a trial by springs, under the load and under twice the load."""

_STRAINS = ("f_spring_hold", "f_spring_hold_2")


def _train_team(data: TrainingSet) -> Sum:
    """What `blend` and `advantage` say together: both foretell the lead of a candidate over its rivals.

    Raises:
        InputError: see `train_blend`.
        MissingBackend: LightGBM is not installed.
    """
    return Sum(parts=[train_blend(data), train_advantage(data)])


_LEARNED: dict[str, Callable[[TrainingSet], AnyHead]] = {
    "blend": train_blend,
    "logistic": train_logistic,
    "boosting": train_boosting,
    "advantage": train_advantage,
    "team": _train_team,
    "ranker": train_ranker,
    "linucb": train_bandit,
    "maskable_ppo": train_masked_ppo,
}
_FIXED: dict[str, AnyHead] = {"random": Flat(), "first": Order()}


@dataclass(frozen=True, eq=False)
class Trained:
    """A policy that can choose.

    Attributes:
        policy: its name.
        inputs: what it computes with.
        heads: one for each load.
    """

    policy: str
    inputs: tuple[Input, ...]
    heads: tuple[AnyHead, ...]


@dataclass(frozen=True, eq=False)
class Prepared:
    """Situations with the inputs of policies that learn.

    Attributes:
        situations: N candidates in G situations.
        inputs: what is computed.
        values: (N, I).
    """

    situations: Situations
    inputs: tuple[Input, ...]
    values: Array

    def scores(self, trained: Trained, load: int, rows: Indices) -> Array:
        """Scores of some candidates by a policy that `train` has made of the same features."""
        situations = self.situations
        if trained.inputs == self.inputs:
            values = self.values[rows]
        else:
            places = {name: k for k, name in enumerate(situations.names)}
            columns = [places[entry.feature] for entry in trained.inputs if entry.form == "value"]
            values = situations.features[np.ix_(rows, np.array(columns, dtype=np.int64))]
        return trained.heads[load].scores(values, situations.place[rows])


def policy_names(formulas: Sequence[Feature]) -> tuple[str, ...]:
    """Names of all policies that can be trained."""
    return (*_FIXED, SPRINGS, *(FORMULA + formula.name for formula in formulas), *_LEARNED)


def has_springs(situations: Situations) -> bool:
    """Whether situations are described by a trial by springs."""
    return set(_STRAINS) <= set(situations.names)


def _smallest_sum(count: int) -> Linear:
    return Linear(mean=[0.0] * count, scale=[1.0] * count, weights=[-1.0] * count)


def is_learned(policy: str) -> bool:
    """Whether outcomes have a say in it."""
    return policy in _LEARNED


def check_policy(policy: str, formulas: Sequence[Feature]) -> str:
    """The name itself.

    Raises:
        UnknownName: there is no such policy.
    """
    names = policy_names(formulas)
    if policy not in names:
        raise UnknownName("choose", "--policy", "policy", policy, names)
    return policy


def prepare(situations: Situations, *, free: bool = False) -> Prepared:
    """Situations with their inputs.

    Args:
        situations: the situations.
        free: whether to leave out features that speak of one hand alone.
    """
    inputs = default_inputs(situations.columns, situations.of_object, free=free)
    values = compute_inputs(inputs, situations.names, situations.features, situations.first)
    return Prepared(situations, inputs, values)


def train(policy: str, prepared: Prepared, chosen: Indices, *, seed: int = 0) -> Trained:
    """Trains a policy, for each load by itself.

    Args:
        policy: its name.
        prepared: situations with their inputs.
        chosen: the situations to train on.
        seed: of whatever is random in training.

    Raises:
        UnknownName: there is no such policy.
        InputError: there is nothing to learn from.
        MissingBackend: an extra that it needs is not installed.
    """
    situations = prepared.situations
    check_policy(policy, situations.formulas)
    loads = len(situations.loads)
    if policy in _FIXED:
        return Trained(policy, (), (_FIXED[policy],) * loads)
    if policy == SPRINGS:
        if not has_springs(situations):
            raise InputError(
                "data set", "", f"has no features {' and '.join(_STRAINS)}, which {SPRINGS} needs"
            )
        chosen_by = tuple(Input(feature=name, form="value") for name in _STRAINS)
        return Trained(policy, chosen_by, (_smallest_sum(len(chosen_by)),) * loads)
    if policy.startswith(FORMULA):
        name = policy.removeprefix(FORMULA)
        formula = next(entry for entry in situations.formulas if entry.name == name)
        head = Linear(mean=[0.0], scale=[1.0], weights=[float(formula.formula)])
        return Trained(policy, (Input(feature=name, form="value"),), (head,) * loads)
    if not len(chosen):
        raise InputError("data set", "", f"has no situation that {policy} could learn from")
    rows = situations.rows(chosen)
    first = np.concatenate([[0], np.cumsum(situations.sizes[chosen])]).astype(np.int64)
    held, margin = situations.held[rows], situations.margin[rows]
    signs = {column.name: column.formula for column in situations.columns}
    # Ranks say the same twice.
    directed = [signs.get(one.feature, 0) * (one.form == "distance") for one in prepared.inputs]
    heads = [
        _LEARNED[policy](
            TrainingSet(
                inputs=prepared.values[rows],
                first=first,
                held=held[:, :, load],
                margin=margin[:, :, load],
                signs=np.array(directed, dtype=np.float64),
                seed=seed,
            )
        )
        for load in range(loads)
    ]
    return Trained(policy, prepared.inputs, tuple(heads))
