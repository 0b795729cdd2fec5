"""Contacts on what is thinner than places that are drawn by themselves lie apart."""

from pathlib import Path

import numpy as np
import pytest
import trimesh
from holdfast.hands import load_hand
from holdfast.objects.mesh_object import object_from_mesh
from holdfast.pipeline.suggest import searches
from holdfast.pipeline.suggest.screen import PairLimits, screen
from holdfast.pipeline.suggest.surface import opposite_sites, surface_sites

THICK_M = 0.001
JAW = Path(__file__).resolve().parents[2] / "examples" / "jaw" / "gripper.yaml"


@pytest.fixture(scope="module")
def sheet():
    return object_from_mesh(trimesh.creation.box((0.15, 0.1, THICK_M)), mass_kg=0.02, friction=0.5)


def test_opposite_sites_lie_straight_across(sheet):
    sites = [site for site in surface_sites(sheet, 12, 0)[0] if abs(site.normal[2]) > 0.9]
    across = opposite_sites(sheet, sites)
    assert len(across) == len(sites) > 8
    for site, other in zip(sites, across, strict=True):
        assert other.point == pytest.approx(site.point - THICK_M * site.normal, abs=1e-6)
        assert other.normal == pytest.approx(-site.normal, abs=1e-6)


def test_what_leans_is_not_across():
    """Through the face of a tetrahedron a line meets another face that is far from parallel."""
    body = object_from_mesh(
        trimesh.Trimesh(
            0.05 * np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]),
            [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
        ),
        mass_kg=0.1,
        friction=0.5,
    )
    sites = surface_sites(body, 12, 0)[0]
    assert len(sites) == 12 and opposite_sites(body, sites) == []


def test_a_sheet_can_be_pinched_only_where_places_are_looked_for_across(sheet):
    """By jaws that open to less than the sheet is wide."""
    hand = load_hand(JAW)
    assert screen(hand, sheet, surface_sites(sheet, 96, 0)[0], 2, 40, 0, limits=[PairLimits(0.09)]) == []
    assert searches(hand, sheet, 2)[0].can_carry()
