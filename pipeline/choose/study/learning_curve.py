"""How much a policy gains by more objects."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ....base.numeric.arrays import Indices
from ..policies import Prepared, train
from ..situations import Names
from .intervals import Estimate, mean_over_objects
from .measures import Figures, figures
from .splits import object_folds

__all__ = ["CurvePoint", "learning_curve"]

_SHARES = (0.125, 0.25, 0.5, 1.0)
_FEWEST_OBJECTS = 4


@dataclass(frozen=True)
class CurvePoint:
    """A policy that was trained on some of the objects.

    Attributes:
        policy: its name.
        load: multiple of the object's weight.
        objects: that it was trained on, mean over the seeds.
        success: share of the draws in which its first choice held, on objects that it has not seen.
        auc: within situations, how likely what held scores above what did not, on the same.
    """

    policy: str
    load: float
    objects: float
    success: Estimate
    auc: Estimate


def learning_curve(
    policies: Sequence[str],
    prepared: Prepared,
    *,
    seeds: int = 5,
    say: Callable[[str], None] = lambda text: None,
) -> list[CurvePoint]:
    """Success on unseen objects by the number of objects that were trained on, under each load.

    With each seed one fold of the objects is the test, another one each time; of the others more and more are
    trained on, those before among them.

    Args:
        policies: their names.
        prepared: situations and inputs.
        seeds: number of tests.
        say: told what is being done.
    """
    points = []
    situations = prepared.situations
    # One deal for all seeds: no object is tested twice.
    splits = list(object_folds(situations, 0, folds=max(2, seeds)))
    for policy in policies:
        say(f"  learning curve: {policy}")
        for share in _SHARES:
            found: list[list[Figures]] = []
            objects, counts = [], []
            for seed, split in enumerate(splits):
                chosen = _some_objects(situations.objects[split.train], share, seed)
                count = len(np.unique(situations.objects[split.train][chosen]))
                if count < _FEWEST_OBJECTS:
                    continue
                counts.append(count)
                trained = train(policy, prepared, split.train[chosen], seed=seed)
                tested, rows = situations.take(split.test), situations.rows(split.test)
                found.append(
                    [
                        figures(tested, prepared.scores(trained, load, rows), load)
                        for load in range(len(situations.loads))
                    ]
                )
                objects.append(tested.objects)
            if counts:
                names = np.concatenate(objects)
                points += [
                    CurvePoint(
                        policy,
                        float(load),
                        float(np.mean(counts)),
                        *(
                            mean_over_objects(np.concatenate([one[k].by_name[name] for one in found]), names)
                            for name in ("success", "auc")
                        ),
                    )
                    for k, load in enumerate(situations.loads)
                ]
    return points


def _some_objects(objects: Names, share: float, seed: int) -> Indices:
    """Places of the situations of a share of the objects; with one seed a larger share holds a smaller."""
    names = np.unique(objects)
    order = np.random.default_rng(seed).permutation(len(names))
    taken = names[order[: max(1, round(share * len(names)))]]
    return np.flatnonzero(np.isin(objects, taken))
