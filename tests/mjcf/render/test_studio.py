"""Pictures show the grasp, whichever renderer draws them."""

import os
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from math import asin, atan2, degrees

import mujoco
import numpy as np
import pytest
from holdfast.geometry.transforms import axis_rotation, perpendicular, quaternion_from_rotation
from holdfast.mjcf import Grasp, HoldSettings, hold_test
from holdfast.mjcf.render.annotations import with_rings
from holdfast.mjcf.render.camera import Camera, look_at
from holdfast.mjcf.render.studio import Studio
from holdfast.mjcf.render.views import VIEWS, ContactMarks, best_camera, visible_contacts

from ..conftest import solve

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


def is_drawn(picture: np.ndarray) -> np.ndarray:
    """Pixels that are not the light background."""
    return picture.min(axis=-1) < 215


@pytest.mark.usefixtures("renderer")
def test_four_views_show_hand_and_object(firm: Grasp, studio: Studio) -> None:
    views = studio.views(firm.configuration, width=160, height=120)
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
    strip = studio.filmstrip(firm, hold_test(firm, settings=settings), width=80, height=60)
    assert strip.shape == (60, 8 * 80, 3)
    for frame in np.split(strip, 8, axis=1):
        assert is_drawn(frame).mean() > 0.1


def test_both_renderers_see_the_same(firm: Grasp, monkeypatch: pytest.MonkeyPatch) -> None:
    if NAMED not in ("egl", "osmesa", "glfw"):
        pytest.skip(f"no OpenGL backend is named by MUJOCO_GL ({NAMED!r})")
    masks = []
    for name in ("rays", NAMED):
        monkeypatch.setenv("HOLDFAST_RENDERER", name)
        with Studio(firm.configuration.task) as studio:
            views = studio.views(firm.configuration, width=160, height=120)
        masks.append(np.array([is_drawn(view) for view in views]))
    assert (masks[0] & masks[1]).sum() > 0.97 * (masks[0] | masks[1]).sum()


def test_an_object_that_moves_moves_in_the_picture(
    firm: Grasp, studio: Studio, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HOLDFAST_RENDERER", "rays")
    qpos = hold_test(firm, settings=HoldSettings(hold_s=0.1)).squeezed_qpos
    gone = qpos.copy()
    gone[-7:-4] += [0.0, 0.0, 5.0]
    (here, there), _ = studio.states(firm.configuration, [qpos, gone], width=80, height=60)
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
        studio.views(firm.configuration, width=64, height=64)
        again = studio.view(other, "left", width=80, height=60)
    assert np.array_equal(alone, again) and not np.array_equal(first, again)


def test_a_studio_refuses_another_task(studio: Studio, leaning: Grasp) -> None:
    other = replace(leaning.configuration.task, name="other")
    with pytest.raises(ValueError, match="not other"):
        studio.view(replace(leaning.configuration, task=other))


def test_rings_are_whole_where_a_contact_is_in_sight(firm: Grasp, studio: Studio) -> None:
    """Seen along the tangent plane a contact is in sight; through the finger or the object it is not."""
    configuration = firm.configuration
    model, data = studio._pose(configuration)
    for i, point in enumerate(configuration.contact_points):
        angles = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
        across = np.column_stack([np.cos(angles), np.sin(angles)]) @ perpendicular(point.n_object)

        def is_in_sight(way: np.ndarray, i: int = i, target: np.ndarray = point.p_object) -> bool:
            x, y, z = way
            camera = Camera(target, degrees(atan2(y, x)), degrees(asin(z)), 0.5)
            return visible_contacts(model, data, ContactMarks.of(configuration), camera)[i]

        assert not is_in_sight(point.n_object) and not is_in_sight(-point.n_object)
        assert sum(is_in_sight(way) for way in across) > 12


def of_hand(model: mujoco.MjModel, data: mujoco.MjData, camera: Camera) -> tuple[float, float]:
    """Shares of the picture where the hand is seen, and where anything is, ray by ray."""
    seen = []
    for ray in camera.rays(24, 18).reshape(-1, 3):
        geom = np.full(1, -1, dtype=np.int32)
        mujoco.mj_ray(model, data, camera.eye, ray, np.array([1, 1, 1, 0, 0, 0], np.uint8), 1, -1, geom)
        seen.append("" if geom[0] < 0 else model.body(model.geom_bodyid[geom[0]]).name)
    hand = [name not in ("", "object", "stand") for name in seen]
    return float(np.mean(hand)), float(np.mean([name != "" for name in seen]))


@pytest.mark.parametrize("name", ["playing", "tuning"])
def test_the_hand_fills_the_picture_whatever_the_size_of_the_object(name: str) -> None:
    configuration = solve(name)
    with Studio(configuration.task) as studio:
        model, data = studio._pose(configuration)
        points = np.array([point.p_object for point in configuration.contact_points])
        for side in VIEWS.values():
            camera = best_camera(model, data, ContactMarks.of(configuration), [side], 4.0 / 3.0)
            hand, anything = of_hand(model, data, camera)
            assert hand > 0.15 and anything < 0.9
            pixels = camera.project(points, 400, 300)
            assert pixels.min() > 0.0 and np.all(pixels < [400.0, 300.0])
            turned = abs((camera.azimuth_deg - side[0] + 180.0) % 360.0 - 180.0)
            assert turned <= 30.0


def test_the_best_of_the_sides_sees_every_contact(firm: Grasp, studio: Studio) -> None:
    configuration = firm.configuration
    model, data = studio._pose(configuration)
    camera = best_camera(model, data, ContactMarks.of(configuration), list(VIEWS.values()), 1.0)
    assert all(visible_contacts(model, data, ContactMarks.of(configuration), camera))


def test_marks_move_with_the_object(firm: Grasp) -> None:
    configuration = firm.configuration
    state = configuration.state
    turn = axis_rotation(np.array([0.0, 0.6, 0.8]), 0.7)
    pose = np.concatenate([[0.1, 0.2, 0.3], quaternion_from_rotation(turn)])
    here, there = ContactMarks.of(configuration), ContactMarks.of(configuration, pose)
    for p, q, n, m in zip(here.points, there.points, here.normals, there.normals, strict=True):
        local = state.R_palm_object.T @ (p - state.p_palm_object)
        assert turn @ local + pose[:3] == pytest.approx(q, abs=1e-12)
        assert turn @ state.R_palm_object.T @ n == pytest.approx(m, abs=1e-12)


def test_dashed_rings_have_gaps() -> None:
    picture = np.full((160, 160, 3), 255, dtype=np.uint8)
    place = np.array([[80.0, 80.0]])
    whole, dashed = (is_drawn(with_rings(picture, place, [sight])).sum() for sight in (True, False))
    assert 0.3 * whole < dashed < 0.8 * whole


def test_rays_and_pixels_are_inverse() -> None:
    camera = Camera(np.array([0.1, -0.2, 0.3]), 35.0, -20.0, 0.7)
    rays = camera.rays(40, 30)
    for row, column in ((0, 0), (12, 33), (29, 39)):
        point = camera.eye + 1.3 * rays[row, column]
        assert camera.project(point, 40, 30)[0] == pytest.approx([column + 0.5, row + 0.5])
    assert camera.project(camera.target, 40, 30)[0] == pytest.approx([20.0, 15.0])


@pytest.mark.parametrize("view", sorted(VIEWS))
def test_a_camera_shows_all_it_looks_at(view: str) -> None:
    points = np.random.default_rng(0).uniform(-0.3, 0.2, (50, 3))
    pixels = look_at(points, *VIEWS[view], 4.0 / 3.0).project(points, 400, 300)
    assert pixels.min() >= 0.0
    assert pixels[:, 0].max() <= 400.0 and pixels[:, 1].max() <= 300.0
    assert np.ptp(pixels[:, 0]) > 340.0 or np.ptp(pixels[:, 1]) > 255.0, "and does not waste the picture"


def test_a_backend_that_cannot_draw_is_a_plain_error(
    firm: Grasp, studio: Studio, monkeypatch: pytest.MonkeyPatch
) -> None:
    from holdfast.errors import MissingBackend

    class Broken:
        def __init__(self, *arguments: object):
            raise RuntimeError("no device")

    monkeypatch.setattr(mujoco, "Renderer", Broken)
    monkeypatch.setenv("MUJOCO_GL", "egl")
    monkeypatch.setenv("HOLDFAST_RENDERER", "egl")
    with pytest.raises(MissingBackend, match=r"HOLDFAST_RENDERER=rays needs no OpenGL"):
        studio.views(firm.configuration, width=16, height=12)


def test_a_studio_left_open_ends_quietly() -> None:
    """The interpreter takes OpenGL down at exit; a renderer that is still open must be closed before."""
    program = (
        "from holdfast.pipeline.backend import configure; configure()\n"
        "from holdfast.mjcf.render import Studio\n"
        "from holdfast.objects import load_task\n"
        "from holdfast.solver import solve\n"
        "task = load_task('upholding')\n"
        "studio = Studio(task)\n"
        "print(studio.view(solve(task, candidates=1).configurations[0], width=64, height=48).shape)\n"
    )
    done = subprocess.run([sys.executable, "-P", "-c", program], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout.strip(), done.stderr) == (0, "(48, 64, 3)", "")
