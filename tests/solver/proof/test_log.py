"""Proof logs are written where something is proved, and change nothing of the search."""

import pytest
from holdfast.errors import InputError
from holdfast.solver import Verdict, solve

from ...check_proof.logs import plates


def test_nothing_is_written_where_nothing_is_proved(tmp_path):
    assert solve(plates(0.01), candidates=1, proof=tmp_path / "a").verdict is Verdict.SOLVED
    assert solve(plates(0.11), candidates=1, budget_s=0.0, proof=tmp_path / "b").verdict is Verdict.UNDECIDED
    assert list(tmp_path.iterdir()) == []


def test_a_place_that_can_not_be_written_is_refused_before_the_search(tmp_path):
    with pytest.raises(InputError, match="is a folder"):
        solve(plates(0.11), proof=tmp_path)


def test_the_search_is_the_same_with_a_log(tmp_path):
    with_log = solve(plates(0.13), candidates=1, proof=tmp_path / "p")
    without = solve(plates(0.13), candidates=1)
    assert (with_log.boxes, with_log.lps) == (without.boxes, without.lps)
