"""What the editor shows is where the draft has it, and in sight."""

from unittest.mock import MagicMock

import numpy as np
import pytest
from holdfast.mjcf.hand_folder import open_posture
from holdfast.pipeline.edit import Draft, EditSource
from holdfast.pipeline.edit.scene import EditorScene

# Half of viser's usual field of view.
HALF_VIEW_DEG = 37.5


@pytest.fixture
def server() -> MagicMock:
    """In place of viser's, with one page that is open; keeps what it is told."""
    told = MagicMock()
    told.get_clients.return_value = {0: MagicMock()}
    told.scene.add_frame.side_effect = lambda name, **_: MagicMock(path=name)
    return told


def rotated(wxyz: np.ndarray, p: np.ndarray) -> np.ndarray:
    """Points (n, 3) rotated by a quaternion."""
    w, v = wxyz[0], wxyz[1:]
    return p + 2.0 * np.cross(v, np.cross(v, p) + w * p)


def hand_points(server: MagicMock, scene: EditorScene) -> np.ndarray:
    """Vertices (n, 3) of all links in the object's frame, as a browser would put them together."""
    frames = {frame.path: frame for frame in scene._links}
    points = []
    for call in server.scene.add_mesh_simple.call_args_list:
        name, vertices = call.args[0], call.args[1]
        if name.startswith("/palm/"):
            for frame in (frames[name.rpartition("/")[0]], scene._palm):
                vertices = rotated(np.asarray(frame.wxyz), vertices) + frame.position
            points.append(vertices)
    return np.concatenate(points)


def assert_in_sight(camera: MagicMock, points: np.ndarray) -> None:
    eye, target = np.array(camera.position), np.array(camera.look_at)
    way = (target - eye) / np.linalg.norm(target - eye)
    rays = points - eye
    cosines = rays @ way / np.linalg.norm(rays, axis=1)
    assert np.degrees(np.arccos(cosines)).max() < HALF_VIEW_DEG


def test_the_hand_goes_to_the_object_and_the_cameras_follow(
    of_block: tuple[Draft, EditSource], server: MagicMock
) -> None:
    draft, _ = of_block
    scene = EditorScene(server, draft, open_posture(draft.hand), MagicMock())
    body = np.asarray(draft.object.mesh.vertices)
    cameras = server.initial_camera, server.get_clients()[0].camera
    apart = hand_points(server, scene)
    assert apart[:, 1].min() > body[:, 1].max(), "beside the object"
    for camera in cameras:
        assert_in_sight(camera, np.vstack([apart, body]))
    draft.place(0, np.array([0.015, 0.0, 0.0]))
    configuration = draft.solve(candidates=1, budget_s=60.0)[0]
    scene.place_hand(configuration)
    scene.aim()
    held = hand_points(server, scene)
    for camera in cameras:
        assert_in_sight(camera, np.vstack([held, body]))
    # The fingertip is at the patch.
    patch = draft.pairs[0].object.region.patch.control_points.reshape(-1, 3)
    gap = np.linalg.norm(held[:, None] - patch.mean(axis=0), axis=-1).min()
    assert gap < 0.015 < np.linalg.norm(apart - patch.mean(axis=0), axis=-1).min()


def test_regions_are_drawn_anew_at_their_links(of_block: tuple[Draft, EditSource], server: MagicMock) -> None:
    draft, _ = of_block
    scene = EditorScene(server, draft, open_posture(draft.hand), MagicMock())
    server.scene.add_mesh_simple.side_effect = lambda name, *_, **__: MagicMock(path=name)
    scene.draw_regions()
    first = list(scene._regions)
    link = draft.hand.links[draft.pairs[0].hand.link].name
    assert [handle.path for handle in first] == [f"/palm/{link}/region_0"], "the pair is open"
    draft.place(0, np.array([0.015, 0.0, 0.0]))
    scene.draw_regions()
    assert all(handle.remove.called for handle in first)
    assert [handle.path for handle in scene._regions] == [f"/palm/{link}/region_0", "/region_0"]
