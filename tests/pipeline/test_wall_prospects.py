"""Hollow walls and the edges of flat pads: where both lie, and a rim that jaws pinch."""

from pathlib import Path

import numpy as np
import pytest
import trimesh
from holdfast.geometry import Hull
from holdfast.geometry.solids import solid_inertia
from holdfast.hands import Hand, load_hand
from holdfast.objects import ObjectModel, Part, load_object, load_task
from holdfast.pipeline.suggest import searches, task_text
from holdfast.pipeline.suggest.pad_edges import EDGE_ROOM_DEG, is_edge, pad_edges
from holdfast.pipeline.suggest.wall_prospects import WallProspects, has_pad_edges
from holdfast.pipeline.suggest.walls import wall_sites
from holdfast.solver import solve

INNER, OUTER, HEIGHT, SECTORS = 0.036, 0.04, 0.09, 32
ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def gripper() -> Hand:
    return load_hand(ROOT / "examples" / "jaw" / "gripper.yaml")


def tube() -> trimesh.Trimesh:
    return trimesh.creation.annulus(INNER, OUTER, HEIGHT, sections=2 * SECTORS)


def tube_object() -> ObjectModel:
    """A tube with pieces that follow its bore to 0.05 mm, without CoACD."""
    angles = 2.0 * np.pi * np.arange(2 * SECTORS + 1) / (2 * SECTORS)
    rings = [
        np.array([[r * np.cos(a), r * np.sin(a), z] for z in (-0.5 * HEIGHT, 0.5 * HEIGHT)])
        for a in angles
        for r in (INNER, OUTER)
    ]
    pieces = tuple(Hull.from_points(np.vstack(rings[2 * k : 2 * k + 4])) for k in range(2 * SECTORS))
    mesh = tube()
    return ObjectModel("tube", (Part("tube", mesh, pieces, solid_inertia(mesh, 500.0)),), 0.6, {})


def test_edges_of_a_pad_lie_on_both_of_its_sides_and_lean_outwards(gripper: Hand) -> None:
    """Pads of 20 mm on jaws of 80 mm: the sides beside the pad, not the ends of the jaw."""
    pairs = pad_edges(gripper)
    assert [gripper.links[pair.link].name for pair in pairs] == ["left", "right"]
    for pair, facing in zip(pairs, (1.0, -1.0), strict=True):
        assert pair.span_m == pytest.approx(0.02)
        assert np.abs(pair.along) == pytest.approx([0, 0, 1])
        sides = []
        for edge in pair.edges:
            assert is_edge(edge) and edge.name not in gripper.regions
            points, normals = edge.region.spread()
            assert np.ptp(points[:, 2]) >= 0.02
            assert np.abs(points[:, 0]).max() < 1e-4
            assert np.abs(np.abs(points[:, 1]) - 0.01).max() < 2e-4
            lean = np.degrees(np.arccos(normals @ [facing, 0, 0]))
            assert np.all(lean > EDGE_ROOM_DEG)  # so that a pad never lies flat on it
            assert np.all(normals[:, 1] * np.sign(points[:, 1]) > 0.0)
            sides.append(np.sign(points[0, 1]))
        assert sum(sides) == 0.0


def test_only_two_fingers_have_edges_to_pinch_with(gripper: Hand) -> None:
    assert has_pad_edges(gripper)
    assert not has_pad_edges(load_hand("sa"))


def test_places_lie_inside_and_outside_of_a_wall_near_its_ends() -> None:
    found = wall_sites(tube_object(), 0.02, 0.08, 6, 0)
    assert len(found) == 6
    for first, second, outside in found:
        for site in (first, second):
            assert np.hypot(*site.point[:2]) == pytest.approx(INNER, abs=3e-4)
            assert site.normal[:2] @ site.point[:2] < 0.0
        assert np.hypot(*outside.point[:2]) == pytest.approx(OUTER, abs=3e-4)
        assert 0.012 < np.linalg.norm(first.point - second.point) < 0.03
        between = 0.5 * (first.point + second.point)
        assert np.linalg.norm(between - outside.point) < 0.015
        assert abs(between[2]) > 0.5 * HEIGHT - 0.025  # the jaw reaches no deeper into it


@pytest.mark.parametrize("make", [trimesh.creation.box, trimesh.creation.icosphere])
def test_what_bulges_has_no_hollow_walls(make) -> None:
    mesh = make()
    mesh.apply_scale(0.05)
    pieces = (Hull.from_points(mesh.vertices),)
    obj = ObjectModel("lump", (Part("lump", mesh, pieces, solid_inertia(mesh, 500.0)),), 0.6, {})
    assert wall_sites(obj, 0.02, 0.08, 6, 0) == []


def test_only_what_has_a_hollow_wall_is_searched_for_one(gripper: Hand) -> None:
    assert [type(search.prospects) for search in searches(gripper, tube_object())][1:] == [WallProspects]


@pytest.mark.slow
def test_a_rim_is_pinched_and_its_task_can_be_read_again(gripper: Hand, tmp_path: Path) -> None:
    obj = tube_object()
    (search,) = searches(gripper, obj, 3)
    (found,) = search.more(1, budget_s=600.0, tries=24)
    contacts = found.task.contacts
    assert [is_edge(contact.hand) for contact in contacts] == [True, True, False]
    assert contacts[0].hand.link == contacts[1].hand.link != contacts[2].hand.link
    tube().export(tmp_path / "tube.stl")
    (tmp_path / "tube.yaml").write_text("name: tube\nmesh: tube.stl\nmass: 0.05\nfriction: 0.6\n", "utf-8")
    (tmp_path / "hand.yaml").write_bytes((ROOT / "examples" / "jaw" / "gripper.yaml").read_bytes())
    (tmp_path / "rim.yaml").write_text(task_text(found, "rim", "hand.yaml", "tube.yaml"), "utf-8")
    assert load_object(tmp_path / "tube.yaml").inertia.mass == pytest.approx(0.05)
    task = load_task(tmp_path / "rim.yaml")
    assert [contact.align_within_deg for contact in task.contacts][:2] == [EDGE_ROOM_DEG] * 2
    assert all(c.certified for c in solve(task, candidates=2, budget_s=60.0).configurations)
