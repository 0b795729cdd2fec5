"""Flat pads: normals opposed exactly or within a stated room, found, certified, refuted, and never lost."""

from dataclasses import replace

import numpy as np
import pytest
from holdfast.check_proof import check_proof
from holdfast.hands import forward_kinematics
from holdfast.objects import Task
from holdfast.solver import ContactManifold, State, Verdict, certify_state, search_locally, solve, task_form
from holdfast.solver.contraction.prune import Box, Pruner
from holdfast.solver.enclosure import StraightLineProgram
from holdfast.solver.formulate.formulate import formulate
from holdfast.solver.polynomial.canonical import canonical_form
from holdfast.solver.tasks import pad_misfits

from ..jaws import block, frustum, grip, jaw

FOUND = {
    "box": lambda folder: grip(jaw(folder), block(folder)),
    "can": lambda folder: grip(jaw(folder), frustum(folder)),
    "box, exactly": lambda folder: grip(jaw(folder), block(folder), 0.0),
    "can, exactly": lambda folder: grip(jaw(folder), frustum(folder), 0.0),
    "can, pads askew": lambda folder: grip(jaw(folder, tilt_deg=1.0), frustum(folder)),
    "box, pads as decimals leave them": lambda folder: grip(jaw(folder, tilt_deg=1e-5), block(folder)),
    "box, pads askew": lambda folder: grip(jaw(folder, tilt_deg=1.0), block(folder), 0.501),
    "box, pads askew, with room": lambda folder: grip(jaw(folder, tilt_deg=1.0), block(folder), 0.8),
    "taper": lambda folder: grip(jaw(folder), frustum(folder, half_angle_deg=0.4), 1.0),
    "cone": lambda folder: grip(jaw(folder), frustum(folder, half_angle_deg=10.0), 12.0),
}
NONE = {
    "cone": lambda folder: grip(jaw(folder), frustum(folder, half_angle_deg=10.0)),
    "taper": lambda folder: grip(jaw(folder), frustum(folder, half_angle_deg=0.4)),
    "cone, too little room": lambda folder: grip(jaw(folder), frustum(folder, half_angle_deg=10.0), 5.0),
    "box, pads askew": lambda folder: grip(jaw(folder, tilt_deg=1.0), block(folder)),
    "box, pads askew, too little room": lambda folder: grip(jaw(folder, tilt_deg=1.0), block(folder), 0.499),
    "box too wide": lambda folder: grip(jaw(folder), block(folder, half_width_m=0.0455)),
}
ROOMY = ("box", "can", "box, pads askew, with room", "taper", "cone")


@pytest.fixture(params=FOUND)
def found_task(request, tmp_path) -> Task:
    return FOUND[request.param](tmp_path)


def angles_deg(task: Task, state: State) -> list[float]:
    """Angles between normals by forward kinematics and the patches' own normals alone."""
    T = forward_kinematics(task.hand, task.hand.expand(state.q))
    params = state.params.reshape(-1, 2, 2)
    out = []
    for contact, (on_hand, on_object) in zip(task.contacts, params, strict=True):
        m = T[contact.hand.link][:3, :3] @ contact.hand.region.patch.unit_normal(*on_hand)
        N = state.R_palm_object @ contact.object.region.patch.unit_normal(*on_object)
        out.append(float(np.degrees(np.arctan2(np.linalg.norm(np.cross(m, N)), -m @ N))))
    return out


def test_what_is_within_the_room_is_found_and_certified(found_task):
    result = solve(found_task, candidates=4, budget_s=60.0)
    assert result.verdict is Verdict.SOLVED
    assert len(result.configurations) == 4
    for configuration in result.configurations:
        assert configuration.certified
        assert configuration.residual_m < 1e-12
        assert max(point.gap_m for point in configuration.contact_points) < 1e-12
        proved = np.degrees(configuration.certificate.opposed_within_rad)
        rooms = np.degrees([c.align_within_rad for c in found_task.contacts])
        assert np.all(proved <= rooms)
        # The state lies within the certificate's radius, not at the true solution itself.
        assert np.all(np.array(angles_deg(found_task, configuration.state)) <= proved + 1e-9)


@pytest.mark.parametrize("name", NONE)
def test_what_is_not_is_refuted_and_the_proof_accepted(name, tmp_path):
    task = NONE[name](tmp_path)
    log = tmp_path / "proof"
    assert solve(task, candidates=1, budget_s=60.0, proof=log).verdict is Verdict.INFEASIBLE
    assert check_proof(log, task_form(task)).accepted


def test_a_proof_for_one_room_is_none_for_another(tmp_path):
    narrow, wide = (grip(jaw(tmp_path, tilt_deg=1.0), block(tmp_path), room) for room in (0.499, 0.501))
    solve(narrow, candidates=1, proof=tmp_path / "proof")
    assert check_proof(tmp_path / "proof", task_form(narrow)).accepted
    assert not check_proof(tmp_path / "proof", task_form(wide)).accepted


def test_pads_on_a_can_are_opposed_exactly_and_askew_ones_are_not(tmp_path):
    can = solve(grip(jaw(tmp_path), frustum(tmp_path)), candidates=2)
    assert all(c.certificate.opposed_within_rad == (0.0, 0.0) for c in can)
    askew = solve(grip(jaw(tmp_path, tilt_deg=1.0), block(tmp_path), 0.6), candidates=2)
    for configuration in askew:
        off = np.degrees(configuration.certificate.opposed_within_rad)
        assert 1.0 - 1e-9 <= off.sum() <= 1.2


def test_a_state_outside_its_room_gets_no_certificate(tmp_path):
    task = grip(jaw(tmp_path, tilt_deg=1.0), block(tmp_path), 0.8)
    found = solve(task, candidates=1).configurations[0]
    assert certify_state(ContactManifold(task), found.state).certified
    narrow = replace(task, contacts=tuple(replace(c, align_within_deg=0.45) for c in task.contacts))
    assert not certify_state(ContactManifold(narrow), found.state).certified


def at_random(task: Task, count: int, rng: np.random.Generator) -> list[State]:
    """States in contact whose normals lie somewhere within their room."""
    manifold, formulation = ContactManifold(task), formulate(task)
    system, out = formulation.system, []
    for _ in range(40 * count):
        x = rng.uniform(system.lower, system.upper)
        landed = search_locally(manifold, formulation.state_from_inputs(x, np.zeros(manifold.n_q)))
        if landed is None:
            continue
        # Turned a little, for searches oppose normals as well as they can, and leave half the room.
        room = min(c.align_within_rad for c in task.contacts)
        step = np.zeros(manifold.n_tangent)
        step[manifold.n_q + 3 : manifold.n_q + 6] = rng.uniform(-0.3, 0.3, 3) * room
        moved = manifold.project(manifold.retract(landed, step), tolerance_m=1e-15, max_steps=40)
        if moved is not None and manifold.is_feasible(moved, 0.0) and manifold.error_m(moved) < 1e-14:
            out.append(moved)
        if len(out) == count:
            return out
    raise AssertionError("too few states in contact")


@pytest.mark.parametrize("name", ROOMY)
def test_boxes_around_a_solution_keep_it(name, tmp_path):
    task, rng = FOUND[name](tmp_path), np.random.default_rng(5)
    formulation = formulate(task)
    system, form = formulation.system, canonical_form(formulation.system)
    program, pruner = StraightLineProgram(system), Pruner(form, system.inputs)
    for state in at_random(task, 4, rng):
        x = program.complete(formulation.inputs_from_state(state))
        assert np.all((x >= system.lower - 1e-12) & (x <= system.upper + 1e-12))
        for width in (1.0, 0.1, 0.01):
            root, n = pruner.root, system.size
            lower, upper = root.lower.copy(), root.upper.copy()
            ends = rng.uniform(0.0, width, (2, n))
            lower[:n], upper[:n] = np.maximum(lower[:n], x - ends[0]), np.minimum(upper[:n], x + ends[1])
            pruned = pruner.prune(Box(lower, upper), tightened=4)
            assert pruned is not None
            assert np.all((pruned.lower[:n] <= x + 1e-9) & (pruned.upper[:n] >= x - 1e-9))


def test_slopes_of_the_room_agree_with_differences(tmp_path):
    task = FOUND["cone"](tmp_path)
    manifold, rng = ContactManifold(task), np.random.default_rng(2)
    for state in at_random(task, 3, rng):
        _, G = manifold.inequalities(state)
        step, h = rng.normal(size=manifold.n_tangent) * 1e-3, 1e-4
        ahead, behind = (manifold.inequalities(manifold.retract(state, s * h * step))[0] for s in (1, -1))
        assert G @ step == pytest.approx((ahead - behind) / (2 * h), abs=1e-8)


def test_pads_that_no_posture_lays_flat_are_named_with_the_room_they_need(tmp_path):
    (misfit,) = pad_misfits(grip(jaw(tmp_path, tilt_deg=1.0), block(tmp_path)))
    assert (misfit.hand_deg, misfit.object_deg) == pytest.approx((179.0, 180.0))
    assert 0.5 < misfit.room_deg < 0.52
    assert f"align_within_deg: {misfit.room_deg:.4g}" in str(misfit)
    assert solve(grip(jaw(tmp_path, tilt_deg=1.0), block(tmp_path), misfit.room_deg), candidates=1)
    assert pad_misfits(grip(jaw(tmp_path), block(tmp_path))) == ()
    assert pad_misfits(grip(jaw(tmp_path, tilt_deg=1.0), block(tmp_path), misfit.room_deg)) == ()
    assert pad_misfits(grip(jaw(tmp_path, tilt_deg=1.0), frustum(tmp_path))) == ()
