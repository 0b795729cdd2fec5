"""How far pieces stand out at a region: known answers on a block with a step, capped by what is stated."""

from dataclasses import replace

import manifold3d
import numpy as np
import pytest
import trimesh
from holdfast.geometry import BezierPatch, Cap, Hull, Patch, PointRegion, Region
from holdfast.geometry.solids import Closeness, convex_pieces, solid_inertia
from holdfast.geometry.solids.closeness import measure_closeness
from holdfast.geometry.solids.manifold import from_manifold
from holdfast.objects import Part, standing_out

STEP_M = 0.0015


@pytest.fixture(scope="module")
def part() -> Part:
    """A block whose top is a step lower for x > 0, under one piece that knows of no step."""
    outline = [
        (-0.03, 0.0),
        (0.03, 0.0),
        (0.03, 0.02 - STEP_M),
        (0.0, 0.02 - STEP_M),
        (0.0, 0.02),
        (-0.03, 0.02),
    ]
    mesh = from_manifold(manifold3d.CrossSection([outline]).extrude(0.04))
    mesh.apply_translation((0.0, 0.0, -0.02))
    pieces = (Hull.from_points(mesh.bounding_box.vertices),)
    closeness = measure_closeness(mesh, pieces)
    return Part("block", mesh, pieces, solid_inertia(mesh, 1000.0), closeness=closeness)


def top(x: float, y: float, *, half_m: float = 0.003) -> Patch:
    """A square on the top, outward normal y."""
    net = [[(x + s * half_m, y, -t * half_m) for t in (-1, 1)] for s in (-1, 1)]
    return Patch(BezierPatch(np.array(net)))


LOW = 0.02 - STEP_M


@pytest.mark.parametrize(
    ("region", "expected_m"),
    [
        (top(0.015, LOW), STEP_M),
        (top(-0.015, 0.02), 0.0),
        (top(0.0, LOW, half_m=0.005), 0.0),
        (top(0.015, LOW + 0.0004), STEP_M),
        (PointRegion(np.array([0.02, LOW, 0.0]), np.array([0.0, 1.0, 0.0])), STEP_M),
        (PointRegion(np.array([-0.02, 0.0, 0.0]), np.array([0.0, -1.0, 0.0])), 0.0),
        (Cap(np.array([0.015, LOW - 0.01, 0.0]), 0.01, np.array([0.0, 1.0, 0.0]), 0.02), STEP_M),
    ],
    ids=["low", "high", "across the step", "above the surface", "point", "under side", "cap"],
)
def test_pieces_stand_out_where_they_do_alone(part: Part, region: Region, expected_m: float) -> None:
    assert standing_out(part, region) == pytest.approx(expected_m, abs=1e-6)


def test_no_more_than_is_stated_and_nothing_unmeasured(part: Part) -> None:
    region = top(0.015, LOW)
    assert standing_out(replace(part, closeness=Closeness(0.0004, 0.0)), region) == 0.0004
    assert standing_out(replace(part, closeness=None), region) == 0.0
    assert standing_out(part, replace(region, off_surface=True)) == 0.0


def test_no_allowance_where_pieces_of_a_mesh_lie_on_it() -> None:
    mesh = trimesh.creation.box((0.04, 0.04, 0.04))
    made = convex_pieces(mesh)
    cube = Part("cube", mesh, made.pieces, solid_inertia(mesh, 1000.0), closeness=made.closeness)
    assert standing_out(cube, top(0.0, 0.02)) == 0.0
