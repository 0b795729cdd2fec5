"""Clearance that is certified, held against FCL's distances at many places, and planted intrusions."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from holdfast.evidence import CertifiedClear, NotCertified, certify_clear
from holdfast.evidence.travel import bends, lowest_between
from holdfast.evidence.true_bodies import SLABS, TrueScene
from holdfast.evidence.true_links import true_links
from holdfast.grasping import clear
from holdfast.objects import load_task
from holdfast.retraction import Approach, RetractionSettings, collision_model, measure
from holdfast.solver import State, solve
from holdfast.solver.interval import Balls

SETTINGS = RetractionSettings()


@pytest.fixture(scope="module")
def found():
    """Configurations as the solver leaves them, and cleared."""
    return [
        (configuration, clear(configuration))
        for name in ("upholding", "service", "holding")
        for configuration in solve(load_task(name), candidates=3, seed=5).configurations
    ]


@pytest.fixture(scope="module")
def cleared(found):
    return [clearing for _, clearing in found if clearing.is_clear]


def at(state, q):
    return State(q, state.R_palm_object, state.p_palm_object, state.params)


def room(model, state):
    """FCL's distances of all pairs less what they may be."""
    allowed = np.where(model.intended, SETTINGS.contact_depth_m, SETTINGS.depth_m)
    return measure(model.place(state), model.piece_pairs).distance_m + allowed + model.stands_out_m


def along(waypoints, count):
    """Places of the way, evenly spread on each of its steps."""
    for start, end in pairwise(waypoints):
        for share in np.linspace(0.0, 1.0, count):
            yield start + share * (end - start)


def test_clear_grasps_are_proved_and_fcl_agrees_all_along(cleared) -> None:
    on_the_way = 0
    for clearing in cleared:
        configuration, approach = clearing.configuration, clearing.approach
        proved = certify_clear(configuration, approach)
        assert isinstance(proved, CertifiedClear) and proved.approach == approach.reachable
        model = collision_model(configuration.task)
        assert room(model, configuration.state).min() >= -1e-9
        if proved.approach:
            on_the_way += 1
            for q in along(approach.waypoints, 3):
                assert room(model, at(configuration.state, q)).min() >= -1e-9
    assert len(cleared) >= 6 and on_the_way >= 4


def test_what_sinks_in_is_never_proved_clear(found) -> None:
    refused = 0
    for configuration, _ in found:
        deepest = room(collision_model(configuration.task), configuration.state).min()
        proved = certify_clear(configuration)
        if deepest < -1e-9:
            refused += 1
            assert isinstance(proved, NotCertified) and "not certified clear: no plane" in str(proved)
        if proved:
            assert deepest >= -1e-9
    assert refused >= 3


def test_ways_through_something_are_never_proved(cleared) -> None:
    """Pregrasps are replaced by others from which the fingers pass through something."""
    rng = np.random.default_rng(6)
    planted = 0
    for clearing in cleared:
        configuration = clearing.configuration
        model, state = collision_model(configuration.task), configuration.state
        for _ in range(5):
            away = np.clip(state.q + rng.normal(scale=0.2, size=len(state.q)), *configuration.task.limits.T)
            way = np.array([away, state.q])
            if min(room(model, at(state, q)).min() for q in along(way, 5)) > -1e-6:
                continue
            planted += 1
            assert not certify_clear(configuration, Approach(True, 0.015, way, None))
    assert planted >= 15


def test_less_is_allowed_than_a_grasp_takes(cleared) -> None:
    """Each grasp is proved with a margin that it has, and never with one that it lacks."""
    for clearing in cleared:
        configuration = clearing.configuration
        model = collision_model(configuration.task)
        distances = measure(model.place(configuration.state), model.piece_pairs).distance_m
        apart = (distances + model.stands_out_m)[~model.intended].min()
        for share in (0.9, 1.1):
            proved = certify_clear(configuration, retraction=RetractionSettings(margin_m=abs(share * apart)))
            assert bool(proved) == (apart > 0.0 and share < 1.0)


def test_pieces_are_placed_where_every_state_within_the_radii_has_them(cleared) -> None:
    rng = np.random.default_rng(7)
    for clearing in cleared[:4]:
        configuration = clearing.configuration
        model, state, size = collision_model(configuration.task), configuration.state, 1e-4
        scene = TrueScene(
            model, Balls.within(state.R_palm_object, size), Balls.within(state.p_palm_object, size)
        )
        bodies = scene.at(true_links(configuration.task.hand, Balls.within(state.q, size)))
        pairs, normals = model.piece_pairs, rng.normal(size=(len(model.piece_pairs), 3))
        for _ in range(3):
            moved = State(
                state.q + size * rng.uniform(-1.0, 1.0, len(state.q)),
                state.R_palm_object + size * rng.uniform(-1.0, 1.0, (3, 3)),
                state.p_palm_object + size * rng.uniform(-1.0, 1.0, 3),
                state.params,
            )
            placed = model.place(moved)
            assert np.all(np.abs(placed.vertices - bodies.vertices.mid) <= bodies.vertices.rad + 1e-13)
            assert np.all(bodies.gaps(pairs, normals) <= placed.separations(pairs, normals) + 1e-12)
            for k, direction in enumerate(np.vstack([SLABS, -SLABS])):
                exact = placed.separations(pairs, np.tile(direction, (len(pairs), 1)))
                assert np.all(bodies.slab_gaps(pairs)[:, k] <= exact + 1e-12)


def test_ways_bend_no_more_than_is_said(cleared) -> None:
    rng = np.random.default_rng(8)
    for clearing in cleared:
        configuration = clearing.configuration
        model, state = collision_model(configuration.task), configuration.state
        step = rng.normal(scale=0.3, size=len(state.q))
        bend = bends(model, step)
        h = 1e-3
        first, middle, last = (
            model.place(at(state, state.q + share * step)).vertices for share in (0.5 - h, 0.5, 0.5 + h)
        )
        second = np.linalg.norm(first - 2.0 * middle + last, axis=1) / h**2
        most = np.zeros(len(model.bodies.pieces))
        np.maximum.at(most, model.bodies.vertex_piece, second)
        assert np.all(most <= bend + 1e-6)
        assert np.all(bend[most > 1e-3] < 50.0 * most[most > 1e-3])


def test_the_lowest_value_is_below_the_parabola() -> None:
    rng = np.random.default_rng(9)
    start, end = rng.normal(size=(2, 500))
    bend = 10.0 ** rng.uniform(-6.0, 1.0, 500) * rng.integers(0, 2, 500)
    t = np.linspace(0.0, 1.0, 2001)[:, None]
    parabola = start + (end - start) * t - 0.5 * bend * t * (1.0 - t)
    least = lowest_between(start, end, bend)
    assert np.all(least <= parabola.min(axis=0) + 1e-15)
    assert np.all(least >= parabola.min(axis=0) - 1e-6 * bend - 1e-12)


def test_without_a_certificate_there_is_none(cleared) -> None:
    configuration = replace(cleared[0].configuration, certificate=None)
    assert certify_clear(configuration) == NotCertified("clear", "the contacts themselves are not certified")
