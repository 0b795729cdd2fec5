"""The GLB of a task: read back by trimesh, it holds what the task's bodies are."""

import io

import numpy as np
import pytest
import trimesh
from holdfast.geometry import shape_mesh
from holdfast.mjcf.scene import SceneNode, task_glb, task_nodes
from holdfast.objects import light_mesh, load_task


@pytest.mark.parametrize("name", ["upholding", "tuning"])
def test_nodes_come_back_where_they_are(name: str) -> None:
    task = load_task(name)
    nodes = list(task_nodes(task))
    assert len({node.name for node in nodes}) == len(nodes)
    scene = trimesh.load(io.BytesIO(task_glb(nodes)), file_type="glb")
    for node in nodes:
        T, geometry = scene.graph[node.name]
        read = scene.geometry[geometry].copy().apply_transform(T)
        assert read.bounds == pytest.approx(np.asarray(node.mesh.bounds), abs=1e-6)
        assert read.area == pytest.approx(node.mesh.area, rel=1e-4)
    # Every shape of every link, every part and every piece is there, and each contact on both sides.
    kinds = [node.kind for node in nodes]
    assert kinds.count("link") == sum(len(link.shapes) for link in task.hand.links)
    assert kinds.count("part") == len(task.object.parts)
    assert kinds.count("piece") == len(task.object.pieces)
    assert kinds.count("skin") == kinds.count("place") == len(task.contacts)
    for node in nodes:
        if node.kind == "link":
            i, k = map(int, node.name.split("_")[1:])
            volume = shape_mesh(task.hand.links[i].shapes[k]).volume
            assert node.mesh.volume == pytest.approx(volume)
    behind = {part.name for part in task.obstacles} if task.carried else set()
    moving = {node.name for node in nodes if node.kind == "part" and node.moves}
    parts = enumerate(task.object.parts)
    assert moving == {f"part_{i}" for i, part in parts if part.name not in behind}


def test_a_light_mesh_stays_near_the_surface() -> None:
    ball = trimesh.creation.icosphere(subdivisions=5, radius=0.05)
    light = light_mesh(ball, 3000)
    assert 500 < len(light.faces) <= 3000
    away = np.abs(np.linalg.norm(light.vertices, axis=1) - 0.05)
    assert away.max() < 0.1 / 20
    assert light.area == pytest.approx(ball.area, rel=0.05)
    assert light.volume == pytest.approx(ball.volume, rel=0.05)
    assert light_mesh(light, 3000) is light


def test_colours_of_corners_are_in_the_file_as_amounts_of_light() -> None:
    box = trimesh.creation.box()
    rgb = np.array([[0, 128, 255]] * 8, np.uint8)
    node = SceneNode("part_0", "part", None, box, (1.0, 1.0, 1.0, 1.0), rgb=rgb)
    scene = trimesh.load(io.BytesIO(task_glb([node])), file_type="glb")
    (read,) = scene.geometry.values()
    # sRGB's 128 is 21.6 % of the light.
    assert np.unique(read.visual.vertex_attributes["color"], axis=0).tolist() == [[0, 55, 255, 255]]
