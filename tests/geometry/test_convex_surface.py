"""Distances and directions from convex shapes, against MuJoCo and against trimesh."""

import mujoco
import numpy as np
import pytest
import trimesh
from holdfast.geometry import Box, Capsule, ConvexSurface, Hull, Sphere, mujoco_geom, pose
from holdfast.geometry.transforms import rotation_exp

RNG = np.random.default_rng(4)
SHAPES = {
    "sphere": Sphere(np.array([0.01, -0.02, 0.0]), 0.02),
    "capsule": Capsule(np.array([-0.03, 0.0, 0.01]), np.array([0.02, 0.01, 0.0]), 0.012),
    "box": Box(
        pose(rotation_exp(np.array([0.3, -0.2, 0.5])), np.array([0.0, 0.01, 0.0])),
        np.array([0.01, 0.02, 0.03]),
    ),
    "hull": Hull.from_points(RNG.normal(size=(40, 3)) * [0.02, 0.01, 0.03]),
}


def mujoco_distances(shape, points, radius=1e-3):
    """Signed distances of points outside a shape, from balls around them."""
    kind, fields = mujoco_geom(shape)
    spec = mujoco.MjSpec()
    spec.option.ccd_iterations, spec.option.ccd_tolerance = 200, 1e-10
    if "size" in fields:
        fields["size"] = np.pad(fields["size"], (0, 3 - len(fields["size"])))
    geom = spec.worldbody.add_geom(type=getattr(mujoco.mjtGeom, f"mjGEOM_{kind.upper()}"), **fields)
    if kind == "mesh":
        geom.meshname = "mesh"
        spec.add_mesh(name="mesh", uservert=shape.vertices.ravel(), userface=shape.faces.ravel())
    ball = spec.worldbody.add_body(mocap=True)
    ball.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[radius, 0, 0])
    model = spec.compile()
    data = mujoco.MjData(model)
    found = []
    for point in points:
        data.mocap_pos[0] = point
        mujoco.mj_kinematics(model, data)
        found.append(mujoco.mj_geomDistance(model, data, 0, 1, 1.0, None) + radius)
    return np.array(found)


@pytest.mark.parametrize("name", SHAPES)
def test_distances_outside_agree_with_mujoco(name):
    surface = ConvexSurface([SHAPES[name]])
    points = np.random.default_rng(5).uniform(-0.06, 0.06, (300, 3))
    found = surface.signed_distances(points)
    outside = found > 2e-3
    assert outside.sum() > 100
    assert found[outside] == pytest.approx(mujoco_distances(SHAPES[name], points[outside]), abs=1e-6)


def test_depths_inside_and_normals_of_a_hull_agree_with_trimesh():
    hull = SHAPES["hull"]
    mesh = trimesh.Trimesh(hull.vertices, hull.faces, process=False)
    points = mesh.triangles_center * 0.9
    triangles = np.repeat(mesh.triangles[None], len(points), axis=0).reshape(-1, 3, 3)
    nearest = trimesh.triangles.closest_point(triangles, np.repeat(points, len(mesh.faces), axis=0))
    lengths = np.linalg.norm(nearest - np.repeat(points, len(mesh.faces), axis=0), axis=1)
    lengths = lengths.reshape(len(points), -1)
    surface = ConvexSurface([hull])
    assert -surface.signed_distances(points) == pytest.approx(lengths.min(axis=1), abs=1e-12)
    distance, angle = surface.compare(points, mesh.face_normals[lengths.argmin(axis=1)])
    assert distance == pytest.approx(lengths.min(axis=1), abs=1e-12)
    assert angle == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("name", SHAPES)
def test_the_normal_is_the_gradient_of_the_distance(name):
    surface = ConvexSurface([SHAPES[name]])
    points = np.random.default_rng(5).uniform(-0.06, 0.06, (100, 3))
    points = points[surface.signed_distances(points) > 1e-3]
    h = 1e-7
    steps = [
        surface.signed_distances(points + h * e) - surface.signed_distances(points - h * e) for e in np.eye(3)
    ]
    gradient = np.array(steps).T / (2 * h)
    # At an edge the nearest faces lean against the line to the nearest point.
    _, angle = surface.compare(points, gradient)
    smooth = name in ("sphere", "capsule")
    assert np.all(angle < (1e-4 if smooth else 0.5 * np.pi + 1e-6))
    assert np.all(surface.compare(points, -gradient)[1] > 0.5 * np.pi - 1e-6)


def test_a_seam_between_two_shapes_takes_the_direction_that_agrees():
    ball = Sphere(np.zeros(3), 0.01)
    box = Box(pose(np.eye(3), np.array([-0.02, 0.0, 0.0])), np.array([0.02, 0.01, 0.01]))
    on_both = np.array([[0.0, 0.0, 0.01]])
    for normal in ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0]):
        assert ConvexSurface([box, ball]).compare(on_both, np.array([normal]))[1] < 1e-6


def test_no_shapes_are_infinitely_far():
    assert ConvexSurface([]).signed_distances(np.zeros((2, 3))).tolist() == [np.inf, np.inf]
