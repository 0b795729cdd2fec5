"""How candidates stand among their rivals."""

import numpy as np
import pytest
from holdfast.pipeline.choose.inputs import Input, compute_inputs, default_inputs
from holdfast.pipeline.choose.situations import to_situations
from scipy.stats import zscore

from ..choice.synthetic import make_choice_data


def test_ranks_and_distances_are_within_a_situation() -> None:
    features = np.array([[1.0], [3.0], [3.0], [8.0], [5.0]])
    inputs = [Input(feature="a", form=form) for form in ("value", "rank", "distance")]
    found = compute_inputs(inputs, ["a"], features, np.array([0, 4, 5]))
    assert found[:, 0].tolist() == [1.0, 3.0, 3.0, 8.0, 5.0]
    assert found[:, 1].tolist() == [0.0, 0.5, 0.5, 1.0, 0.5]
    assert found[:4, 2] == pytest.approx(zscore(features[:4, 0]))
    assert found[4, 2] == 0.0


def test_the_order_of_candidates_has_no_say_in_any_bit() -> None:
    s = to_situations(make_choice_data(groups=12, candidates=9))
    inputs = default_inputs(s.columns, s.of_object)
    order = np.lexsort((np.random.default_rng(0).random(len(s.features)), s.situation))
    plain = compute_inputs(inputs, s.names, s.features, s.first)
    shuffled = compute_inputs(inputs, s.names, s.features[order], s.first)
    assert np.array_equal(plain[order], shuffled)


def test_what_speaks_of_one_hand_is_left_out_on_request() -> None:
    s = to_situations(make_choice_data(groups=4))
    whole = {entry.feature for entry in default_inputs(s.columns, s.of_object)}
    free = {entry.feature for entry in default_inputs(s.columns, s.of_object, free=True)}
    assert whole - free == {"joint_0"}
    # The same for all candidates: nothing to compare.
    forms = [e.form for e in default_inputs(s.columns, s.of_object) if e.feature == "mass"]
    assert forms == ["value"]
