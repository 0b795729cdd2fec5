"""Grasps to look at: what is loaded, how it moves, the page, and MuJoCo's window."""

import sys
from pathlib import Path
from typing import Any

import mujoco
import mujoco.viewer
import numpy as np
import pytest
from holdfast.errors import InputError, MissingBackend
from holdfast.hands import forward_kinematics
from holdfast.pipeline.cli.main import main
from holdfast.pipeline.records import RunRecord
from holdfast.pipeline.view import ViewPage, load_viewables


def test_motions_begin_open_and_pass_through_the_grasp(run_path: Path, run_record: RunRecord) -> None:
    grasps = load_viewables(run_path)
    assert [grasp.record.id for grasp in grasps] == [grasp.id for grasp in run_record.grasps]
    for grasp in grasps:
        record, hand = grasp.record, grasp.task.hand
        closing, *tests = grasp.motions
        q = np.array([record.joints[name] for name in hand.joint_names])
        assert record.approach is not None and record.hold is not None
        first = record.approach.waypoints[0]
        opened = hand.expand(np.array([first[name] for name in hand.independent_names]))
        assert closing.at(0.0)[: len(q)] == pytest.approx(opened, abs=1e-9)
        assert any(state[: len(q)] == pytest.approx(q, abs=1e-9) for state in closing.states)
        assert len(tests) == len(record.hold.directions)
        for test in tests:
            # Every test begins where the squeeze ended, which moved the object by less than its limit.
            assert test.at(0.0) == pytest.approx(closing.at(1.0), abs=1e-4)
            assert np.linalg.norm(test.at(0.0)[-7:-4] - record.object.position) < 5e-3
            assert np.linalg.norm(test.at(0.37)[-4:]) == pytest.approx(1.0)
    assert len({motion.name for motion in grasps[0].motions}) == len(grasps[0].motions)
    (one,) = load_viewables(run_path / "grasps" / f"{run_record.grasps[-1].id}.json")
    assert one.motions[0].states == pytest.approx(grasps[-1].motions[0].states)


def test_what_is_no_run_or_grasp_is_refused(tmp_path: Path) -> None:
    for path in (tmp_path, tmp_path / "none.json"):
        with pytest.raises(InputError):
            load_viewables(path)


@pytest.mark.filterwarnings("default")  # those of viser and its libraries are not ours
def test_the_page_poses_what_is_chosen(run_path: Path) -> None:
    pytest.importorskip("viser", reason="viser is not installed")
    grasps = load_viewables(run_path)
    page = ViewPage(grasps, port=8437)
    try:
        assert page.url.startswith("http://127.0.0.1:")
        for grasp in (grasps[-1], grasps[0]):
            page._grasp.value = grasp.record.id
            page._choose()
            page._place.value = 1.0
            page._pose()
            state = grasp.motions[0].at(1.0)
            T = forward_kinematics(grasp.task.hand, state[:-7])
            for frame, T_link in zip(page._links, T, strict=True):
                assert frame.position == pytest.approx(T_link[:3, 3], abs=1e-6)
            assert page._object.position == pytest.approx(state[-7:-4], abs=1e-6)
        page._boxes["collision pieces"].value = True
        page._show()
        assert all(mesh.visible for mesh in page._nodes["piece"])
        assert not any(mesh.visible for mesh in page._nodes["part"])
    finally:
        page.stop()


def test_without_the_extra_one_line_says_how_to_get_it(
    run_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "viser", None)
    with pytest.raises(MissingBackend, match=r"pip install 'holdfast\[edit\]'"):
        ViewPage(load_viewables(run_path))


@pytest.mark.parametrize("beside", [True, False])
def test_the_window_shows_the_squeeze(
    beside: bool,
    run_path: Path,
    run_record: RunRecord,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Also of a grasp file that has no model beside it."""
    path = run_path / "grasps" / f"{run_record.grasps[0].id}.json"
    if not beside:
        alone = tmp_path / "alone.json"
        alone.write_bytes(path.read_bytes())
        path = alone
    shown: list[Any] = []
    monkeypatch.setattr(mujoco.viewer, "launch", lambda model, data: shown.append((model, data)))
    monkeypatch.setenv("DISPLAY", ":7")
    assert main(["view", str(path), "--quiet"]) == 0
    ((model, data),) = shown
    best = run_record.grasps[0]
    assert best.hold is not None and best.hold.squeeze is not None
    drives = model.actuator_biasprm[:, 0] / model.actuator_gainprm[:, 0] + data.ctrl
    assert sorted(drives) == pytest.approx(sorted(best.hold.squeeze.targets.values()), abs=1e-9)
    assert data.body("object").xpos == pytest.approx(np.array(best.object.position), abs=1e-6)


def test_a_window_needs_a_screen(
    run_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    assert main(["view", str(run_path), "--in", "window"]) == 2
    assert "needs a screen" in capsys.readouterr().err
