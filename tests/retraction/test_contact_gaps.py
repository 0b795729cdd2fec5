"""Gaps between the bodies of contacts, against MuJoCo's distances and against what was planted."""

from dataclasses import replace

import numpy as np
import pytest
from holdfast.geometry import BezierPatch, Patch
from holdfast.objects import load_task
from holdfast.retraction import compute_clearance_by_mujoco, contact_gaps
from holdfast.solver import solve


def certified(task):
    return solve(task, candidates=3, budget_s=30.0).configurations


def shifted(task, by_m):
    """The task with the patches of its object moved along their normals."""
    contacts = []
    for contact in task.contacts:
        patch = contact.object.region.patch
        net = patch.control_points + by_m * patch.unit_normal(0.5, 0.5)
        region = Patch(BezierPatch(net), off_surface=True)
        contacts.append(replace(contact, object=replace(contact.object, region=region)))
    return replace(task, contacts=tuple(contacts))


@pytest.mark.parametrize("name", ["upholding", "service"])
def test_gaps_agree_with_mujoco(name):
    for configuration in certified(load_task(name)):
        task = configuration.task
        table = compute_clearance_by_mujoco(task, configuration.state)
        parts = [f"object/{part.name}" for part in task.object.parts]
        for contact, gap_m in zip(task.contacts, contact_gaps(configuration), strict=True):
            link = task.hand.links[contact.hand.link].name
            distances = [table[link, part].distance_m for part in parts if table[link, part].intended]
            assert min(abs(d - gap_m) for d in distances) < 2e-6


def test_regions_in_the_air_leave_their_distance_between_the_bodies():
    """Of the scalpel's flat grips each is 3 mm too far out: so are the fingers, though the regions touch."""
    configurations = certified(shifted(load_task("upholding"), 3e-3))
    assert configurations
    for configuration in configurations:
        assert contact_gaps(configuration) == pytest.approx((3e-3, 3e-3), abs=2e-4)
        assert max(abs(point.gap_m) for point in configuration.contact_points) < 1e-9


def test_sunk_regions_leave_an_overlap():
    for configuration in certified(shifted(load_task("upholding"), -1e-3)):
        assert np.all(np.array(contact_gaps(configuration)) < -5e-4)
