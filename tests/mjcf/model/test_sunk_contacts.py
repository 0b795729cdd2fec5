"""Fingers on the true surface of an object whose pieces stand out are not pushed away."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from holdfast.geometry import Hull
from holdfast.geometry.solids import Closeness
from holdfast.mjcf import Grasp, HoldSettings, hold_test
from holdfast.objects import Part
from scipy.spatial import ConvexHull, HalfspaceIntersection

from ..conftest import posed

SWOLLEN_M = 0.001
SHORT = HoldSettings(directions=((1.0, 0.0, 0.0), (0.0, -1.0, 0.0)), hold_s=0.6)


def swollen(hull: Hull) -> Hull:
    """The piece with every face moved out."""
    faces = ConvexHull(hull.vertices).equations.copy()
    faces[:, 3] -= SWOLLEN_M
    return Hull.from_points(HalfspaceIntersection(faces, hull.vertices.mean(axis=0)).intersections)


def on_swollen_pieces(grasp: Grasp, *, stated: bool) -> Grasp:
    """The grasp of the same surface under swollen pieces, and whether their remainder is stated."""
    task = grasp.configuration.task
    closeness = Closeness(SWOLLEN_M, 0.0) if stated else None
    parts: list[Part] = [
        replace(part, pieces=tuple(swollen(piece) for piece in part.pieces), closeness=closeness)
        for part in task.object.parts
    ]
    other = replace(task, object=replace(task.object, parts=tuple(parts)))
    return replace(grasp, configuration=replace(grasp.configuration, task=other))


def test_no_force_and_no_depth_in_the_grasp_itself(firm: Grasp) -> None:
    forces = {}
    for stated in (True, False):
        model, data = posed(on_swollen_pieces(firm, stated=stated).configuration)
        wrench, forces[stated] = np.zeros(6), 0.0
        for i in range(data.ncon):
            mujoco.mj_contactForce(model, data, i, wrench)
            forces[stated] += wrench[0]
    assert forces[True] < 0.1 * forces[False]


def test_it_holds_as_on_pieces_that_lie_on_the_surface(firm: Grasp) -> None:
    exact = hold_test(firm, settings=SHORT)
    stated = hold_test(on_swollen_pieces(firm, stated=True), settings=SHORT)
    unstated = hold_test(on_swollen_pieces(firm, stated=False), settings=SHORT)
    assert exact.held and stated.held
    assert unstated.penetration_m >= SWOLLEN_M
    assert stated.penetration_m == pytest.approx(unstated.penetration_m - SWOLLEN_M, abs=1e-6)
    assert stated.squeeze_slip_m < exact.squeeze_slip_m + 5e-4


def test_friction_of_a_trial_holds_at_these_contacts_too(firm: Grasp) -> None:
    """Without any the object falls."""
    slippery = replace(SHORT, friction=0.01)
    assert not hold_test(on_swollen_pieces(firm, stated=True), settings=slippery).held
