import numpy as np
import pytest
from holdfast.geometry import Box, Capsule, Hull, Sphere
from holdfast.geometry.transforms import pose, rotation_exp
from holdfast.retraction.bodies import Bodies, Body, build_piece
from holdfast.retraction.distance import lower_bounds, measure
from holdfast.retraction.pairs import collision_model

R = rotation_exp(np.array([0.4, 1.1, -0.7]))


CUBE = Box(np.eye(4), np.array([0.02, 0.03, 0.04]))


SLAB = Hull.from_points(
    np.array([(x, y, z) for x in (-0.02, 0.02) for y in (-0.03, 0.03) for z in (-0.04, 0.04)])
)


BALL = Sphere(np.array([0.01, 0.0, 0.0]), 0.005)


ROD = Capsule(np.array([0.0, 0.0, -0.02]), np.array([0.0, 0.0, 0.02]), 0.004)


def place(first, second, T_second):
    """Two shapes, the second at T_second, both seen in a frame turned by R."""
    bodies = Bodies([Body("a", 0, (build_piece(first),)), Body("b", 1, (build_piece(second),))])
    T = pose(R, np.array([0.1, -0.2, 0.05]))
    return bodies.place(np.array([T, T @ T_second]))


def gap(first, second, T_second):
    return measure(place(first, second, T_second), np.array([[0, 1]]))


@pytest.mark.parametrize(
    ("first", "second", "move", "distance"),
    [
        (BALL, BALL, (0.012, 0, 0), 0.002),
        (BALL, BALL, (0.004, 0, 0), -0.006),
        (BALL, ROD, (0.01, 0.02, 0.019), 0.011),
        (ROD, ROD, (0.006, 0, 0.03), -0.002),
        (CUBE, BALL, (0.017, 0, 0), 0.002),
        (CUBE, BALL, (0.012, 0, 0), -0.003),
        (CUBE, BALL, (0.0, 0.0, 0.0), -0.015),
        (CUBE, ROD, (0.026, 0, 0), 0.002),
        (CUBE, SLAB, (0.041, 0.02, 0.0), 0.001),
        (CUBE, SLAB, (0.039, 0.02, 0.0), -0.001),
        (SLAB, SLAB, (0.041, 0.0, 0.0), 0.001),
        (SLAB, SLAB, (0.04, 0.01, 0.0), 0.0),
        (SLAB, ROD, (0.021, 0.0, 0.0), -0.003),
        (SLAB, BALL, (0.015, 0.0, 0.0), 0.0),
    ],
)
def test_known_distances(first, second, move, distance):
    found = gap(first, second, pose(np.eye(3), np.array(move)))
    # FCL wants round cores a nanometre thick.
    assert found.distance_m[0] == pytest.approx(distance, abs=2e-9)
    # The points are on the surfaces, apart by the distance along the normal.
    apart = found.p_b[0] - found.p_a[0]
    np.testing.assert_allclose(apart, found.distance_m[0] * found.normals[0], atol=5e-9)
    assert np.linalg.norm(found.normals[0]) == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize(
    "move", [(0.05, 0.01, 0.0), (0.03, 0.02, 0.01), (0.04, 0.0, 0.0), (0.023, 0.033, 0.05)]
)
@pytest.mark.parametrize("second", [CUBE, SLAB, BALL, ROD])
def test_order_does_not_matter(second, move):
    T = pose(rotation_exp(np.array([0.1, 0.2, 0.3])), np.array(move))
    there, back = gap(CUBE, second, T), gap(second, CUBE, np.linalg.inv(T))
    assert there.distance_m[0] == pytest.approx(back.distance_m[0], abs=1e-9)


def test_crossing_segments():
    # Cores that cross have a flat Minkowski difference: the two rods are as deep as both are thick.
    across = pose(rotation_exp(np.array([0.5 * np.pi, 0, 0])), np.zeros(3))
    assert gap(ROD, ROD, across).distance_m[0] == pytest.approx(-0.008, abs=1e-8)


def test_normal_points_to_the_way_out():
    found = gap(CUBE, BALL, pose(np.eye(3), np.array([0.008, 0, 0])))
    np.testing.assert_allclose(found.normals[0], R[:, 0], atol=1e-9)


def test_bounds_never_exceed_distances(task, configurations):
    model = collision_model(task)
    for configuration in configurations[:8]:
        placed = model.place(configuration.state)
        distances = measure(placed, model.piece_pairs).distance_m
        assert np.all(lower_bounds(placed, model.piece_pairs) <= distances + 1e-12)


def test_grazing_contact_that_ends_the_process_in_fcl(task):
    # FCL's own signed distance throws a C++ exception here, which nobody catches.
    R_link = np.array(
        [
            [-0.72664981066551370681, -0.44222261779154548034, 0.52575584540104391973],
            [-0.48668838182585105745, 0.8714872372041894133, 0.060368985298276195417],
            [-0.48488603986453177042, -0.21201214989665470578, -0.84849064617159446486],
        ]
    )
    R_object = np.array(
        [
            [-0.58905557787271811687, -0.3620762987799146515, -0.72243635016441154484],
            [0.013300849719615832206, -0.89822515170627270642, 0.43933434220304179941],
            [-0.80798305277634030475, 0.2491833275002187098, 0.53392045823525469128],
        ]
    )
    T_link = pose(
        R_link, 1e-3 * np.array([51.884248706296517639, 66.668334754420612853, 178.75029417425608358])
    )
    T_object = pose(
        R_object, 1e-3 * np.array([46.957671137992107901, 34.351930499124144092, 159.00351503133388073])
    )
    model = collision_model(task)
    names = [body.name for body in model.bodies.bodies]
    Ts = np.tile(np.eye(4), (len(names), 1, 1))
    link, handle = names.index("index_distal"), names.index("object/handle")
    Ts[link], Ts[handle] = T_link, T_object
    pieces = [int(np.flatnonzero(model.bodies.piece_body == i)[0]) for i in (link, handle)]
    found = measure(model.bodies.place(Ts), np.array([pieces]))
    assert abs(found.distance_m[0]) < 1e-9
