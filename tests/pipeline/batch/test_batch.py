"""Batches end the same however they are run, killed and gone on with, and name what went wrong."""

import json
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import Future
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from holdfast.errors import HoldfastError, InputError
from holdfast.pipeline.batch import BatchFolder, Item, Outcome, items_of, run_batch
from holdfast.pipeline.batch.work import BatchSetup, BatchWorker
from holdfast.pipeline.database import checked_rows, find_runs
from holdfast.pipeline.run import RunSettings
from holdfast.workers import TimeOver

from ..browser import new_page, open_browser
from ..conftest import environment_for_subprocess

# The module, whose function has taken its name in the room.
BATCH = sys.modules["holdfast.pipeline.batch.run_batch"]
SETTINGS = RunSettings(candidates=1, choice=1, wanted=0, quick=True, budget_s=900.0, hold={})


class Here:
    """A pool in this process, for tests of what a batch does with answers."""

    def __init__(self, setup: BatchSetup, count: int, *, limit_s: float | None = None):
        self.worker = BatchWorker(setup)

    def __enter__(self) -> "Here":
        return self

    def __exit__(self, *_: object) -> None: ...

    def submit(self, item: Item) -> "Future[Outcome]":
        future: Future[Outcome] = Future()
        try:
            future.set_result(self.work(item))
        except (HoldfastError, TimeOver) as error:
            future.set_exception(error)
        return future

    def work(self, item: Item) -> Outcome:
        return self.worker.work(item)


@pytest.fixture
def here(monkeypatch: pytest.MonkeyPatch) -> None:
    """Batches of this test run in this process."""
    monkeypatch.setattr(BATCH, "open_pool", Here)


def timeless(data: Any) -> Any:
    """The data without times, and without when and with how many workers it was made."""
    if isinstance(data, dict):
        return {
            name: timeless(value) for name, value in data.items() if "seconds" not in name and name != "made"
        }
    return [timeless(value) for value in data] if isinstance(data, list) else data


def result_of(folder: Path) -> dict[str, Any]:
    """All JSON of a batch but times, by path, and the names of what else lies there."""
    files = sorted(path for path in folder.rglob("*") if path.is_file() and "damaged" not in path.parts)
    here = str(folder.parent)
    return {
        str(path.relative_to(folder)): timeless(json.loads(path.read_text("utf-8").replace(here, "")))
        if path.suffix == ".json"
        else None
        for path in files
    }


@pytest.fixture(scope="session")
def batch_path(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A finished batch of two tasks, one that is none, and a file that is none; not to be changed."""
    folder = tmp_path_factory.mktemp("batch")
    bad = folder / "bad <b>.yaml"
    bad.write_text("name: x\nbogus: 1\n", "utf-8")
    with pytest.MonkeyPatch.context() as patch:
        for name, value in (("HOLDFAST_RENDERER", "rays"), ("MUJOCO_GL", "disable")):
            patch.setenv(name, value)
        patch.setattr(BATCH, "open_pool", Here)
        items = items_of(["upholding", "nonsense", str(bad), "tuning"])
        result = run_batch(items, folder / "out", SETTINGS)
    assert not result.is_whole and result.good >= 1
    yield folder / "out"


@pytest.fixture
def copied(batch_path: Path, tmp_path: Path) -> Path:
    """A copy of that batch."""
    shutil.copytree(batch_path.parent, tmp_path / "copied")
    return tmp_path / "copied" / "out"


def items_in(folder: Path) -> list[Item]:
    return items_of(["upholding", "nonsense", str(folder.parent / "bad <b>.yaml"), "tuning"])


def test_one_failure_stops_no_other(batch_path: Path) -> None:
    outcomes = [BatchFolder(batch_path).outcome(item) for item in items_in(batch_path)]
    assert all(outcome is not None for outcome in outcomes)
    states = [outcome.state for outcome in outcomes if outcome is not None]
    assert states == ["done", "failed", "failed", "done"]
    reasons = [outcome.reason for outcome in outcomes if outcome is not None]
    assert "unknown task 'nonsense'" in reasons[1] and "bogus" in reasons[2]
    assert len(find_runs(batch_path)) == 2


def test_a_file_of_no_kind_says_what_is_allowed(tmp_path: Path, here: None) -> None:
    (tmp_path / "cloud.xyz").write_text("0 0 0\n", "utf-8")
    items = items_of([str(tmp_path / "cloud.xyz")])
    outcome = run_batch(items, tmp_path / "out", SETTINGS).outcomes[items[0].name]
    assert outcome.state == "failed"
    assert f"{tmp_path}/cloud.xyz: is neither a task file (.yaml or .yml) nor a mesh" in outcome.reason


def test_the_table_has_every_grasp(batch_path: Path) -> None:
    pytest.importorskip("pyarrow")
    rows = list(checked_rows(batch_path / "grasps.parquet"))
    assert {(row.head.task, row.grasp.id) for row in rows if not isinstance(row, str)} == {
        ("upholding", "g01"),
        ("tuning", "g01"),
    }
    assert len(rows) == 2


class Links(HTMLParser):
    """What a page names, and its tags."""

    def __init__(self) -> None:
        super().__init__()
        self.targets: list[str] = []
        self.tags: list[str] = []

    def handle_starttag(self, tag: str, attrs: Sequence[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.targets += [value or "" for name, value in attrs if name in ("href", "src")]


def test_the_page_is_escaped_and_stays_here(batch_path: Path) -> None:
    page = (batch_path / "index.html").read_text("utf-8")
    links = Links()
    links.feed(page)
    assert links.tags.count("tr") == 5 and "b" not in links.tags
    assert sorted(links.targets) == ["runs/tuning/report.html", "runs/upholding/report.html"]
    assert all((batch_path / target).is_file() for target in links.targets)
    assert "http:" not in page and "https:" not in page and "bogus" in page


@pytest.mark.slow
def test_the_page_filters_and_fits_a_phone(batch_path: Path) -> None:
    with open_browser() as browser:
        page = new_page(browser, viewport={"width": 390, "height": 800})
        page.goto((batch_path / "index.html").as_uri())
        shown = "Array.from(document.querySelectorAll('tbody tr')).filter(r => r.offsetHeight).length"
        assert page.evaluate(shown) == 4
        page.select_option("#verdict", "failed")
        assert page.evaluate(shown) == 2 and "2 shown" in page.inner_text("#shown")
        page.select_option("#verdict", "")
        page.select_option("#hand", "sa")
        page.fill("#text", "TUNING")
        assert page.evaluate(shown) == 1
        page.fill("#text", "")
        page.select_option("#hand", "")
        assert page.evaluate(shown) == 4
        assert page.evaluate("document.documentElement.scrollWidth") <= 390


@pytest.mark.usefixtures("here")
def test_a_batch_that_is_killed_at_any_moment_ends_as_if_it_had_not_been(
    batch_path: Path, copied: Path
) -> None:
    """What a kill leaves: any outcome, run record or page may be missing, or a part of a file be there."""
    expected = result_of(batch_path)
    for lost in (
        ["outcomes/upholding.json", "index.html", "grasps.parquet"],
        ["outcomes/tuning.json", "runs/tuning"],
        ["outcomes/upholding.json", "runs/upholding/report.html", "runs/upholding/grasps/g01.json"],
    ):
        for path in (copied / name for name in lost):
            if path.is_dir():
                shutil.rmtree(path)
            else:
                path.unlink(missing_ok=True)
        run_batch(items_in(copied), copied, SETTINGS, resume=True)
        assert result_of(copied) == expected


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize("name", ["outcomes/upholding.json", "runs/upholding/run.json"])
def test_damaged_files_are_set_aside_and_made_anew(name: str, batch_path: Path, copied: Path) -> None:
    whole = (copied / name).read_bytes()
    (copied / name).write_bytes(whole[: len(whole) // 2])
    result = run_batch(items_in(copied), copied, SETTINGS, resume=True)
    (words,) = result.damaged
    assert str(copied / name) in words and "set aside as damaged/" in words
    (aside,) = (copied / "damaged").iterdir()
    damaged = aside / "run.json" if aside.is_dir() else aside
    assert damaged.read_bytes() == whole[: len(whole) // 2]
    assert result_of(copied) == result_of(batch_path)


def test_what_is_another_batch_is_refused(copied: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="holds a batch: go on by --resume"):
        run_batch(items_in(copied), copied, SETTINGS)
    other = RunSettings(candidates=2, choice=1, wanted=0, quick=True)
    with pytest.raises(InputError, match=r"settings\.candidates: is 1, but 2 is asked for now"):
        run_batch(items_in(copied), copied, other, resume=True)
    with pytest.raises(InputError, match="are other tasks"):
        run_batch(items_of(["handling"]), copied, SETTINGS, resume=True)
    (tmp_path / "precious").mkdir()
    (tmp_path / "precious" / "letter.txt").write_text("dear", "utf-8")
    with pytest.raises(InputError, match=r"is not a batch folder: it holds 'letter\.txt'"):
        run_batch(items_of(["upholding"]), tmp_path / "precious", SETTINGS)
    (tmp_path / "linked").mkdir()
    (tmp_path / "linked" / "runs").symlink_to(tmp_path / "precious")
    with pytest.raises(InputError, match="is a link"):
        run_batch(items_of(["upholding"]), tmp_path / "linked", SETTINGS)
    assert [path.name for path in (tmp_path / "precious").iterdir()] == ["letter.txt"]


def test_planned_items_are_those_that_were_asked_for(copied: Path) -> None:
    assert BatchFolder(copied).planned_items() == items_in(copied)


def test_two_batches_do_not_share_a_folder(copied: Path) -> None:
    with BatchFolder(copied).writing(), pytest.raises(InputError, match="another batch is writing there"):
        run_batch(items_in(copied), copied, SETTINGS, resume=True)


def test_an_item_that_hangs_or_is_lost_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class Hanging(Here):
        def work(self, item: Item) -> Outcome:
            if item.name == "tuning":
                raise TimeOver(5.0)
            return self.worker._setup.give_up(item)

    monkeypatch.setattr(BATCH, "open_pool", Hanging)
    result = run_batch(items_of(["tuning", "playing"]), tmp_path / "out", SETTINGS)
    assert [outcome.state for outcome in result.outcomes.values()] == ["too long", "lost"]
    assert result.outcomes["tuning"].reason == "did not end within 5 s"
    assert "broke down" in (tmp_path / "out" / "index.html").read_text("utf-8")


@pytest.mark.usefixtures("here")
def test_a_folder_that_cannot_be_written_ends_the_batch_in_a_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As on a full disk: no item after it could do better, and the next call goes on."""
    import resource

    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, hard))
    try:
        with pytest.raises(InputError, match="can't be written: file too large") as caught:
            run_batch(items_of(["tuning"]), tmp_path / "out", SETTINGS)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert "\n" not in str(caught.value) and str(tmp_path / "out") in str(caught.value)
    assert not list(tmp_path.rglob("*.part"))
    result = run_batch(items_of(["tuning"]), tmp_path / "out", SETTINGS, resume=True)
    assert result.is_whole


@pytest.mark.slow
def test_a_killed_command_is_gone_on_with(batch_path: Path, tmp_path: Path) -> None:
    """The command itself, with processes: killed for good at several moments, and resumed."""
    bad = tmp_path / "bad <b>.yaml"
    bad.write_text("name: x\nbogus: 1\n", "utf-8")
    words = [sys.executable, "-P", "-m", "holdfast", "batch", "upholding", "nonsense", str(bad), "tuning"]
    words += ["--candidates", "1", "--wanted", "0", "--quick", "--budget", "900", "--workers", "2"]
    words += ["--quiet", "--out", str(tmp_path / "out")]
    for k, seconds in enumerate((6.0, 9.0, 12.0)):
        resumed = ["--resume"] if k and (tmp_path / "out" / "batch.json").exists() else []
        command = subprocess.Popen([*words, *resumed], env=environment_for_subprocess())
        time.sleep(seconds)
        command.kill()
        command.wait()
    resumed = ["--resume"] if (tmp_path / "out" / "batch.json").exists() else []
    done = subprocess.run([*words, *resumed], env=environment_for_subprocess(), check=False)
    assert done.returncode == 4  # two of the four can't be run
    found = result_of(tmp_path / "out")
    assert {name for name in found if name.startswith("runs/")} >= {"runs/upholding/run.json"}
    assert not list(tmp_path.rglob("*.part"))
    alone = tmp_path / "alone"
    subprocess.run([*words[:-1], str(alone)], env=environment_for_subprocess(), check=False)
    assert found == result_of(alone)
