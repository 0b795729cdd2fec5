"""The built-in teapot against the published facts, and its surface by independent means."""

import json
from pathlib import Path

import holdfast.objects
import numpy as np
import pytest
import trimesh
import yaml
from holdfast.geometry import Patch
from holdfast.objects import load_object
from holdfast.objects.generators.newell import teapot_surfaces
from holdfast.objects.generators.teapot import CUTS, teapot_lofts

from .conftest import mass_of
from .surface import distance_to_mesh, facet_below, height_above, is_closed

TEAPOT = load_object("teapot")
POT, HANDLE, SPOUT, LID = TEAPOT.parts
SURFACES = TEAPOT.surfaces
UNIT = 0.0455
FILE = yaml.safe_load((Path(holdfast.objects.__file__).parent / "data" / "teapot.yaml").read_text())

PAPER = [name for name in TEAPOT.regions if name.startswith("paper_")]
CUT = [name for name in TEAPOT.regions if name not in PAPER]


def in_paper_frame(net):
    x, y, z = np.moveaxis(np.array(net), -1, 0)
    return UNIT * np.stack([x, z - 0.15, -y], axis=-1)


def test_all_of_newells_patches_are_there(published_data):
    """Up to the order of their points; the base is flat instead of the bulge of the 28th to 31st."""
    given = json.loads((published_data / "utah_teapot.json").read_text())["patches"]
    own = [patch.control_points for name, patch in SURFACES.items() if not name.startswith("base")]
    assert len(SURFACES) == len(given) == 32
    assert len(own) == 28
    left = [in_paper_frame(p["control_points"]) for p in given if p["part"] != "bottom"]
    for net in own:
        turned = [net, net[::-1], net[:, ::-1], net[::-1, ::-1]]
        turned += [t.transpose(1, 0, 2) for t in turned]
        match = [i for i, other in enumerate(left) if any(np.allclose(t, other, atol=1e-9) for t in turned)]
        assert len(match) == 1
        left.pop(match[0])
    assert left == []


def test_the_base_is_flat_and_joins_the_belly():
    for k in range(4):
        base, belly = SURFACES[f"base_{k}"].control_points, SURFACES[f"belly_{4 + k}"].control_points
        assert np.abs(base[..., 1]).max() == 0
        assert base[:, 0] == pytest.approx(belly[:, -1], abs=1e-12)
        assert base[:, -1] == pytest.approx(np.zeros((4, 3)))


@pytest.mark.parametrize("name", SURFACES)
def test_normals_look_outwards(name):
    """They agree with those of the closed mesh, which knows its outside by its volume."""
    part = {"knob": LID, "lid": LID, "handle": HANDLE, "spout": SPOUT}.get(name.split("_")[0], POT)
    for u, v in [(0.2, 0.3), (0.6, 0.2), (0.8, 0.7)]:
        point, normal = SURFACES[name].evaluate(u, v), SURFACES[name].unit_normal(u, v)
        assert part.mesh.face_normals[facet_below(part.mesh, point)] @ normal > 0.97


def test_neighbouring_patches_meet_with_one_tangent_plane():
    t = np.linspace(0.05, 1, 9)
    for name in ("rim", "belly", "knob", "lid"):
        for k in range(4):
            a, b = SURFACES[f"{name}_{k}"], SURFACES[f"{name}_{(k + 1) % 4}"]
            assert a.evaluate(np.ones(9), t) == pytest.approx(b.evaluate(np.zeros(9), t), abs=1e-12)
            cosine = np.sum(a.unit_normal(np.ones(9), t) * b.unit_normal(np.zeros(9), t), axis=1)
            assert cosine[:-1].min() > 1 - 1e-9
    for k in range(2):
        upper, lower = SURFACES[f"handle_{k}"], SURFACES[f"handle_{k + 2}"]
        assert upper.evaluate(t, np.ones(9)) == pytest.approx(lower.evaluate(t, np.zeros(9)), abs=1e-12)


def test_dimensions_are_as_published():
    assert 1e3 * TEAPOT.mesh.extents == pytest.approx([292, 136.5, 182], abs=1)
    assert 1e3 * TEAPOT.mesh.bounds[0, 1] == pytest.approx(0, abs=1e-9)
    assert 1e3 * TEAPOT.mesh.bounds[1, 1] == pytest.approx(136.5, abs=1e-6)


@pytest.mark.parametrize("part", TEAPOT.parts, ids=lambda part: part.name)
def test_parts_are_closed_and_covered_by_their_pieces(part):
    assert is_closed(part.mesh)
    # 0.7 mm: a sag of half a chord where sections are far apart.
    assert height_above(part.pieces, part.mesh.vertices).max() < 1e-9
    assert height_above(part.pieces, part.mesh.triangles_center[::5]).max() < 7e-4
    assert -1e-3 < part.inflation < 0.05


def test_pieces_are_few():
    assert len(TEAPOT.pieces) <= 40


@pytest.mark.parametrize("name", CUT)
def test_regions_lie_on_mesh_and_pieces(name):
    points, normals = TEAPOT.regions[name].sample(30, np.random.default_rng(0))
    assert distance_to_mesh(TEAPOT.mesh, points).max() < 1e-4
    height = height_above(TEAPOT.pieces, points)
    assert height.min() > -1e-4
    assert height.max() < 1e-4
    # Outwards: a step along the normal leads away from every piece.
    assert height_above(TEAPOT.pieces, points + 2e-3 * normals).min() > 1.5e-3


@pytest.mark.parametrize("name", [name for name in CUT if name != "bottom_palm"])
def test_regions_are_bicubic_pieces_of_newells_patches(name):
    """At any parameters they are the whole patch at the parameters inside the cut."""
    region = TEAPOT.regions[name]
    cut = FILE["regions"][name]
    assert isinstance(region, Patch)
    assert region.patch.degree == (3, 3)
    s, t = np.random.default_rng(1).uniform(size=(2, 20))
    (u0, u1), (v0, v1) = cut["u"], cut["v"]
    expected = SURFACES[cut["surface"]].evaluate(u0 + s * (u1 - u0), v0 + t * (v1 - v0))
    assert region.patch.evaluate(s, t) == pytest.approx(expected, abs=1e-14)


@pytest.mark.parametrize("name", PAPER)
def test_published_patches_are_the_authors_own_and_lie_on_the_surface(name, published_tasks):
    _, task, link = name.split("_")
    (entry,) = (
        contact["object_patch_mm"]["control_points"]
        for t in published_tasks
        if t["task"].startswith(task)
        for contact in t["contacts"]
        if contact["hand_link"].startswith(link)
    )
    net = TEAPOT.regions[name].patch.control_points
    assert 1e3 * net == pytest.approx(np.array(entry), abs=1e-9)
    assert distance_to_mesh(TEAPOT.mesh, net.reshape(-1, 3)).max() < 7e-4


def test_the_lid_is_free_of_the_pot():
    """It stands 0.2 mm above its seat and is beside the rim by more."""
    edge = LID.mesh.vertices[LID.mesh.vertices[:, 1] < 0.104]
    gap = height_above(POT.pieces, edge).min()
    assert 1.5e-4 < gap < 2.5e-4
    # Lifted by any height the edge stays clear of the rim.
    for height in np.linspace(0.001, 0.01, 10):
        assert height_above(POT.pieces, edge + np.array([0, height, 0])).min() > 5e-4


@pytest.mark.slow
def test_cuts_are_those_of_the_greedy_search():
    allowed = {
        "belly": np.where(np.arange(40) < 19, 6e-5, 5e-4),
        "handle": np.where((np.arange(49) >= 24) & (np.arange(49) <= 42), 9.5e-5, 6e-4),
        "spout": 1.2e-3,
        "lid": np.where(np.arange(41) < 15, 6e-5, 6e-4),
    }
    lofts = teapot_lofts()
    assert {name: lofts[name].find_cuts(tolerance) for name, tolerance in allowed.items()} == {
        name: CUTS[name] for name in allowed
    }


def shell_mass(mesh, keep, thickness=0.003, density=2300.0):
    """Mass and centre of walls by random points on the surface."""
    points, faces = trimesh.sample.sample_surface(mesh, 40_000, seed=0)
    kept = points[keep(points, mesh.face_normals[faces])]
    mass = thickness * density * mesh.area * len(kept) / len(points)
    return mass, kept.mean(axis=0)


def test_mass_of_the_lid_by_sampling():
    mass, centre = shell_mass(LID.mesh, lambda points, normals: normals[:, 1] > -0.999)
    assert mass_of(TEAPOT, ["lid"]).mass == pytest.approx(mass, rel=0.02)
    assert mass_of(TEAPOT, ["lid"]).centre == pytest.approx(centre, abs=1e-3)
    assert 0.05 < mass < 0.15


def test_mass_of_the_whole_is_plausible_and_the_sum_of_its_parts():
    assert 0.6 < TEAPOT.inertia.mass < 1.0  # a stoneware pot of 1.5 litres
    names = [part.name for part in TEAPOT.parts]
    assert mass_of(TEAPOT, names).mass == TEAPOT.inertia.mass
    rest, lid = mass_of(TEAPOT, names[:3]), mass_of(TEAPOT, ["lid"])
    assert rest.mass + lid.mass == pytest.approx(TEAPOT.inertia.mass)
    first = rest.mass * rest.centre + lid.mass * lid.centre
    assert first / TEAPOT.inertia.mass == pytest.approx(TEAPOT.inertia.centre)


def test_surfaces_are_made_once():
    assert teapot_surfaces() is teapot_surfaces()
