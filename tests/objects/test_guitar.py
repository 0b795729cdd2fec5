"""The guitars: closed parts, dimensions of the benchmark and of a real guitar, regions on the surface."""

import numpy as np
import pytest
import trimesh
from holdfast.geometry import Patch
from holdfast.objects import load_object
from holdfast.objects.generators.guitar_plan import BENCHMARK, REAL
from scipy.spatial import ConvexHull

PLANS = {"guitar": BENCHMARK, "guitar_real": REAL}
NAMES = list(PLANS)


def part(obj, name):
    (found,) = [part for part in obj.parts if part.name == name]
    return found


def distance_to(pieces, points):
    """Signed distance (n,) to convex pieces: exact inside, a lower bound outside."""
    found = []
    for piece in pieces:
        equations = ConvexHull(piece.vertices).equations
        found.append((points @ equations[:, :3].T + equations[:, 3]).max(axis=1))
    return np.min(found, axis=0)


@pytest.mark.parametrize("name", NAMES)
def test_parts(name):
    obj = load_object(name)
    names = [part.name for part in obj.parts]
    assert names[:7] == ["body", "bridge", "rosette", "neck", "head", "fingerboard", "frets"]
    assert names[7:] == [f"{kind}_{n}" for kind in ("key", "string") for n in range(1, 7)]
    for one in obj.parts:
        assert one.mesh.is_watertight and one.mesh.is_winding_consistent and one.mesh.volume > 0
        assert abs(one.inflation) < 1e-3, one.name


def test_dimensions_of_the_benchmark():
    obj = load_object("guitar")
    assert 1e3 * obj.mesh.bounds == pytest.approx(np.array([[37, -13, 25], [1462, 453, 148]]), abs=0.5)
    outline = part(obj, "body").mesh
    for x, width in ((240, 466), (480, 257), (600, 322)):
        section = outline.section(plane_origin=[1e-3 * x, 0, 0], plane_normal=[1, 0, 0])
        assert 1e3 * np.ptp(section.bounds[:, 1]) == pytest.approx(width, abs=1.0)
    keys = np.concatenate([part(obj, f"key_{n}").mesh.vertices for n in range(1, 7)])
    assert 1e3 * np.ptp(keys[:, 1]) == pytest.approx(162, abs=1.0)


def test_a_real_guitar():
    obj, plan = load_object("guitar_real"), REAL
    assert 1.4 <= obj.inertia.mass <= 2.0
    assert plan.scale == 0.650 and 2 * plan.neck_half_widths[1] == pytest.approx(0.052)
    # The neck joins at the 12th fret, half-way along the string.
    assert plan.fret_x(12) == pytest.approx(plan.joint_x, abs=1e-9)
    assert 0.95 <= np.ptp(obj.mesh.bounds[:, 0]) <= 1.02


@pytest.mark.parametrize("name", NAMES)
def test_frets_are_in_equal_temperament(name):
    plan = PLANS[name]
    lengths = np.array([plan.fret_x(n) - plan.bridge_x for n in range(plan.frets + 1)])
    assert lengths[:-1] / lengths[1:] == pytest.approx(2 ** (1 / 12))
    crowns = part(load_object(name), "frets").mesh.vertices
    tops = np.unique(crowns[np.isclose(crowns[:, 2], crowns[:, 2].max()), 0].round(9))
    assert tops[::-1] == pytest.approx([plan.fret_x(n) for n in range(1, plan.frets + 1)])


@pytest.mark.parametrize("name", NAMES)
def test_strings_pass_above_every_fret(name):
    obj, plan = load_object(name), PLANS[name]
    top_of_frets = part(obj, "frets").mesh.bounds[1, 2]
    for n in range(1, 7):
        for fret in range(plan.frets + 1):
            underside = plan.string_point(n, plan.fret_x(fret))[2] - plan.string_radii[n - 1]
            assert underside > top_of_frets


@pytest.mark.parametrize("name", NAMES)
def test_surfaces_lie_on_their_parts(name):
    """Contacts may sink by 0.1 mm in retraction: the surface stays well within that of the convex pieces."""
    obj = load_object(name)
    u, v = np.random.default_rng(0).uniform(size=(2, 400))
    assert len(obj.surfaces) == 3 + 12 + 30
    for surface, patch in obj.surfaces.items():
        kind = surface.split("_")[0]
        carrier = {"neck": "neck", "edge": "fingerboard"}.get(kind, "_".join(surface.split("_")[:2]))
        pieces = part(obj, carrier).pieces
        low, high = 0.0, 1.0
        if surface == "neck_back":  # the heel covers where it begins
            low = 0.2
        if surface.startswith("key"):  # the corners of the net lie outside the rounded outline
            low, high = 0.1, 0.9
        a, b = low + (high - low) * u, (low + (high - low) * v if high < 1 else v)
        points, normals = patch.evaluate(a, b), patch.unit_normal(a, b)
        assert 1e3 * np.abs(distance_to(pieces, points)).max() <= 0.05, surface
        assert 1e3 * distance_to(pieces, points + 1e-4 * normals).min() > 0.03, surface


@pytest.mark.parametrize("name", NAMES)
def test_regions_are_curved_patches_on_the_surface(name):
    obj = load_object(name)
    for key, region in obj.regions.items():
        assert isinstance(region, Patch)
        points, normals = region.sample(200, np.random.default_rng(1))
        assert 1e3 * distance_to(obj.pieces, points).max() <= (0.75 if key.startswith("paper") else 0.05), key
        if not key.startswith("paper"):
            assert max(region.patch.degree) >= 2
            assert np.ptp(normals, axis=0).max() > 0.005, key


def test_published_key_patches_touch_the_key_without_sinking_in():
    obj = load_object("guitar")
    for key in ("paper_tuning_index", "paper_tuning_thumb"):
        points, normals = obj.regions[key].sample(500, np.random.default_rng(2))
        distance = distance_to(part(obj, "key_3").pieces, points)
        assert 1e3 * distance.min() > -0.05 and 1e3 * distance.min() < 0.05
        assert 1e3 * distance.max() < 0.75
        # The patch is parallel to the middle of the face.
        side = "top" if key.endswith("index") else "bottom"
        assert normals[0] @ obj.surfaces[f"key_3_{side}"].unit_normal(0.5, 0.5) > 0.9999


def test_keys_turn_freely():
    """A key, turned about its axis, meets nothing but the head that its shaft enters."""
    obj = load_object("guitar")
    moved, others = part(obj, "key_3"), [p for p in obj.parts if p.name not in ("key_3", "head")]
    middle = [1.327323, 0.148, 0.093881]
    for angle in np.deg2rad([0, 45, 90]):
        mesh = moved.mesh.copy()
        mesh.apply_transform(trimesh.transformations.rotation_matrix(angle, [0, 1, 0], middle))
        for other in others:
            assert distance_to(other.pieces, np.array(mesh.vertices)).min() > 1e-3
