"""Descents along the contacts."""

import numpy as np
import pytest
from holdfast.retraction import RetractionSettings
from holdfast.retraction.descent import PenetrationProblem
from holdfast.retraction.pairs import collision_model


def test_depth_never_grows_along_a_descent(colliding, manifold):
    problem = PenetrationProblem(collision_model(manifold.task), manifold, RetractionSettings())
    for configuration in colliding:
        descent = problem.descend(configuration.state)
        worst = [point.worst_m for point in descent.points]
        total = [point.total_m for point in descent.points]
        assert np.all(np.diff(worst) <= 0.0)
        assert np.all(np.diff(total) < 0.0)
        for point in descent.points:
            assert np.abs(manifold.residual(point.state)).max() <= 1e-9
            assert manifold.is_feasible(point.state)


def test_gaps_along_a_direction_never_exceed_the_distance(colliding, manifold):
    problem = PenetrationProblem(collision_model(manifold.task), manifold, RetractionSettings())
    rng = np.random.default_rng(6)
    for configuration in colliding[:5]:
        point = problem.point(configuration.state)
        _, gaps = point.near(0.02)
        n = rng.normal(size=3)
        assert np.all(point.gaps_along(gaps.pairs, n / np.linalg.norm(n)) <= gaps.distance_m + 1e-7)
        for k in range(len(gaps.pairs)):
            along = point.gaps_along(gaps.pairs[[k]], gaps.normals[k])
            assert along[0] == pytest.approx(gaps.distance_m[k], abs=1e-7)
