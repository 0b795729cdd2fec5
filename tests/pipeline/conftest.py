"""A small run of the whole chain that several tests look at."""

import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from holdfast.pipeline.records import RunRecord, read_run
from holdfast.pipeline.report import pictures
from holdfast.pipeline.run import RunSettings, run_task

RAYS = {"HOLDFAST_RENDERER": "rays", "MUJOCO_GL": "disable"}
TONGS = """<mujoco model="tongs"><worldbody><body name="palm">
  <geom type="box" size="0.04 0.02 0.02"/>
  <body name="left" pos="0.03 0 0.03"><joint name="l" type="hinge" axis="0 1 0" range="-1 1"/>
    <geom type="capsule" fromto="0 0 0 0 0 0.06" size="0.008"/></body>
  <body name="right" pos="-0.03 0 0.03"><joint name="r" type="hinge" axis="0 1 0" range="-1 1"/>
    <geom type="capsule" fromto="0 0 0 0 0 0.06" size="0.008"/></body>
</body></worldbody><compiler angle="radian"/></mujoco>"""


@pytest.fixture(autouse=True)
def draws_by_rays(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pictures need no OpenGL, and what `configure` does to the environment is undone."""
    for name, value in RAYS.items():
        monkeypatch.setenv(name, value)


def _draw_small(patch: pytest.MonkeyPatch) -> None:
    # Rays are slow, and how pictures look is tested where they are made.
    patch.setattr(pictures, "_FRAME", (80, 75))
    patch.setattr(pictures, "_VIEW", (160, 120))
    patch.setattr(pictures, "_VIDEO", (40, 36))


@pytest.fixture
def small_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pictures of this test are small."""
    _draw_small(monkeypatch)


@pytest.fixture(scope="session")
def run_path(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A finished run of `upholding` with three candidates; not to be changed."""
    path = tmp_path_factory.mktemp("runs") / "upholding"
    with pytest.MonkeyPatch.context() as patch:
        for name, value in RAYS.items():
            patch.setenv(name, value)
        _draw_small(patch)
        run_task("upholding", path, RunSettings(candidates=3, wanted=1))
    before = {file: file.read_bytes() for file in path.rglob("*") if file.is_file()}
    yield path
    assert before == {file: file.read_bytes() for file in path.rglob("*") if file.is_file()}


@pytest.fixture
def without_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Runs of this test draw nothing."""
    monkeypatch.setattr("holdfast.pipeline.report.drawing.draw_grasps", lambda *_, **__: (one for one in ()))


@pytest.fixture(scope="session")
def run_record(run_path: Path) -> RunRecord:
    """The record of that run."""
    return read_run(run_path / "run.json")


@pytest.fixture(scope="session")
def grasp_path(run_path: Path, run_record: RunRecord) -> Path:
    """The file of its best grasp."""
    return run_path / "grasps" / f"{run_record.grasps[0].id}.json"


def environment_for_subprocess() -> dict[str, str]:
    """The environment with the renderer of the tests."""
    return {**os.environ, **RAYS}
