"""From parts to arrays."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError
from ..choice import CONDITIONS, OBJECT_FEATURES, ChoiceData, candidate_specs
from .part import Part
from .plan import DatasetPlan
from .splits import held_out_kinds, split_by_hand, split_by_object, split_by_task

__all__ = ["assemble", "usable"]


def usable(parts: Sequence[Part]) -> list[Part]:
    """The parts among whose candidates there is something to choose."""
    return [part for part in parts if len(part.candidates) > 1]


def assemble(parts: Sequence[Part], plan: DatasetPlan, hands: Sequence[str]) -> ChoiceData:
    """The arrays of a data set.

    Args:
        parts: those that are usable, in their order.
        plan: what was asked for.
        hands: names of the hands, in the order in which they were asked for.

    Raises:
        InputError: there are none.
    """
    if not parts:
        raise InputError("dataset", "", "no situation has two candidates: try other objects, or another hand")
    objects = list(dict.fromkeys(part.plan[0] for part in parts))
    own = max(len(part.candidates[0].features) for part in parts)
    specs = candidate_specs(0)
    specs = candidate_specs(own - len(specs))
    sizes = [len(part.candidates) for part in parts]
    kinds = held_out_kinds(parts)
    return ChoiceData(
        features=np.concatenate([_features(part, own) for part in parts]),
        feature_specs=specs,
        object_features=np.array([_told_first(parts, name) for name in objects], dtype=np.float32),
        object_specs=OBJECT_FEATURES,
        group=np.repeat(np.arange(len(parts)), sizes),
        object_index=np.repeat([objects.index(part.plan[0]) for part in parts], sizes),
        object_ids=np.array(objects),
        candidate_ids=np.array(
            [
                f"{k:05d}/{candidate.solution.id}"
                for k, part in enumerate(parts)
                for candidate in part.candidates
            ]
        ),
        hand=_repeated([part.told.hand for part in parts if part.told], sizes),
        task=_repeated([part.told.kind for part in parts if part.told], sizes),
        held=np.concatenate([_outcomes(part, "held", bool) for part in parts]),
        margin=np.concatenate([_outcomes(part, "margin", np.float32) for part in parts]),
        conditions=np.array([part.conditions for part in parts], dtype=np.float32),
        condition_names=tuple(name for name, _, _ in CONDITIONS),
        loads=plan.loads,
        splits={
            "object": _repeated([split_by_object(part) for part in parts], sizes),
            "hand": _repeated([split_by_hand(part, hands) for part in parts], sizes),
            "task": _repeated([split_by_task(part, kinds) for part in parts], sizes),
        },
    )


def _features(part: Part, count: int) -> NDArray[np.float32]:
    rows = np.zeros((len(part.candidates), count), dtype=np.float32)
    for row, candidate in zip(rows, part.candidates, strict=True):
        row[: len(candidate.features)] = candidate.features
    return rows


def _told_first(parts: Sequence[Part], reference: str) -> list[float]:
    return next(part.told.object_features for part in parts if part.told and part.plan[0] == reference)


def _outcomes(part: Part, field: str, dtype: type) -> NDArray:  # type: ignore[type-arg]
    return np.array([[[getattr(one, field) for one in draw] for draw in row] for row in part.outcomes], dtype)


def _repeated(values: list[str], sizes: list[int]) -> NDArray[np.str_]:
    return np.repeat(np.array(values), sizes)
