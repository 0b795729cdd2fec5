"""Solids in convex pieces, cut where something is to be free."""

import numpy as np
from holdfast.geometry import ConvexSurface
from holdfast.geometry.solids import CarvedSolid
from holdfast.geometry.solids.closeness import measure_closeness

# Above the foot of the L and beside its stem, in its hull.
HOLLOW = np.array([[0.03, 0.025, 0.01], [0.022, 0.03, 0.002], [0.05, 0.0205, 0.018]])


def test_a_solid_is_its_hull_until_a_point_is_to_be_free(l_mesh):
    solid = CarvedSolid(l_mesh)
    assert len(solid.hulls) == 1
    assert not solid.free(np.array([[0.07, 0.05, 0.01]]))  # outside of the hull
    assert len(solid.hulls) == 1


def test_points_of_a_hollow_are_freed_and_nothing_of_the_solid_is_lost(l_mesh):
    solid = CarvedSolid(l_mesh)
    assert ConvexSurface(solid.hulls).signed_distances(HOLLOW).max() < 0.0
    assert solid.free(HOLLOW)
    assert ConvexSurface(solid.hulls).signed_distances(HOLLOW).min() > 0.0
    assert len(solid.hulls) == 2  # the plane of the hollow's floor does it
    closeness = measure_closeness(l_mesh, solid.hulls)
    assert closeness.missing_m < 1e-6
    assert closeness.outside_m < 1e-6
    assert not solid.free(HOLLOW)


def test_an_open_surface_is_not_cut(l_mesh):
    l_mesh.update_faces(np.arange(len(l_mesh.faces)) > 3)
    solid = CarvedSolid(l_mesh)
    assert not solid.free(HOLLOW)
    assert solid.hulls == ()
