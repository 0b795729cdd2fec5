"""What is tested was not trained on."""

import numpy as np
import pytest
from holdfast.pipeline.choose.situations import Situations, to_situations
from holdfast.pipeline.choose.study.splits import PROTOCOLS, object_folds

from ...choice.synthetic import make_choice_data


@pytest.fixture(scope="module")
def situations() -> Situations:
    """Three hands, two kinds of task; some objects are in several situations."""
    s = to_situations(make_choice_data(groups=30, hands=("sa", "shadow", "allegro"), tasks=("lift", "turn")))
    s.objects[10:20] = s.objects[:10]
    return s


def test_every_situation_is_tested_once_and_never_trained_on(situations: Situations) -> None:
    for protocol in PROTOCOLS:
        tested = []
        for split in protocol.splits(situations, 3):
            assert not set(split.train) & set(split.test)
            assert sorted([*split.train, *split.test]) == list(range(len(situations)))
            seen = {
                "object": situations.objects,
                "hand": situations.hands,
                "task": situations.tasks,
            }[protocol.name]
            assert not set(seen[split.train]) & set(seen[split.test])
            tested += split.test.tolist()
        assert sorted(tested) == list(range(len(situations)))


def test_seeds_deal_differently_and_repeat(situations: Situations) -> None:
    def dealt(seed: int) -> list[list[int]]:
        return [split.test.tolist() for split in object_folds(situations, seed)]

    assert dealt(1) == dealt(1) != dealt(2)


def test_families_are_spread_over_folds() -> None:
    s = to_situations(make_choice_data(groups=50))
    s.families[:] = np.repeat(["mug", "box"], 25)
    for split in object_folds(s, 0):
        assert np.unique(s.families[split.test], return_counts=True)[1].tolist() == [5, 5]


def test_one_hand_alone_leaves_nothing_out() -> None:
    s = to_situations(make_choice_data(groups=4, hands=("sa",)))
    assert [list(p.splits(s, 0)) for p in PROTOCOLS if p.name != "object"] == [[], []]
