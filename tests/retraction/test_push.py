"""Pushes out of the object in one direction."""

import numpy as np
from holdfast.retraction import RetractionSettings
from holdfast.retraction.descent import PenetrationProblem
from holdfast.retraction.pairs import collision_model
from holdfast.retraction.push import push
from holdfast.solver.contacts.distance import distance


def test_push_leads_along_the_contacts_and_no_deeper(colliding, manifold):
    problem = PenetrationProblem(collision_model(manifold.task), manifold, RetractionSettings())
    moved = 0
    for configuration in colliding:
        before = problem.point(configuration.state)
        pushed = push(problem, configuration.state)
        assert np.abs(manifold.residual(pushed)).max() <= 1e-9
        assert manifold.is_feasible(pushed)
        assert problem.point(pushed).total_m <= before.total_m
        moved += distance(configuration.state, pushed) > 0.0
    assert moved >= 0.8 * len(colliding)
