"""Pictures are drawn one by one; what is amiss with drawing is said once the rest of a run is done."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from holdfast.base.machine.cancellation import give_up_if_asked
from holdfast.base.text.console import Console
from holdfast.errors import MissingBackend
from holdfast.mjcf import HoldSettings
from holdfast.objects import load_task
from holdfast.pipeline.records import RunFolder, RunRecord
from holdfast.pipeline.report import Drawing


def drawing(
    folder: Path,
    record: RunRecord,
    monkeypatch: pytest.MonkeyPatch,
    pictures: Iterator[bool],
    stops: list[bool],
) -> Drawing:
    """A drawing whose pictures are those given, and that is to stop where `stops` says so."""
    monkeypatch.setattr("holdfast.pipeline.report.drawing.draw_grasps", lambda *_: pictures)
    found = Drawing(
        load_task("upholding"),
        RunFolder(folder),
        HoldSettings(),
        {},
        console=Console(quiet=True),
        should_stop=lambda: stops[0],
    )
    assert not found.step(), "nothing is drawn before it is said what"
    found.begin(record)
    return found


def test_a_backend_that_can_not_draw_stops_nothing_before_the_end(
    tmp_path: Path, run_record: RunRecord, monkeypatch: pytest.MonkeyPatch
) -> None:
    def pictures() -> Iterator[bool]:
        yield False
        raise MissingBackend("no device")

    with drawing(tmp_path, run_record, monkeypatch, pictures(), [False]) as found:
        assert [found.step() for _ in range(3)] == [True, False, False]
        assert not found.get_ready()
        with pytest.raises(MissingBackend, match="no device"):
            found.finish()


def test_a_run_that_is_to_stop_leaves_the_rest(
    tmp_path: Path, run_record: RunRecord, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn, stops = [], [False]

    def pictures() -> Iterator[bool]:
        for k in range(5):
            give_up_if_asked()
            drawn.append(k)
            yield True

    with drawing(tmp_path, run_record, monkeypatch, pictures(), stops) as found:
        assert found.step() and found.step()
        stops[0] = True
        assert not found.step()
        found.finish()
    assert drawn == [0, 1]


def test_what_is_left_is_drawn_at_the_end(
    tmp_path: Path, run_record: RunRecord, monkeypatch: pytest.MonkeyPatch
) -> None:
    left = iter((True, False, True))
    with drawing(tmp_path, run_record, monkeypatch, (one for one in left), [False]) as found:
        assert found.step()
        found.finish()
    assert list(left) == []
