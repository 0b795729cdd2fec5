"""Which situations are trained on and which are only seen in the test."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from ....base.numeric.arrays import Indices
from ..situations import Names, Situations

__all__ = ["PROTOCOLS", "Protocol", "Split", "object_folds"]

_FOLDS = 5


@dataclass(frozen=True, eq=False)
class Split:
    """Situations by their numbers; none is in both.

    Attributes:
        name: what is unseen.
        train: to learn from.
        test: to be judged by.
    """

    name: str
    train: Indices
    test: Indices


@dataclass(frozen=True)
class Protocol:
    """A question about what was not seen.

    Attributes:
        name: of the question, such as `object`.
        free: whether features that speak of one hand alone are left out.
        splits: splits by situations and seed; every situation is tested once, or never.
    """

    name: str
    free: bool
    splits: Callable[[Situations, int], Iterator[Split]]


def object_folds(situations: Situations, seed: int, folds: int = _FOLDS) -> Iterator[Split]:
    """Objects dealt out to so many folds, each family evenly; each fold is the test once.

    Other seeds deal differently. With fewer objects than folds there are fewer.
    """
    rng = np.random.default_rng(seed)
    names, first = np.unique(situations.objects, return_index=True)
    families = situations.families[first]
    order = rng.permutation(len(names))
    order = order[np.argsort(families[order], kind="stable")]
    fold = np.empty(len(names), dtype=np.int64)
    fold[order] = np.arange(len(names)) % folds
    of_situation = fold[np.searchsorted(names, situations.objects)]
    for number in range(min(folds, len(names))):
        is_test = of_situation == number
        yield Split(f"fold {number + 1}", np.flatnonzero(~is_test), np.flatnonzero(is_test))


def _leave_one_out(kinds: Names) -> Iterator[Split]:
    names = np.unique(kinds)
    for name in names if len(names) > 1 else ():
        is_test = kinds == name
        yield Split(str(name), np.flatnonzero(~is_test), np.flatnonzero(is_test))


def _hand(situations: Situations, seed: int) -> Iterator[Split]:
    del seed
    return _leave_one_out(situations.hands)


def _task(situations: Situations, seed: int) -> Iterator[Split]:
    del seed
    return _leave_one_out(situations.tasks)


PROTOCOLS = (
    Protocol("object", False, object_folds),
    Protocol("hand", True, _hand),
    Protocol("task", False, _task),
)
"""An unseen object; an unseen hand; an unseen kind of task. Hands and kinds are left out one at a time."""
