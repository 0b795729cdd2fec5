"""The camera's place shows hand and contacts."""

from math import asin, atan2, degrees

import mujoco
import numpy as np
import pytest
from holdfast.geometry.transforms import axis_rotation, perpendicular, quaternion_from_rotation
from holdfast.mjcf import Grasp
from holdfast.mjcf.render.camera import Camera
from holdfast.mjcf.render.views import VIEWS, ContactMarks, best_camera, visible_contacts

from ..conftest import posed, solve


def of_hand(model: mujoco.MjModel, data: mujoco.MjData, camera: Camera) -> tuple[float, float]:
    """Shares of the picture where the hand is seen, and where anything is, ray by ray."""
    seen = []
    for ray in camera.rays(24, 18).reshape(-1, 3):
        geom = np.full(1, -1, dtype=np.int32)
        mujoco.mj_ray(model, data, camera.eye, ray, np.array([1, 1, 1, 0, 0, 0], np.uint8), 1, -1, geom)
        seen.append("" if geom[0] < 0 else model.body(model.geom_bodyid[geom[0]]).name)
    hand = [name not in ("", "object", "stand") for name in seen]
    return float(np.mean(hand)), float(np.mean([name != "" for name in seen]))


def test_rings_are_whole_where_a_contact_is_in_sight(firm: Grasp) -> None:
    """Seen along the tangent plane a contact is in sight; through the finger or the object it is not."""
    configuration = firm.configuration
    model, data = posed(configuration)
    for i, point in enumerate(configuration.contact_points):
        angles = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
        across = np.column_stack([np.cos(angles), np.sin(angles)]) @ perpendicular(point.n_object)

        def is_in_sight(way: np.ndarray, i: int = i, target: np.ndarray = point.p_object) -> bool:
            x, y, z = way
            camera = Camera(target, degrees(atan2(y, x)), degrees(asin(z)), 0.5)
            return visible_contacts(model, data, ContactMarks.of(configuration), camera)[i]

        assert not is_in_sight(point.n_object) and not is_in_sight(-point.n_object)
        assert sum(is_in_sight(way) for way in across) > 12


@pytest.mark.parametrize("name", ["playing", "tuning"])
def test_the_hand_fills_the_picture_whatever_the_size_of_the_object(name: str) -> None:
    configuration = solve(name)
    model, data = posed(configuration)
    points = np.array([point.p_object for point in configuration.contact_points])
    for side in VIEWS.values():
        camera = best_camera(model, data, ContactMarks.of(configuration), [side], 4.0 / 3.0)
        hand, anything = of_hand(model, data, camera)
        assert hand > 0.15 and anything < 0.9
        pixels = camera.project(points, 400, 300)
        assert pixels.min() > 0.0 and np.all(pixels < [400.0, 300.0])
        turned = abs((camera.azimuth_deg - side[0] + 180.0) % 360.0 - 180.0)
        assert turned <= 30.0


def test_the_best_of_the_sides_sees_every_contact(firm: Grasp) -> None:
    configuration = firm.configuration
    model, data = posed(configuration)
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
