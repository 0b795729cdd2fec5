"""A camera shows what it is aimed at."""

import numpy as np
import pytest
from holdfast.mjcf.render.camera import Camera, look_at
from holdfast.mjcf.render.views import VIEWS


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
