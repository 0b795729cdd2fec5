"""How regions lie on the surfaces of their bodies."""

import numpy as np
import pytest
from holdfast.geometry import (
    BezierPatch,
    Box,
    Cap,
    Capsule,
    ConvexSurface,
    Patch,
    PointRegion,
    Sphere,
    place_region,
)

TABLE = ConvexSurface([Box(np.eye(4), np.array([0.05, 0.05, 0.01]))])


def square(height, half=0.01, turned=False, tilt=0.0):
    net = np.array([[[x, y, height + tilt * x] for y in (-half, half)] for x in (-half, half)])
    return Patch(BezierPatch(net[::-1] if turned else net))


@pytest.mark.parametrize("height", [0.0, 3e-3, -3e-3, 4e-4])
def test_a_patch_above_and_below_a_plane(height):
    placement = place_region(square(0.01 + height), TABLE)
    assert placement.off_m == pytest.approx(abs(height), abs=1e-12)
    assert placement.farthest_m == pytest.approx(abs(height), abs=1e-12)
    assert placement.normal_rad == pytest.approx(0.0, abs=1e-6)
    assert placement.is_off == (abs(height) > 5e-4)


def test_a_patch_that_faces_inwards():
    placement = place_region(square(0.01, turned=True), TABLE)
    assert placement.normal_rad == pytest.approx(np.pi)
    assert placement.is_turned and not placement.is_off
    assert "turned inwards: its normals are 180 deg" in placement.fault(square(0.01), "table")


def test_the_middle_distance_counts_and_the_largest_is_told():
    """Of a tilted patch half lies within the distance that counts."""
    placement = place_region(square(0.01, half=0.012, tilt=0.5), TABLE)
    assert placement.farthest_m == pytest.approx(0.006)
    # Outside, the plane's distance; inside, up to as much: columns at 0, 2, 4 and 6 mm of height, both ways.
    assert placement.off_m == pytest.approx(0.004, abs=1e-9)


def test_corners_may_stand_off_a_curved_link():
    finger = ConvexSurface([Capsule(np.array([-0.03, 0, 0]), np.array([0.03, 0, 0]), 0.008)])
    pad = square(0.008, half=0.004)
    placement = place_region(pad, finger)
    assert placement.farthest_m == pytest.approx(np.hypot(0.008, 0.004) - 0.008)
    assert not placement.is_off and placement.fault(pad, "finger") == ""


def test_a_cap_is_spread_evenly_over_its_area():
    cap = Cap(np.array([0.1, 0.2, 0.3]), 0.01, np.array([0.0, 0.6, 0.8]), np.radians(100.0))
    points, normals = cap.spread()
    assert points == pytest.approx(cap.centre + cap.radius * normals)
    heights = np.sort(normals @ cap.axis)
    assert heights[0] == pytest.approx(np.cos(cap.half_angle_rad)) and heights[-1] == pytest.approx(1.0)
    # By Archimedes, equal steps of height are equal areas.
    assert np.diff(np.unique(heights.round(9))) == pytest.approx((1.0 - np.cos(cap.half_angle_rad)) / 6.0)
    ball = ConvexSurface([Sphere(cap.centre, cap.radius)])
    placement = place_region(cap, ball)
    assert placement.farthest_m < 1e-15 and placement.normal_rad < 1e-6


def test_a_point_and_its_normal():
    region = PointRegion(np.array([0.0, 0.0, 0.013]), np.array([0.0, 0.6, 0.8]))
    placement = place_region(region, TABLE)
    assert placement == pytest.approx((3e-3, 3e-3, np.arccos(0.8)))


def test_what_is_meant_is_no_fault():
    net = square(0.02).patch
    assert place_region(Patch(net), TABLE).fault(Patch(net), "table")
    assert place_region(Patch(net), TABLE).fault(Patch(net, off_surface=True), "table") == ""


def test_a_body_without_shapes_is_said():
    placement = place_region(square(0.0), ConvexSurface([]))
    assert placement.is_off and "no shapes that could touch" in placement.fault(square(0.0), "palm")
