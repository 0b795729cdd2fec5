"""Solving whole tasks."""

import numpy as np
import pytest
from holdfast.geometry import Cap, Patch, PointRegion
from holdfast.geometry.transforms import rotation_exp
from holdfast.hands import forward_kinematics
from holdfast.objects import Task
from holdfast.solver import (
    ContactManifold,
    SearchOrder,
    SolveResult,
    State,
    Verdict,
    certify_state,
    iterate,
    solve,
)
from holdfast.solver.contacts.distance import distance
from holdfast.solver.contacts.local_search import search_locally
from holdfast.solver.formulate.formulate import formulate

from ..plates import plate_faces


@pytest.fixture(scope="module")
def result(upholding):
    return solve(upholding, candidates=16, seed=0)


def test_upholding_gives_distinct_certified_configurations(result):
    assert result.verdict is Verdict.SOLVED
    assert len(result.configurations) == 16
    assert all(c.certified for c in result.configurations)
    states = [c.state for c in result.configurations]
    nearest = [distance(a, b) for k, a in enumerate(states) for b in states[:k]]
    assert min(nearest) >= 0.099  # refining may move one by a hair
    assert result.spread["smallest"] == pytest.approx(min(nearest))
    assert result.spread["median"] >= result.spread["smallest"]
    assert result.boxes >= 1 and result.undecided == 0


def check_contacts(task: Task, state: State) -> None:
    """Closes every contact by forward kinematics and the regions' own functions alone."""
    T = forward_kinematics(task.hand, task.hand.expand(state.q))
    params = list(state.params)
    for contact in task.contacts:
        link = T[contact.hand.link]
        sides = []
        for region in (contact.hand.region, contact.object.region):
            if isinstance(region, Patch):
                u, v = params.pop(0), params.pop(0)
                assert 0.0 <= u <= 1.0 and 0.0 <= v <= 1.0
                sides.append((region.patch.evaluate(u, v), region.patch.unit_normal(u, v)))
            elif isinstance(region, PointRegion):
                sides.append((region.point, region.normal))
            else:
                sides.append((region.centre, None))
        (p_hand, n_hand), (p_object, n_object) = sides
        p_hand = link[:3, :3] @ p_hand + link[:3, 3]
        p_object = state.R_palm_object @ p_object + state.p_palm_object
        if n_hand is not None:
            n_hand = link[:3, :3] @ n_hand
        if n_object is not None:
            n_object = state.R_palm_object @ n_object
        for own, body in ((contact.hand.region, "hand"), (contact.object.region, "object")):
            if not isinstance(own, Cap):
                continue
            R = link[:3, :3] if body == "hand" else state.R_palm_object
            other_centre, other_normal = (p_object, n_object) if body == "hand" else (p_hand, n_hand)
            centre = p_hand if body == "hand" else p_object
            towards = other_centre - centre
            n = -other_normal if other_normal is not None else towards / np.linalg.norm(towards)
            assert (R @ own.axis) @ n >= np.cos(own.half_angle_rad) - 1e-8
            if body == "hand":
                touch_hand, normal_hand = centre + own.radius * n, n
            else:
                touch_object, normal_object = centre + own.radius * n, n
        if n_hand is not None:
            touch_hand, normal_hand = p_hand, n_hand
        if n_object is not None:
            touch_object, normal_object = p_object, n_object
        assert np.linalg.norm(touch_hand - touch_object) < 1e-9
        assert np.linalg.norm(np.cross(normal_hand, normal_object)) < 1e-9
        assert normal_hand @ normal_object < 0
    assert params == []
    assert np.all((task.limits[:, 0] <= state.q) & (state.q <= task.limits[:, 1]))
    assert state.R_palm_object @ state.R_palm_object.T == pytest.approx(np.eye(3), abs=1e-14)
    assert np.linalg.det(state.R_palm_object) == pytest.approx(1.0)


def test_contacts_close_and_limits_hold(upholding, result):
    for configuration in result.configurations:
        check_contacts(upholding, configuration.state)
        assert configuration.residual_m < 1e-9
        for contact in configuration.contact_points:
            assert contact.gap_m < 1e-9
            assert contact.normal_angle_rad < 1e-9


def test_certificates_hold_their_state(upholding, result):
    for configuration in result.configurations:
        certificate = configuration.certificate
        assert certificate.radius < 1e-9
        assert np.all(certificate.lower <= certificate.upper)
        value = dict(zip(certificate.names, 0.5 * (certificate.lower + certificate.upper), strict=True))
        j = upholding.hand.independent_names.index("thumb_flexion")
        assert value["cos thumb_flexion"] == pytest.approx(np.cos(configuration.state.q[j]), abs=1e-9)
        assert value["sin thumb_flexion"] == pytest.approx(np.sin(configuration.state.q[j]), abs=1e-9)
        for i in range(3):
            assert value[f"object p{i}"] * 0.05 == pytest.approx(
                configuration.state.p_palm_object[i], abs=1e-9
            )
            # The rotation is that of the axes in which the contacts are written.
            first = configuration.state.R_palm_object @ formulate(upholding).axes[0]
            assert value[f"object R{i}0"] == pytest.approx(first[i], abs=1e-9)
        fixed = [k for k, name in enumerate(certificate.names) if name in certificate.fixed]
        # As many inputs are held as the solution set has dimensions: 7 joints and 6 less 2 contacts.
        assert len(fixed) == 11
        assert np.all(certificate.lower[fixed] == certificate.upper[fixed])


def same(a: State, b: State) -> bool:
    return all(
        np.array_equal(getattr(a, name), getattr(b, name))
        for name in ("q", "R_palm_object", "p_palm_object", "params")
    )


def test_the_seed_decides(upholding, result):
    again = solve(upholding, candidates=16, seed=0)
    assert again.boxes == result.boxes
    assert all(
        same(a.state, b.state) for a, b in zip(again.configurations, result.configurations, strict=True)
    )
    other = solve(upholding, candidates=16, seed=1)
    assert not any(
        same(a.state, b.state) for a, b in zip(other.configurations, result.configurations, strict=False)
    )
    # Asking for fewer gives the first of the same.
    fewer = solve(upholding, candidates=5, seed=0)
    assert len(fewer.configurations) == 5
    assert all(
        same(a.state, b.state) for a, b in zip(fewer.configurations, result.configurations, strict=False)
    )


def test_a_plate_too_thick_for_two_fingers_is_proved_infeasible(make_task):
    bottom, top = plate_faces(0.13)
    result = solve(make_task(("index/tip", bottom), ("thumb/tip", top)), candidates=1, budget_s=300)
    assert result.verdict is Verdict.INFEASIBLE
    assert result.configurations == ()
    assert result.open == result.undecided == 0
    assert result.lps > 0
    assert result.spread is None


def test_a_plate_that_fits_is_held(make_task):
    bottom, top = plate_faces(0.01)
    task = make_task(("index/tip", bottom), ("thumb/tip", top))
    result = solve(task, candidates=3)
    assert result.verdict is Verdict.SOLVED
    for configuration in result.configurations:
        check_contacts(task, configuration.state)


def test_a_budget_that_is_spent_decides_nothing(make_task):
    bottom, top = plate_faces(0.11)
    result = solve(make_task(("index/tip", bottom), ("thumb/tip", top)), candidates=1, budget_s=0.0)
    assert result.verdict is Verdict.UNDECIDED
    assert result.boxes == 1
    assert result.open > 0
    assert result.configurations == ()


@pytest.mark.parametrize("region", ["index/tip", "thumb/pad"])
def test_one_contact_is_a_task_as_well(make_task, region):
    task = make_task((region, plate_faces(0.01)[1]))
    result = solve(task, candidates=3)
    assert result.verdict is Verdict.SOLVED
    assert len(result.configurations) == 3
    for configuration in result.configurations:
        check_contacts(task, configuration.state)


def test_contacts_between_other_kinds_of_regions(make_task):
    up, down = np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, -1.0])
    task = make_task(
        ("index/tip", Cap(np.array([0.0, 0.0, 0.01]), 0.008, up, 1.0)),
        ("thumb/pad", PointRegion(np.array([0.0, 0.0, -0.012]), down)),
    )
    result = solve(task, candidates=2)
    assert result.verdict is Verdict.SOLVED
    for configuration in result.configurations:
        check_contacts(task, configuration.state)


def test_branch_and_prune_alone_goes_straight_down_to_a_small_certified_box(upholding):
    first = solve(upholding, candidates=1, pure=True)
    assert first.verdict is Verdict.SOLVED
    assert first.configurations[0].certified
    # Once a solution is proved in a box, each split halves an input around it: no detours.
    assert first.boxes < 150
    assert first.lps < 0.5 * first.boxes


def test_branch_and_prune_alone_refutes_as_well(make_task):
    bottom, top = plate_faces(0.15)
    result = solve(make_task(("index/tip", bottom), ("thumb/tip", top)), pure=True, budget_s=300)
    assert result.verdict is Verdict.INFEASIBLE


def test_progress_is_reported_and_a_stop_is_heard(make_task):
    bottom, top = plate_faces(0.11)
    reports = []
    result = solve(
        make_task(("index/tip", bottom), ("thumb/tip", top)),
        on_progress=reports.append,
        should_stop=lambda: len(reports) == 4,
    )
    assert [r.boxes for r in reports] == [1, 2, 3, 4]
    assert result.verdict is Verdict.UNDECIDED
    assert result.boxes == 4
    assert result.open == reports[-1].open > 0
    assert all(0.0 <= r.decided < 1.0 and r.found == 0 for r in reports)


@pytest.mark.parametrize("order", SearchOrder)
def test_the_order_has_no_influence_on_the_verdict(upholding, make_plate_task, order):
    assert solve(make_plate_task(0.13), order=order).verdict is Verdict.INFEASIBLE
    found = solve(upholding, candidates=3, order=order)
    assert found.verdict is Verdict.SOLVED
    assert all(c.certified for c in found.configurations)


def test_a_search_can_be_looked_at_and_left_at_any_step(upholding, result):
    for search in iterate(upholding, seed=0):
        progress = search.progress
        assert progress.found == len(search.state.solutions)
        assert progress.boxes == search.state.processed
        if progress.found >= 5:
            break
    so_far = SolveResult.of(search)
    assert so_far.verdict is Verdict.SOLVED
    assert so_far.open == progress.open > 0
    assert all(
        same(a.state, b.state) for a, b in zip(so_far.configurations, result.configurations, strict=False)
    )


def test_configurations_that_are_spread_apart_are_chosen_from_four_times_as_many(upholding):
    spread = solve(upholding, candidates=8, spread_apart=True)
    plain = solve(upholding, candidates=32)
    assert len(spread.configurations) == 8
    assert len({id(c) for c in spread.configurations}) == 8
    known = [c.state for c in plain.configurations]
    assert all(any(same(c.state, state) for state in known) for c in spread.configurations)
    assert spread.spread["smallest"] > 1.3 * solve(upholding, candidates=8).spread["smallest"]


# Local search and certification of given states


def random_state(task: Task, rng: np.random.Generator) -> State:
    return State(
        rng.uniform(task.limits[:, 0], task.limits[:, 1]),
        rotation_exp(2 * rng.normal(size=3)),
        rng.normal(size=3) * 0.05 + np.array([0.08, 0.0, 0.15]),
        rng.uniform(size=ContactManifold(task).n_params),
    )


def test_local_search_lands_on_a_feasible_state_or_says_so(upholding):
    manifold = ContactManifold(upholding)
    rng = np.random.default_rng(0)
    landed = 0
    for _ in range(40):
        state = search_locally(manifold, random_state(upholding, rng))
        if state is not None:
            landed += 1
            check_contacts(upholding, state)
    assert landed >= 20


def test_local_search_finds_nothing_where_there_is_nothing(make_task):
    bottom, top = plate_faces(0.15)
    task = make_task(("index/tip", bottom), ("thumb/tip", top))
    rng = np.random.default_rng(1)
    assert all(search_locally(ContactManifold(task), random_state(task, rng)) is None for _ in range(10))


def test_a_state_near_a_solution_is_refined_and_certified(upholding, result):
    manifold = ContactManifold(upholding)
    rng = np.random.default_rng(2)
    for configuration in result.configurations[:5]:
        near = manifold.retract(configuration.state, 1e-6 * rng.normal(size=manifold.n_tangent))
        assert np.abs(manifold.residual(near)).max() > 1e-8
        refined = certify_state(manifold, near)
        assert refined.certified
        assert distance(refined.state, configuration.state) < 1e-4
        check_contacts(upholding, refined.state)


def test_a_state_far_from_any_solution_is_not_certified(upholding, result):
    manifold = ContactManifold(upholding)
    state = result.configurations[0].state
    away = State(state.q, state.R_palm_object, state.p_palm_object + 0.2, state.params)
    configuration = certify_state(manifold, away)
    assert not configuration.certified
    assert configuration.state is away
    assert configuration.residual_m > 0.05


def test_distance_is_a_metric_on_states(upholding):
    rng = np.random.default_rng(3)
    a, b, c = (random_state(upholding, rng) for _ in range(3))
    assert distance(a, a) < 1e-7
    assert distance(a, b) == pytest.approx(distance(b, a))
    assert distance(a, c) <= distance(a, b) + distance(b, c)
    moved = State(a.q, a.R_palm_object, a.p_palm_object + np.array([0.0, 0.03, 0.0]), a.params)
    assert distance(a, moved) == pytest.approx(0.3)
    turned = State(a.q, rotation_exp(np.array([0.0, 0.5, 0.0])) @ a.R_palm_object, a.p_palm_object, a.params)
    assert distance(a, turned) == pytest.approx(0.5)
