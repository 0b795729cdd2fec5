"""A session on a toy domain: it finds the squares among ranges of whole numbers."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from holdfast.errors import InputError
from holdfast.solver.search import (
    Outcome,
    Progress,
    SearchOrder,
    Session,
    Snapshot,
    Stopwatch,
    Subtree,
    SubtreeResult,
    begin_at,
    search_subtree,
)

SQUARES = [k * k for k in range(16)]


@dataclass(frozen=True)
class Range:
    """Whole numbers from `first` to `last`, both included."""

    first: int
    last: int


@dataclass(frozen=True)
class Setup:
    """Looks for squares."""

    @property
    def shared(self) -> tuple[object, ...]:
        return ()

    def new_worker(self) -> "SquareFinder":
        return SquareFinder()

    def give_up(self, job: Subtree[Range]) -> SubtreeResult[Range, int]:
        return SubtreeResult(processed=1, undecided=[job.region], decided=1.0)


class SquareFinder:
    """Splits ranges that hold a square until they hold nothing else."""

    def work(self, job: Subtree[Range]) -> SubtreeResult[Range, int]:
        return search_subtree(job, self._process, SearchOrder.BREADTH_FIRST)

    def _process(self, region: Range) -> Outcome[Range, int]:
        if math.isqrt(region.last) ** 2 < region.first:
            return Outcome()
        if region.first == region.last:
            return Outcome([region.first])
        middle = (region.first + region.last) // 2
        return Outcome(children=[Range(region.first, middle), Range(middle + 1, region.last)])


def is_within(part: Range, whole: Range) -> bool:
    return whole.first <= part.first <= part.last <= whole.last


class SquareSearch(Session[Range, int, Subtree[Range], SubtreeResult[Range, int]]):
    """Counts the results that it takes in, and keeps that count in its file."""

    def __init__(
        self,
        *,
        checkpoint: Path | None = None,
        resume: bool = False,
        ends_after: float = math.inf,
        at_end: Callable[[], None] = lambda: None,
    ):
        state = begin_at([Range(0, 255)], SearchOrder.BREADTH_FIRST)
        super().__init__(Setup(), SquareFinder(), state, workers=1, watch=Stopwatch(), at_end=at_end)
        self.taken_in = 0
        self._ends_after = ends_after
        if checkpoint is not None:
            self.keep_in(
                checkpoint, what="toy", fingerprint="1", kind=Range, is_part=is_within, resume=resume
            )

    def cut(self, box: Range, depth: int) -> Subtree[Range]:
        return Subtree(box, depth, size=3)

    def lookahead(self) -> int:
        return 2

    def job(self, subtree: Subtree[Range]) -> Subtree[Range]:
        return subtree

    def take_in(self, result: SubtreeResult[Range, int]) -> SubtreeResult[Range, int]:
        self.taken_in += 1
        return result

    def is_endless(self) -> bool:
        return self.taken_in >= self._ends_after

    def snapshot(self) -> Snapshot:
        return Snapshot(
            {"taken_in": self.taken_in}, {"found": np.array(self.state.solutions, dtype=np.int64)}
        )

    def restore(self, saved: Snapshot) -> None:
        self.taken_in = saved.numbers["taken_in"]
        self.state.solutions = saved.arrays["found"].tolist()


@pytest.fixture(scope="module")
def whole() -> SquareSearch:
    search = SquareSearch()
    search.finish(budget_s=math.inf)
    return search


def test_it_finds_everything_and_tells_that_nothing_is_open(whole: SquareSearch) -> None:
    assert sorted(whole.state.solutions) == SQUARES
    progress = whole.progress
    assert (progress.open, progress.undecided, progress.found) == (0, 0, 16)
    assert progress.decided == 1.0 and progress.boxes == whole.state.processed > 100
    assert 0.0 <= progress.seconds <= whole.seconds


def test_the_end_is_told_once_and_only_where_nothing_is_open() -> None:
    ends: list[int] = []
    search = SquareSearch(at_end=lambda: ends.append(search.state.n_open))
    search.finish(budget_s=math.inf, enough=lambda: bool(search.state.solutions))
    assert ends == [] and search.state.n_open > 0
    search.finish(budget_s=math.inf)
    assert ends == [0]


def test_a_spent_budget_ends_it_after_one_step() -> None:
    search = SquareSearch()
    search.finish(budget_s=0.0)
    assert search.taken_in == 1


def test_progress_comes_before_the_question_whether_to_stop() -> None:
    reports: list[Progress] = []
    search = SquareSearch()
    search.finish(budget_s=math.inf, on_progress=reports.append, should_stop=lambda: len(reports) >= 4)
    assert search.taken_in == len(reports) == 4
    assert [report.boxes for report in reports] == sorted(report.boxes for report in reports)
    assert reports[-1] == Progress(**{**vars(search.progress), "seconds": reports[-1].seconds})


def test_what_is_enough_from_the_start_takes_no_step() -> None:
    search = SquareSearch()
    search.finish(budget_s=math.inf, enough=lambda: True)
    assert search.taken_in == 0


def test_a_search_without_end_stops_with_what_is_open(whole: SquareSearch) -> None:
    search = SquareSearch(ends_after=5)
    search.finish(budget_s=math.inf)
    assert search.taken_in == 5 and search.state.n_open > 0
    search.finish(budget_s=math.inf)
    assert search.taken_in == 5


@pytest.mark.parametrize("steps", [1, 7, 20])
def test_a_session_goes_on_from_its_file(whole: SquareSearch, tmp_path: Path, steps: int) -> None:
    path = tmp_path / "toy.checkpoint"
    left = SquareSearch(checkpoint=path)
    left.finish(budget_s=math.inf, enough=lambda: left.taken_in >= steps)
    again = SquareSearch(checkpoint=path, resume=True)
    assert again.taken_in == steps and again.seconds >= left.progress.seconds - 1.0
    assert again.state.n_open == left.state.n_open
    again.finish(budget_s=math.inf)
    assert again.state.solutions == whole.state.solutions
    assert (again.taken_in, again.state.processed) == (whole.taken_in, whole.state.processed)


def test_a_session_writes_no_file_that_it_may_not(tmp_path: Path) -> None:
    path = tmp_path / "toy.checkpoint"
    SquareSearch(checkpoint=path)
    with pytest.raises(InputError, match="exists; resume it"):
        SquareSearch(checkpoint=path)
