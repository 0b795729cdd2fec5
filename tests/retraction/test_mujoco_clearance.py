"""Clearance measured by MuJoCo agrees with that by FCL."""

from dataclasses import replace

import pytest
from holdfast.retraction import Clearance, compare_clearance, compute_clearance, compute_clearance_by_mujoco


def test_mujoco_agrees(configurations):
    for configuration in configurations:
        ours = compute_clearance(configuration.task, configuration.state)
        theirs = compute_clearance_by_mujoco(configuration.task, configuration.state)
        assert ours.is_clear == theirs.is_clear
        for a, b in zip(ours.pairs, theirs.pairs, strict=True):
            assert (a.a, a.b, a.intended) == (b.a, b.b, b.intended)
            assert a.distance_m == pytest.approx(b.distance_m, abs=1e-6, rel=1e-3)


def test_what_differs_is_told_pair_by_pair(task, configurations):
    comparison = compare_clearance(task, configurations[0].state)
    assert comparison.differing == ()
    assert str(comparison) == f"FCL and MuJoCo differ on 0 of {len(comparison.fcl.pairs)} distances"
    first, *others = comparison.fcl.pairs
    off = replace(first, distance_m=1.01 * first.distance_m + 1e-5)
    odd = replace(comparison, fcl=Clearance((off, *others)))
    assert odd.differing == ((off, comparison.mujoco.pairs[0]),)
