"""Pictures show the grasp, whichever renderer draws them."""

import os
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace

import mujoco
import numpy as np
import pytest
from holdfast.mjcf import Grasp, HoldSettings, hold_test
from holdfast.mjcf.render.camera import Camera
from holdfast.mjcf.render.renderer import _Canvas
from holdfast.mjcf.render.studio import Studio
from holdfast.mjcf.render.views import VIEWS

from ..conftest import is_drawn

NAMED = os.environ.get("MUJOCO_GL", "")


@pytest.fixture(params=["rays", "opengl"])
def renderer(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    if request.param == "rays":
        monkeypatch.setenv("HOLDFAST_RENDERER", "rays")
    elif NAMED not in ("egl", "osmesa", "glfw"):
        pytest.skip(f"no OpenGL backend is named by MUJOCO_GL ({NAMED!r})")
    else:
        monkeypatch.setenv("HOLDFAST_RENDERER", NAMED)
    return request.param


@pytest.fixture
def studio(firm: Grasp) -> Iterator[Studio]:
    with Studio(firm.configuration.task) as open_studio:
        yield open_studio


@pytest.mark.usefixtures("renderer")
def test_four_views_show_hand_and_object(firm: Grasp, studio: Studio) -> None:
    views = [studio.view(firm.configuration, view, width=160, height=120) for view in VIEWS]
    assert len(views) == len(VIEWS) == 4
    for view in views:
        assert view.shape == (120, 160, 3) and view.dtype == np.uint8
        assert 0.05 < is_drawn(view).mean() < 0.7
        blue = (view[..., 2].astype(int) - view[..., 0]) > 40
        assert blue.sum() > 20, "the scalpel's handle is in sight"
        assert not is_drawn(view)[[0, -1]].any() and not is_drawn(view)[:, [0, -1]].any(), (
            "all is in the picture"
        )
    assert len({view.tobytes() for view in views}) == 4


@pytest.mark.usefixtures("renderer")
def test_a_filmstrip_has_a_frame_for_each_state(firm: Grasp, studio: Studio) -> None:
    settings = HoldSettings(hold_s=0.1)
    frames = list(studio.filmstrip(firm, hold_test(firm, settings=settings), width=80, height=60))
    assert len(frames) == 8
    for frame in frames:
        assert frame.shape == (60, 80, 3)
        assert is_drawn(frame).mean() > 0.1


def test_both_renderers_see_the_same(firm: Grasp, monkeypatch: pytest.MonkeyPatch) -> None:
    if NAMED not in ("egl", "osmesa", "glfw"):
        pytest.skip(f"no OpenGL backend is named by MUJOCO_GL ({NAMED!r})")
    masks = []
    for name in ("rays", NAMED):
        monkeypatch.setenv("HOLDFAST_RENDERER", name)
        with Studio(firm.configuration.task) as studio:
            views = [studio.view(firm.configuration, view, width=160, height=120) for view in VIEWS]
        masks.append(np.array([is_drawn(view) for view in views]))
    assert (masks[0] & masks[1]).sum() > 0.97 * (masks[0] | masks[1]).sum()


def test_one_pass_tells_what_there_is_of_each_pixel(
    firm: Grasp, renderer: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What OpenGL keeps beside the colours is what a second picture, all in white, would show."""
    if renderer == "rays":
        pytest.skip("rays count what they hit")
    kept: list[object] = []
    asked = _Canvas.opacity
    monkeypatch.setattr(_Canvas, "opacity", lambda canvas: kept.append(asked(canvas)) or kept[-1])
    pictures = []
    for _ in range(2):
        with Studio(firm.configuration.task, transparent=True) as studio:
            pictures.append(studio.view(firm.configuration, width=80, height=60))
        monkeypatch.setattr(_Canvas, "opacity", lambda _: None)
    assert len(kept) == 1 and kept[0] is not None
    assert np.array_equal(*pictures) and 0 < (pictures[0][..., 3] == 255).mean() < 1


def test_an_object_that_moves_moves_in_the_picture(
    firm: Grasp, studio: Studio, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HOLDFAST_RENDERER", "rays")
    qpos = hold_test(firm, settings=HoldSettings(hold_s=0.1)).squeezed_qpos
    gone = qpos.copy()
    gone[-7:-4] += [0.0, 0.0, 5.0]
    camera = Camera(np.zeros(3), *VIEWS["front"], distance=0.9)
    here, there = (
        studio.state(firm.configuration, place, camera, width=80, height=60) for place in (qpos, gone)
    )
    assert is_drawn(here).sum() > is_drawn(there).sum() + 20


@pytest.mark.usefixtures("renderer")
def test_a_studio_draws_each_configuration_as_if_it_were_the_only_one(firm: Grasp, leaning: Grasp) -> None:
    """One model serves all: nothing of an earlier picture, of whatever size, shows in a later one."""
    task = firm.configuration.task
    other = replace(leaning.configuration, task=task)
    with Studio(task) as studio:
        alone = studio.view(other, "left", width=80, height=60)
    with Studio(task) as studio:
        first = studio.view(firm.configuration, "left", width=80, height=60)
        studio.view(firm.configuration, "right", width=64, height=64)
        again = studio.view(other, "left", width=80, height=60)
    assert np.array_equal(alone, again) and not np.array_equal(first, again)


def test_a_studio_refuses_another_task(studio: Studio, leaning: Grasp) -> None:
    other = replace(leaning.configuration.task, name="other")
    with pytest.raises(ValueError, match="not other"):
        studio.view(replace(leaning.configuration, task=other))


def test_a_backend_that_cannot_draw_is_a_plain_error(
    firm: Grasp, studio: Studio, monkeypatch: pytest.MonkeyPatch
) -> None:
    from holdfast.errors import MissingBackend

    if NAMED not in ("egl", "osmesa"):
        pytest.skip(f"no OpenGL backend is named by MUJOCO_GL ({NAMED!r})")

    class Broken:
        def __init__(self, *arguments: object):
            raise RuntimeError("no device")

    monkeypatch.setattr(mujoco, "MjrContext", Broken)
    monkeypatch.setenv("MUJOCO_GL", "egl")
    monkeypatch.setenv("HOLDFAST_RENDERER", "egl")
    with pytest.raises(MissingBackend, match=r"HOLDFAST_RENDERER=rays needs no OpenGL"):
        studio.view(firm.configuration, width=16, height=12)


def test_a_studio_left_open_ends_quietly() -> None:
    """The interpreter takes OpenGL down at exit; a renderer that is still open must be closed before."""
    program = (
        "from holdfast.base.machine.backend import configure; configure()\n"
        "from holdfast.mjcf.render import Studio\n"
        "from holdfast.objects import load_task\n"
        "from holdfast.solver import solve\n"
        "task = load_task('upholding')\n"
        "studio = Studio(task)\n"
        "print(studio.view(solve(task, candidates=1).configurations[0], width=64, height=48).shape)\n"
    )
    done = subprocess.run([sys.executable, "-P", "-c", program], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout.strip(), done.stderr) == (0, "(48, 64, 3)", "")
