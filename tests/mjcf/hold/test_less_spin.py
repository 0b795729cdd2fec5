"""The test with less spin friction: what is changed, for how long, and what it leads to."""

from dataclasses import replace

import numpy as np
from holdfast.grasping.firm_squeeze import Leaning
from holdfast.mjcf import Grasp, HoldSettings, hold_test, shared_lift, with_less_spin
from holdfast.mjcf.hold.lift import Lift

QUICK = HoldSettings(timestep_s=0.004, noslip_iterations=0, impratio=1000.0)


def test_contacts_resist_spin_less_while_it_lasts_and_slide_as_ever(firm: Grasp) -> None:
    lift = Lift(firm, QUICK)
    lift.squeeze()
    model = lift.simulation.model
    geoms, pairs = model.geom_friction.copy(), model.pair_friction.copy()
    with lift.less_spin(0.25):
        assert np.array_equal(model.geom_friction, geoms * (1.0, 0.25, 1.0))
        assert np.array_equal(model.pair_friction, pairs * (1.0, 1.0, 0.25, 1.0, 1.0))
    assert np.array_equal(model.geom_friction, geoms) and np.array_equal(model.pair_friction, pairs)
    assert (geoms[:, 1] > 0.0).any()


def test_a_pinch_beside_the_centre_of_mass_needs_spin_friction(firm: Grasp) -> None:
    """Nothing else resists gravity's torque about the line between two fingers."""
    task, points = firm.configuration.task, firm.configuration.contact_points
    state = firm.configuration.state
    centre = state.R_palm_object @ task.object.inertia.centre + state.p_palm_object
    first, second = (point.p_object for point in points)
    along = (second - first) / np.linalg.norm(second - first)
    offset = (centre - first) - along * (along @ (centre - first))
    lever = np.linalg.norm(offset)
    worst = np.cross(along, offset) / lever  # gravity's torque about the line is largest along this
    settings = replace(QUICK, directions=(tuple(worst),))
    mass = task.object.inertia.mass
    needed = settings.gravity * mass * lever
    arms, forces = firm.squeeze.spin_arms_m, firm.squeeze.preload[:, 0]
    there = settings.sliding_friction(task.object) * float(arms @ forces)
    for share, held in ((min(1.0, 2.0 * needed / there), True), (0.5 * needed / there, False)):
        tried = replace(settings, firm_spin=share)
        lift = shared_lift(firm, settings=tried)
        assert lift is not None
        result = hold_test(firm, settings=tried, lift=lift)
        assert result.held
        spin = with_less_spin(lift, result, tried)
        assert spin is None if share == 1.0 else spin is not None and spin.held is held
        if spin is not None:
            beyond = spin.slip_m >= tried.slip_limit_m or spin.rotation_rad >= tried.rotation_limit_rad
            assert beyond is not held
            assert ("not held" in str(spin)) is not held
            assert Leaning(spin=spin).is_firm(result) is held


def test_it_leaves_no_trace_in_tests_that_follow(firm: Grasp) -> None:
    lift = shared_lift(firm, settings=QUICK)
    assert lift is not None
    before = hold_test(firm, settings=QUICK, lift=lift)
    with_less_spin(lift, before, replace(QUICK, firm_spin=0.1))
    after = hold_test(firm, settings=QUICK, lift=lift)
    assert [entry.slip_m for entry in after.directions] == [entry.slip_m for entry in before.directions]


def test_all_of_the_friction_is_no_trial(firm: Grasp) -> None:
    settings = replace(QUICK, firm_spin=1.0, directions=((0.0, 0.0, 1.0),))
    lift = shared_lift(firm, settings=settings)
    assert lift is not None
    assert with_less_spin(lift, hold_test(firm, settings=settings, lift=lift), settings) is None
    assert not Leaning().is_known
