"""Objects of several bodies, objects made of own Bezier surfaces, and regions cut from surfaces."""

import re
from pathlib import Path

import numpy as np
import pytest
import trimesh
import yaml
from holdfast.errors import InputError
from holdfast.geometry import BezierPatch, MassProperties, combined_mass
from holdfast.geometry.solids.mass import shell_inertia, solid_inertia
from holdfast.objects import load_object

from .conftest import mass_of
from .surface import distance_to_mesh, is_closed


class WrittenOut(yaml.SafeDumper):
    """Repeats what stands twice in a tree, as a person would."""

    def ignore_aliases(self, data):
        return True


def load(folder, **fields):
    path = folder / "thing.yaml"
    path.write_text(yaml.dump({"name": "thing", "friction": 0.5, **fields}, Dumper=WrittenOut))
    return load_object(path)


def straight(*corners):
    """A bicubic net (4 x 4) of a flat or twisted quadrangle from p(0,0), p(0,1), p(1,0), p(1,1)."""
    a, b, c, d = (np.array(corner, dtype=float) for corner in corners)
    t = np.linspace(0, 1, 4)[:, None]
    rows = [(1 - s) * ((1 - t) * a + t * b) + s * ((1 - t) * c + t * d) for s in np.linspace(0, 1, 4)]
    return np.array(rows)


def cushion(bulge=0.01):
    """A box of 60 x 40 x 20 mm whose six bicubic sides bulge; neighbours share their edges."""
    x, y, z = 0.03, 0.02, 0.01
    nets = {
        "right": straight((x, -y, -z), (x, -y, z), (x, y, -z), (x, y, z)),
        "left": straight((-x, -y, -z), (-x, y, -z), (-x, -y, z), (-x, y, z)),
        "back": straight((-x, y, -z), (x, y, -z), (-x, y, z), (x, y, z)),
        "front": straight((-x, -y, -z), (-x, -y, z), (x, -y, -z), (x, -y, z)),
        "top": straight((-x, -y, z), (-x, y, z), (x, -y, z), (x, y, z)),
        "bottom": straight((-x, -y, -z), (x, -y, -z), (-x, y, -z), (x, y, -z)),
    }
    outwards = {"right": (1, 0, 0), "left": (-1, 0, 0), "back": (0, 1, 0), "front": (0, -1, 0)}
    outwards |= {"top": (0, 0, 1), "bottom": (0, 0, -1)}
    for name, net in nets.items():
        if BezierPatch(net).unit_normal(0.5, 0.5) @ outwards[name] < 0:
            net[:] = net[::-1].copy()
        net[1:3, 1:3] += bulge * np.array(outwards[name])
    return {name: net.tolist() for name, net in nets.items()}


def bulge_volume(bulge):
    """Each side gains its area times the mean of the four inner basis functions, (1/4 + 1/4)^2 = 1/4."""
    return 0.06 * 0.04 * 0.02 + 2 * bulge / 4 * (0.04 * 0.02 + 0.06 * 0.02 + 0.06 * 0.04)


def test_own_patches_make_a_closed_body(tmp_path):
    body = load(tmp_path, mass=0.1, patches=cushion())
    assert is_closed(body.mesh)
    assert body.mesh.volume == pytest.approx(bulge_volume(0.01), rel=5e-3)
    assert set(body.surfaces) == {"right", "left", "back", "front", "top", "bottom"}
    u, v = np.random.default_rng(0).uniform(size=(2, 20))
    for patch in body.surfaces.values():
        assert distance_to_mesh(body.mesh, patch.evaluate(u, v)).max() < 1e-4
    assert body.inertia.mass == pytest.approx(0.1)


def test_edges_apart_by_less_than_the_gap_are_joined(tmp_path):
    nets = {name: np.array(net) for name, net in cushion(0.0).items()}
    nets["top"] += 3e-5
    nets = {name: net.tolist() for name, net in nets.items()}
    with pytest.raises(InputError, match="do not close"):
        load(tmp_path, mass=0.1, patches=nets)
    assert is_closed(load(tmp_path, mass=0.1, patches=nets, patch_gap=1e-4).mesh)


def test_a_body_with_a_pole(tmp_path):
    """A patch may shrink to a point along an edge: a cone on four sides with a flat base."""
    corners = 0.02 * np.array([(1, 1, 0), (-1, 1, 0), (-1, -1, 0), (1, -1, 0)])
    top = np.array([0, 0, 0.05])
    nets = {
        f"side_{k}": [[corners[k].tolist(), top.tolist()], [corners[(k + 1) % 4].tolist(), top.tolist()]]
        for k in range(4)
    }
    nets["base"] = [[corners[3].tolist(), corners[0].tolist()], [corners[2].tolist(), corners[1].tolist()]]
    cone = load(tmp_path, mass=0.1, patches=nets)
    assert cone.mesh.volume == pytest.approx(0.04**2 * 0.05 / 3)
    region = {"surface": "side_0", "u": [0.2, 0.8], "v": [0.1, 0.6]}
    assert "a" in load(tmp_path, mass=0.1, patches=nets, regions={"a": region}).regions
    with pytest.raises(InputError, match="degenerate"):
        load(tmp_path, mass=0.1, patches=nets, regions={"a": {"surface": "side_0"}})


def changed(name, change):
    nets = cushion()
    nets[name] = change(nets[name])
    return nets


BAD_PATCHES = {
    "one missing": ({k: v for k, v in cushion().items() if k != "top"}, "patches", "do not close"),
    "one inwards": (changed("left", lambda net: net[::-1]), "patches.left", "reverse the order of its rows"),
    "all inwards": ({k: v[::-1] for k, v in cushion().items()}, "patches", "look inwards"),
    "twice": ({**cushion(), "again": cushion()["top"]}, "patches", "more than two"),
    "ragged": (changed("top", lambda net: [net[0][:2], *net[1:]]), "patches.top", "same number"),
    "a line": (changed("top", lambda net: net[:1]), "patches.top", "2 x 2"),
    "none": ({}, "patches", "at least 1"),
}


@pytest.mark.parametrize(("nets", "field", "words"), BAD_PATCHES.values(), ids=BAD_PATCHES)
def test_patches_that_do_not_make_a_body(tmp_path, nets, field, words):
    with pytest.raises(InputError, match=words) as caught:
        load(tmp_path, mass=0.1, patches=nets)
    assert caught.value.field.startswith(field)


def test_regions_are_cut_exactly(tmp_path):
    cut = {"surface": "top", "u": [0.2, 0.5], "v": [0.25, 1.0]}
    body = load(tmp_path, mass=0.1, patches=cushion(), regions={"grip": cut, "whole": {"surface": "left"}})
    patch, whole = body.regions["grip"].patch, body.surfaces["top"]
    assert patch.degree == (3, 3)
    s, t = np.random.default_rng(0).uniform(size=(2, 30))
    expected = whole.evaluate(0.2 + 0.3 * s, 0.25 + 0.75 * t)
    assert patch.evaluate(s, t) == pytest.approx(expected, abs=1e-15)
    assert body.regions["whole"].patch.control_points == pytest.approx(np.array(cushion()["left"]))


BAD_CUTS = {
    "unknown surface": ({"surface": "tpo"}, "grip.surface", "did you mean 'top'"),
    "backwards": ({"surface": "top", "u": [0.6, 0.2]}, "grip", "range"),
    "empty": ({"surface": "top", "v": [0.5, 0.5]}, "grip", "range"),
    "beyond": ({"surface": "top", "u": [0.2, 1.4]}, "grip.u.1", "less than or equal to 1"),
    "negative": ({"surface": "top", "u": [-0.2, 0.4]}, "grip.u.0", "greater than or equal to 0"),
    "NaN": ({"surface": "top", "u": [float("nan"), 0.4]}, "grip.u.0", "finite|greater"),
    "one number": ({"surface": "top", "u": [0.2]}, "grip.u", "required|tuple"),
    "without a surface": ({"u": [0.2, 0.4]}, "grip", "exactly one"),
    "u of a point": ({"point": [0, 0, 0.01], "normal": [0, 0, 1], "u": [0, 1]}, "grip", "not named"),
    "two kinds": ({"surface": "top", "point": [0, 0, 0], "normal": [0, 0, 1]}, "grip", "exactly one"),
}


@pytest.mark.parametrize(("region", "field", "words"), BAD_CUTS.values(), ids=BAD_CUTS)
def test_cuts_that_make_no_sense(tmp_path, region, field, words):
    with pytest.raises(InputError, match=words) as caught:
        load(tmp_path, mass=0.1, patches=cushion(), regions={"grip": region})
    assert caught.value.field.startswith(f"regions.{field}")


def test_an_object_without_surfaces_says_so(tmp_path):
    with pytest.raises(InputError, match="unknown surface"):
        load(tmp_path, mass=0.1, sphere={"radius": 0.02}, regions={"a": {"surface": "top"}})


def jar(folder):
    """A pot and a lid as meshes, 20 mm of height apart."""
    lid = trimesh.creation.box(extents=[0.04, 0.04, 0.01])
    lid.apply_translation([0, 0, 0.06])
    lid.export(folder / "lid.obj")
    return {
        "lid": {"mesh": "lid.obj", "mass": 0.1, "rgba": [0.2, 0.4, 0.6, 1.0]},
        "pot": {"cylinder": {"radius": 0.03, "length": 0.08}, "mass": 0.5, "centre": [0, 0, -0.01]},
    }


def test_an_object_of_several_bodies(tmp_path):
    thing = load(
        tmp_path, parts=jar(tmp_path), regions={"knob": {"point": [0, 0, 0.065], "normal": [0, 0, 1]}}
    )
    assert [part.name for part in thing.parts] == ["lid", "pot"]
    assert thing.inertia.mass == pytest.approx(0.6)
    assert thing.inertia.centre[2] == pytest.approx((0.1 * 0.06 - 0.5 * 0.01) / 0.6)
    lid = mass_of(thing, ["lid"])
    assert lid.mass == pytest.approx(0.1)
    assert lid.centre == pytest.approx([0, 0, 0.06], abs=1e-9)
    assert np.diag(lid.inertia) == pytest.approx(0.1 / 12 * np.array([17e-4, 17e-4, 32e-4]))
    assert mass_of(thing, ["pot"]).centre == pytest.approx([0, 0, -0.01])
    assert thing.parts[0].rgba == (0.2, 0.4, 0.6, 1.0)
    assert [part.name for part in thing.select_parts(["pot", "lid"])] == ["lid", "pot"]
    with pytest.raises(InputError, match="did you mean 'lid'"):
        thing.select_parts(["lit"])
    with pytest.raises(InputError, match="at least one"):
        thing.select_parts([])


def test_shapes_lie_where_their_pose_puts_them(tmp_path):
    quarter_about_x = [np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0]
    there = {"position": [0.0, 0.0, 0.1], "quaternion": [float(c) for c in quarter_about_x]}
    parts = {
        "shaft": {"cylinder": {"radius": 0.01, "length": 0.2}, "mass": 0.1},
        "head": {"cylinder": {"radius": 0.02, "length": 0.08}, "pose": there, "mass": 0.3},
        "pad": {"patches": cushion(), "pose": {"position": [0.1, 0, 0]}, "mass": 0.1},
    }
    thing = load(tmp_path, parts=parts, regions={"grip": {"surface": "pad/top"}})
    head, pad = (part for part in thing.parts if part.name != "shaft")
    assert head.mesh.bounds == pytest.approx(np.array([[-0.02, -0.04, 0.08], [0.02, 0.04, 0.12]]))
    assert head.inertia.centre == pytest.approx([0.0, 0.0, 0.1], abs=1e-9)
    assert np.argmin(np.diag(head.inertia.inertia)) == 1
    assert head.mesh.is_watertight and head.mesh.volume > 0
    assert pad.mesh.bounds.mean(axis=0)[0] == pytest.approx(0.1)
    assert thing.regions["grip"].middle()[0][0] == pytest.approx(0.1)
    whole = {"box": {"half_extents": [0.01, 0.02, 0.03]}, "mass": 0.1, "pose": there}
    (box,) = load(tmp_path, **whole).parts
    assert box.mesh.extents == pytest.approx([0.02, 0.06, 0.04])
    assert box.pieces[0].vertices.mean(axis=0) == pytest.approx([0.0, 0.0, 0.1], abs=1e-9)


def test_surfaces_of_a_part_have_its_name_before_theirs(tmp_path):
    parts = {"pad": {"patches": cushion(), "mass": 0.1}, "ball": {"sphere": {"radius": 0.03}, "mass": 0.2}}
    thing = load(tmp_path, parts=parts, regions={"grip": {"surface": "pad/top", "u": [0.1, 0.9]}})
    assert "pad/left" in thing.surfaces
    assert "grip" in thing.regions


BAD_PARTS = {
    "none": ({"parts": {}}, "parts", "at least 1"),
    "a list": ({"parts": [{"sphere": {"radius": 0.03}, "mass": 0.2}]}, "parts", "dictionary"),
    "no shape": ({"parts": {"a": {"mass": 0.2}}}, "parts.a", "exactly one of mesh, box"),
    "two shapes": (
        {"parts": {"a": {"mass": 0.2, "sphere": {"radius": 0.1}, "mesh": "a.obj"}}},
        "parts.a",
        "exactly one",
    ),
    "no mass": ({"parts": {"a": {"sphere": {"radius": 0.03}}}}, "parts.a", "mass is required"),
    "long quaternion": (
        {"parts": {"a": {"sphere": {"radius": 0.03}, "mass": 0.2, "pose": {"quaternion": [1, 1, 0, 0]}}}},
        "parts.a.pose.quaternion",
        "length 1",
    ),
    "pose of the whole": (
        {"pose": {}, "parts": {"a": {"sphere": {"radius": 0.03}, "mass": 0.2}}},
        "",
        "each of the parts",
    ),
    "pose of a generator": ({"generator": "teapot", "pose": {}}, "", "no pose"),
    "mass of the whole": (
        {"mass": 1.0, "parts": {"a": {"sphere": {"radius": 0.03}, "mass": 0.2}}},
        "",
        "each of the parts",
    ),
    "beside a shape": (
        {"box": {"half_extents": [0.1] * 3}, "parts": {"a": {"sphere": {"radius": 0.03}, "mass": 0.2}}},
        "",
        "exactly one",
    ),
    "missing mesh": ({"parts": {"a": {"mesh": "a.obj", "mass": 0.2}}}, "parts.a.mesh", "no such file"),
    "mesh outside": ({"parts": {"a": {"mesh": "../a.obj", "mass": 0.2}}}, "parts.a.mesh", "below the folder"),
    "centre outside": (
        {"parts": {"a": {"sphere": {"radius": 0.03}, "mass": 0.2, "centre": [1, 0, 0]}}},
        "parts.a.centre",
        "inside",
    ),
    "colour": (
        {"parts": {"a": {"sphere": {"radius": 0.03}, "mass": 0.2, "rgba": [2, 0, 0, 1]}}},
        "parts.a.rgba.0",
        "less than or equal to 1",
    ),
    "misspelt": (
        {"parts": {"a": {"spere": {"radius": 0.03}, "mass": 0.2}}},
        "parts.a.spere",
        "did you mean 'sphere'",
    ),
    "parts of parts": ({"parts": {"a": {"parts": {}, "mass": 0.2}}}, "parts.a.parts", "unknown field"),
    "name climbing": ({"parts": {"../a": {"sphere": {"radius": 0.03}, "mass": 0.2}}}, "parts", "letters"),
    "gap without patches": ({"mass": 1.0, "sphere": {"radius": 0.03}, "patch_gap": 1e-4}, "", "patch_gap"),
}


@pytest.mark.parametrize(("fields", "field", "words"), BAD_PARTS.values(), ids=BAD_PARTS)
def test_bad_parts(tmp_path, fields, field, words):
    with pytest.raises(InputError, match=words) as caught:
        load(tmp_path, **fields)
    assert caught.value.field.startswith(field)
    assert "\n" not in str(caught.value)


def test_solid_and_shell_of_a_ball():
    ball = trimesh.creation.icosphere(subdivisions=5, radius=0.05)
    solid, shell = solid_inertia(ball, 1000.0), shell_inertia(np.array(ball.triangles), 3.0)
    assert solid.mass == pytest.approx(1000 * 4 / 3 * np.pi * 0.05**3, rel=2e-3)
    assert solid.inertia == pytest.approx(0.4 * solid.mass * 0.05**2 * np.eye(3), rel=3e-3, abs=1e-9)
    assert shell.mass == pytest.approx(3.0 * 4 * np.pi * 0.05**2, rel=2e-3)
    assert shell.inertia == pytest.approx(2 / 3 * shell.mass * 0.05**2 * np.eye(3), rel=3e-3, abs=1e-9)


def test_a_shell_far_from_the_origin():
    """A flat square plate: m a^2 / 12 in its plane and twice that across, about its own centre."""
    corners = np.array([(1, 2, 3), (1.1, 2, 3), (1.1, 2.1, 3), (1, 2.1, 3)])
    plate = shell_inertia(corners[[[0, 1, 2], [0, 2, 3]]], 2.0)
    assert plate.mass == pytest.approx(0.02)
    assert plate.centre == pytest.approx([1.05, 2.05, 3.0])
    assert plate.inertia == pytest.approx(0.02 * 0.01 / 12 * np.diag([1, 1, 2]), abs=1e-15)


def test_joined_bodies_by_point_masses():
    """Sums over point masses, which need no parallel-axis theorem."""
    rng = np.random.default_rng(0)
    bodies, points, masses = [], [], []
    for _ in range(3):
        x, m = rng.normal(size=(6, 3)), rng.uniform(0.1, 1, 6)
        points.append(x)
        masses.append(m)
        bodies.append(from_points(x, m))
    whole, expected = combined_mass(bodies), from_points(np.vstack(points), np.concatenate(masses))
    assert whole.mass == pytest.approx(expected.mass)
    assert whole.centre == pytest.approx(expected.centre)
    assert whole.inertia == pytest.approx(expected.inertia)


def from_points(x, m):
    centre = m @ x / m.sum()
    d = x - centre
    second = np.einsum("n,ni,nj->ij", m, d, d)
    return MassProperties(float(m.sum()), centre, np.trace(second) * np.eye(3) - second)


def test_the_documented_object_files(tmp_path):
    text = (Path(__file__).resolve().parents[2] / "docs" / "files.md").read_text("utf-8")
    section = text.split("## Object file\n")[1].split("\n## ")[0]
    blocks = re.findall(r"```yaml\n(.*?)```", section, re.S)
    objects = {}
    for block in blocks:
        path = tmp_path / "object.yaml"
        path.write_text(block, "utf-8")
        made = load_object(path)
        objects[made.name] = made
        assert all(is_closed(part.mesh) for part in made.parts)
        for region in made.regions.values():
            points, _ = region.sample(10, np.random.default_rng(0))
            assert distance_to_mesh(made.mesh, points).max() < 1e-6
    assert set(objects) == {"bar", "hammer", "jar"}
    assert mass_of(objects["hammer"], ["head"]).centre == pytest.approx([0, 0, 0.13])
    assert mass_of(objects["jar"], ["lid"]).mass == pytest.approx(0.1)
