"""Work that is given up half way, and work that nobody asks to be."""

import pytest
from holdfast.base.machine.cancellation import Cancelled, cancellable, give_up_if_asked


def count_to(limit: int, done: list[int]) -> None:
    for k in range(limit):
        give_up_if_asked()
        done.append(k)


def test_work_that_nobody_can_cancel_runs_to_its_end() -> None:
    done: list[int] = []
    count_to(5, done)
    assert done == list(range(5))


def test_work_ends_at_the_first_question_after_it_should() -> None:
    done: list[int] = []
    with pytest.raises(Cancelled), cancellable(lambda: len(done) == 3):
        count_to(5, done)
    assert done == [0, 1, 2]


def test_what_comes_after_is_not_asked_any_more() -> None:
    with pytest.raises(Cancelled), cancellable(lambda: True):
        give_up_if_asked()
    give_up_if_asked()
