"""What comes out of the stages does not depend on the processes that do them."""

import os
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from holdfast.grasping import Refusal, Trial
from holdfast.mjcf import HoldSettings
from holdfast.objects import Task, load_task
from holdfast.pipeline.records import GraspRecord, read_run, to_json, to_state
from holdfast.pipeline.report import describe
from holdfast.pipeline.run import RunSettings, new_grasp, run_task, with_clearing, with_trial
from holdfast.pipeline.run import crew as crew_module
from holdfast.pipeline.run import run as run_module
from holdfast.pipeline.run.attempts import Attempt, TryState
from holdfast.pipeline.run.crew import Crew, CrewSetup, CrewWorker, Job
from holdfast.retraction import RetractionSettings
from holdfast.solver import State, solve

SHORT = HoldSettings(directions=((0.0, 0.0, 1.0),), hold_s=0.1, squeeze_s=0.1, settle_s=0.1)


@dataclass(frozen=True, eq=False)
class KillingSetup(CrewSetup):
    """Processes that kill themselves: over one state every time, over all others until a file says so."""

    doomed: State | None = None
    marks: Path | None = None

    def new_worker(self) -> "KillingWorker":
        return KillingWorker(self)


class KillingWorker(CrewWorker):
    def __init__(self, setup: KillingSetup):
        super().__init__(setup)
        self._killing = setup

    def work(self, job: Job[Any], /) -> Any:
        if not isinstance(job, TryState):
            return super().work(job)
        state = job.state
        assert self._killing.marks is not None and self._killing.doomed is not None
        if state.q.tolist() == self._killing.doomed.q.tolist():
            os.kill(os.getpid(), signal.SIGKILL)
        mark = self._killing.marks / str(hash(tuple(state.q.tolist())))
        if not mark.exists():
            mark.touch()
            os.kill(os.getpid(), signal.SIGKILL)
        return super().work(job)


def found(task: Task, count: int) -> tuple[list[GraspRecord], list[State]]:
    """Grasps by the solver, and the states of their records."""
    configurations = solve(task, candidates=count, seed=0).configurations
    grasps = [new_grasp(configuration, f"g{i:02d}") for i, configuration in enumerate(configurations, 1)]
    return grasps, [to_state(grasp, task, "test") for grasp in grasps]


def attempt_all(
    states: list[State],
    setup: CrewSetup,
    *,
    workers: int = 1,
    is_over: Callable[[], bool] = lambda: False,
    should_stop: Callable[[], bool] = lambda: False,
) -> Iterator[Attempt]:
    with Crew(setup, workers) as crew:
        jobs = [TryState(state) for state in states]
        yield from crew.results(jobs, is_over=is_over, should_stop=should_stop)


def written(grasp: GraspRecord, attempt: Attempt) -> GraspRecord:
    assert isinstance(attempt.outcome, Trial)
    assert attempt.outcome.grasp.clearing is not None
    return with_trial(with_clearing(grasp, attempt.outcome.grasp.clearing), attempt.outcome)


@pytest.fixture(autouse=True)
def _nothing_to_compile(monkeypatch: pytest.MonkeyPatch) -> None:
    """All states go to the processes, also where this one has just compiled the solver."""
    monkeypatch.setattr(crew_module, "compile_s", lambda: 0.0)


def test_processes_that_got_ready_are_those_that_work(monkeypatch: pytest.MonkeyPatch) -> None:
    """As many as may find work, started once; the first job is done here where all had to be compiled."""
    opened: list[int] = []

    class Pool:
        def submit(self, job: Any) -> Future[Any]:
            future: Future[Any] = Future()
            future.set_result(("there", job))
            return future

    def open_pool(setup: object, count: int) -> AbstractContextManager[Pool]:
        opened.append(count)
        return nullcontext(Pool())

    class Setup:
        def new_worker(self) -> Any:
            return SimpleNamespace(work=lambda job: ("here", job))

        def prepare(self) -> None:
            prepared.append(len(opened))

    prepared: list[int] = []
    monkeypatch.setattr(crew_module, "open_pool", open_pool)
    monkeypatch.setattr(crew_module, "compile_s", lambda: 1.0)
    monkeypatch.setattr(crew_module, "can_fork", lambda: False)
    for workers, most, count in ((1, 5, []), (4, 1, []), (4, 3, [3]), (2, 9, [2])):
        opened.clear()
        with Crew(Setup(), workers) as crew:  # type: ignore[arg-type]
            crew.get_ready(most)
            crew.get_ready(most)
            assert opened == count
            if count:
                first, *others = crew.results(["a", "b", "c"])  # type: ignore[list-item]
                assert first == ("here", "a") and others == [("there", "b"), ("there", "c")]
                assert list(crew.results(["d"])) == [("there", "d")]  # type: ignore[list-item]
                assert opened == count
    assert prepared == []
    # Copies of this process start late, once it has what they need.
    monkeypatch.setattr(crew_module, "can_fork", lambda: True)
    opened.clear()
    with Crew(Setup(), 2) as crew:  # type: ignore[arg-type]
        crew.get_ready(3)
        assert opened == []
        assert list(crew.results(["a", "b", "c"]))[1:] == [("there", "b"), ("there", "c")]  # type: ignore[list-item]
        assert opened == [2] and prepared == [0]


def test_other_work_is_done_while_others_are_at_theirs(monkeypatch: pytest.MonkeyPatch) -> None:
    """Piece by piece where this process would wait, and no more of it than it takes."""
    promises: list[Future[str]] = []

    class Pool:
        def submit(self, job: str) -> Future[str]:
            promises.append(Future())
            return promises[-1]

    class Setup:
        def new_worker(self) -> None:
            pass

        def prepare(self) -> None:
            pass

    def piece() -> bool:
        pieces.append(len(promises))
        if len(pieces) == 3:
            promises[0].set_result("a")
            promises[1].set_result("b")
        return len(pieces) <= 3

    pieces: list[int] = []
    monkeypatch.setattr(crew_module, "open_pool", lambda *_: nullcontext(Pool()))
    with Crew(Setup(), 2) as crew:  # type: ignore[arg-type]
        results = crew.results(["a", "b"], meanwhile=piece)  # type: ignore[list-item]
        assert list(results) == ["a", "b"]
    assert pieces == [2, 2, 2]


def test_workers_change_nothing() -> None:
    task = load_task("upholding")
    grasps, states = found(task, 3)
    setup = CrewSetup(task, SHORT, RetractionSettings())
    alone = list(attempt_all(states, setup, workers=1, should_stop=lambda: False))
    together = list(attempt_all(states, setup, workers=2, should_stop=lambda: False))
    assert len(alone) == len(together) == 3
    for grasp, one, other in zip(grasps, alone, together, strict=True):
        assert one.mjcf == other.mjcf
        assert to_json(written(grasp, one)) == to_json(written(grasp, other))
        assert isinstance(other.outcome, Trial)
        assert other.outcome.grasp.configuration.task is task


def test_a_killed_worker_costs_its_grasp_and_no_more(tmp_path: Path) -> None:
    task = load_task("upholding")
    grasps, states = found(task, 3)
    setup = CrewSetup(task, SHORT, RetractionSettings())
    killing = KillingSetup(task, SHORT, RetractionSettings(), doomed=states[1], marks=tmp_path)
    alone = list(attempt_all(states, setup, workers=1, should_stop=lambda: False))
    survived = list(attempt_all(states, killing, workers=2, should_stop=lambda: False))
    assert len(list(tmp_path.iterdir())) == 2  # each of the other two has cost a process, too
    assert [attempt.outcome is None for attempt in survived] == [False, True, False]
    assert survived[1].mjcf.startswith("<mujoco")
    for k in (0, 2):
        assert to_json(written(grasps[k], survived[k])) == to_json(written(grasps[k], alone[k]))


@pytest.mark.slow
@pytest.mark.usefixtures("without_pictures")
def test_a_run_whose_workers_are_killed_says_so_and_ends(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    task = load_task("upholding")
    doomed = found(task, 3)[1][0]

    def killing(task: Task, hold: HoldSettings, retraction: RetractionSettings) -> CrewSetup:
        return KillingSetup(task, hold, retraction, doomed=doomed, marks=tmp_path)

    monkeypatch.setattr(run_module, "CrewSetup", killing)
    path = tmp_path / "run"
    record = run_task("upholding", path, RunSettings(candidates=3, choice=1, wanted=1, workers=2))
    assert record.complete and record.verdict == "held" and len(record.good) == 2
    assert read_run(path / "run.json") == record
    (lost,) = (grasp for grasp in record.grasps if grasp.clearance is None)
    assert lost.id == "g01" and lost.is_done and lost.is_untested and not lost.is_held
    assert "every process that worked on it broke down" in describe(lost)
    assert "every process that worked on it broke down" in (path / "report.html").read_text("utf-8")
    # The pictures that this test does without are asked for again, which takes time.
    again = run_task("upholding", path, RunSettings(candidates=3, choice=1, wanted=1), resume=True)
    assert again.model_copy(update={"seconds": record.seconds}) == record


def test_nothing_new_is_begun_once_it_should_stop() -> None:
    task = load_task("upholding")
    _, states = found(task, 1)
    setup = CrewSetup(task, HoldSettings(), RetractionSettings())
    assert list(attempt_all([*states, *states], setup, workers=2, should_stop=lambda: True)) == []


def test_a_state_under_way_is_given_up_when_it_should_stop() -> None:
    """Asked before the state is begun and then deep inside, where the second answer ends it."""
    task = load_task("upholding")
    _, states = found(task, 1)
    answers = iter([False, True])
    setup = CrewSetup(task, HoldSettings(), RetractionSettings())
    assert list(attempt_all(states, setup, should_stop=lambda: next(answers))) == []
    assert next(answers, None) is None


@pytest.mark.parametrize("workers", [1, 2])
def test_what_was_begun_in_time_is_finished_and_no_more(workers: int) -> None:
    """The time is over when the first attempt has come in; each process may be at another one by then."""
    task = load_task("upholding")
    _, states = found(task, 2)
    setup = CrewSetup(task, SHORT, RetractionSettings())
    attempts = attempt_all(states * 5, setup, workers=workers, is_over=lambda: is_over)
    is_over = False
    done = [next(attempts)]
    is_over = True
    done += attempts
    assert 1 <= len(done) <= workers**2  # those that came in meanwhile, and those under way
    assert all(isinstance(attempt.outcome, Trial) for attempt in done)


def test_what_cannot_be_squeezed_is_refused_with_its_model() -> None:
    """A margin wider than the fingers can open: no grasp, but a model of the configuration."""
    task = load_task("upholding")
    _, states = found(task, 1)
    setup = CrewSetup(task, SHORT, RetractionSettings(margin_m=0.5, restarts=1))
    (attempt,) = attempt_all(states, setup, should_stop=lambda: False)
    assert isinstance(attempt.outcome, Refusal) and attempt.outcome.clearing is not None
    assert not attempt.outcome.clearing.is_clear and attempt.mjcf.startswith("<mujoco")
