"""Sets of contacts that fail are left for others; a search that was ended goes on where it was."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import trimesh
from holdfast.base.machine.work_clock import WorkClock
from holdfast.errors import InputError
from holdfast.objects import load_task
from holdfast.pipeline.records import RunFolder, RunRecord, read_run
from holdfast.pipeline.report import EarlierSet
from holdfast.pipeline.run import RunSettings
from holdfast.pipeline.run_object import GraspRequest, ObjectRun, run_object
from holdfast.pipeline.run_object.runs import Clock

SETTINGS = RunSettings(candidates=2, wanted=1, budget_s=600.0)
# As many as the record of the fixture has.
GRASPS = 3


class Runs:
    """In place of runs: the records that they leave, each held or not as it is told.

    Attributes:
        tried: names of tasks, in their order.
        resumed: those that were gone on with.
        earlier: what the last of them was told of those before, by name and whether there is a picture.
    """

    def __init__(self, record: RunRecord, held: list[bool]):
        self._record, self._held = record, iter(held)
        self.tried: list[str] = []
        self.resumed: list[str] = []
        self.earlier: list[tuple[str, bool]] = []

    def __call__(
        self,
        reference: str,
        path: Path,
        settings: RunSettings,
        *,
        resume: bool,
        earlier: tuple[EarlierSet, ...],
        should_stop: Callable[[], bool],
        **_: Any,
    ) -> RunRecord:
        name = load_task(reference).name
        self.tried.append(name)
        self.earlier = [(one.task, one.picture is not None) for one in earlier]
        self.resumed += [name] if resume else []
        held = next(self._held)
        verdict = {"held": held, "narrow": False if held else None}
        grasps = []
        for grasp in self._record.grasps:
            assert grasp.hold is not None
            hold = grasp.hold.model_copy(update=verdict)
            grasps.append(grasp.model_copy(update={"certified": True, "hold": hold}))
        record = self._record.model_copy(
            update={
                "task": name,
                "grasps": grasps,
                "verdict": "held" if held else "not held",
                "complete": not should_stop(),
            }
        )
        path.mkdir(parents=True, exist_ok=True)
        RunFolder(path).save(record)
        if not held:
            (path / "media").mkdir(exist_ok=True)
            (path / "media" / f"{grasps[0].id}_front.png").write_bytes(b"a picture")
        return record


@pytest.fixture
def block(tmp_path: Path) -> Path:
    path = tmp_path / "block.stl"
    trimesh.creation.box((0.05, 0.05, 0.02)).export(path)
    return path


@pytest.fixture
def runs(run_record: RunRecord, monkeypatch: pytest.MonkeyPatch) -> Callable[[list[bool]], Runs]:
    def scripted(held: list[bool]) -> Runs:
        made = Runs(run_record, held)
        monkeypatch.setattr("holdfast.pipeline.run_object.runs.run_task", made)
        return made

    return scripted


def run(block: Path, folder: Path, **how: Any) -> ObjectRun:
    return run_object(GraspRequest(str(block), contacts=2), folder, SETTINGS, **how)


def test_other_contacts_follow_those_that_fail_and_a_stop_changes_nothing(
    block: Path, tmp_path: Path, runs: Callable[[list[bool]], Runs]
) -> None:
    whole = runs([False, False, True])
    done = run(block, tmp_path / "whole")
    assert done.is_enough and len(done.attempts) == 3
    assert len(set(whole.tried)) == 3 and whole.resumed == []
    assert whole.earlier == [(name, True) for name in whole.tried[:2]]
    lines = str(done).splitlines()
    assert len(lines) == 3 and "0 held (" in lines[0] and f"{GRASPS} held" in lines[2]
    assert {attempt.folder for attempt in done.attempts} == {tmp_path / "whole"}
    failed = read_run(done.folder / f"{whole.tried[0]}.run.json")
    assert (failed.task, failed.task_source) == (whole.tried[0], f"{whole.tried[0]}.yaml")

    # The same in two processes, the first of which is stopped while it runs the second set.
    first = runs([False, False])
    stopped = run(block, tmp_path / "parts", should_stop=lambda: len(first.tried) > 1)
    assert not stopped.is_held and first.tried == whole.tried[:2]
    second = runs([False, True])
    done = run(block, tmp_path / "parts", resume=True)
    assert second.tried == whole.tried[1:] and second.resumed == whole.tried[1:2]
    assert second.earlier == whole.earlier
    assert done.is_enough and [str(attempt) for attempt in done.attempts] == lines
    for name in whole.tried:
        texts = [(tmp_path / f"{folder}_task" / f"{name}.yaml").read_text() for folder in ("whole", "parts")]
        assert texts[0] == texts[1]

    # Nothing is left to do; and what is another search, or no search, is refused.
    nothing = runs([])
    assert run(block, tmp_path / "parts", resume=True).is_enough and nothing.tried == []
    with pytest.raises(InputError, match=r"search\.json: asked\.contacts: is 2.*can't resume"):
        run_object(GraspRequest(str(block)), tmp_path / "parts", SETTINGS, resume=True)
    file = tmp_path / "parts_task" / "search.json"
    data = json.loads(file.read_text("utf-8"))
    data["turns"][0]["contacts"] = 3
    file.write_text(json.dumps(data), "utf-8")
    with pytest.raises(InputError, match=r"turns\.0.*is none of this search"):
        run(block, tmp_path / "parts", resume=True)
    data["turns"][0] = {"contacts": 2, "rounds": 1, "tries": [{"step": "lost"}]}
    file.write_text(json.dumps(data), "utf-8")
    with pytest.raises(InputError, match=r"turns\.0\.tries\.0\.step"):
        run(block, tmp_path / "parts", resume=True)


def test_a_set_that_holds_too_little_keeps_its_folder(
    block: Path, tmp_path: Path, runs: Callable[[list[bool]], Runs]
) -> None:
    runs([True, True])
    settings = RunSettings(candidates=2, wanted=GRASPS + 1, budget_s=600.0)
    done = run_object(GraspRequest(str(block), contacts=2), tmp_path / "run", settings)
    folders = [attempt.folder.name for attempt in done.attempts]
    assert folders == ["run", "run_2"] and done.held == 2 * GRASPS
    again = run_object(GraspRequest(str(block), contacts=2), tmp_path / "run", settings, resume=True)
    assert [attempt.folder.name for attempt in again.attempts] == folders and again.held == done.held


def test_a_mesh_that_took_long_leaves_half_of_the_budget() -> None:
    clock = Clock(10.0, lambda: False)
    assert not clock.leave_at_least(0.5)
    late = Clock(10.0, lambda: False, Late())
    assert late.is_over and late.leave_at_least(0.5)
    assert late.remaining_s == pytest.approx(5.0) and not late.is_over


def test_what_is_under_way_is_given_up_some_time_after_the_budget() -> None:
    asked = False
    for budget_s, is_given_up in ((58.0, False), (40.0, True)):  # a tenth and 5 s later
        clock = Clock(budget_s, lambda: asked, Late())
        assert clock.is_over and clock.is_long_over() is is_given_up
    asked = True
    assert Clock(1000.0, lambda: asked, Late()).is_long_over()


def test_time_is_counted_by_stage_and_said_where_too_little_holds() -> None:
    clock = Clock(10.0, lambda: False, ticking := Ticking())
    with clock.during("mesh"):
        ticking.seconds = 4.0
    for end_s in (5.0, 7.0):
        with clock.during("search"):
            ticking.seconds = end_s
    assert clock.stages == {"mesh": 4.0, "search": 3.0}
    said = str(ObjectRun((), (), Path(), seconds=clock.stages))
    assert said.splitlines()[0] == "time: mesh 4 s, search 3 s"


class Ticking(WorkClock):
    """A clock that is set by hand."""

    seconds = 0.0


class Late(WorkClock):
    """A clock on which a minute has gone by."""

    @property
    def seconds(self) -> float:
        return 60.0
