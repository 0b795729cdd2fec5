"""Patches fitted to meshes of known surfaces."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
import trimesh
import yaml
from holdfast.errors import InputError
from holdfast.objects import load_object
from holdfast.objects.fit import fit_patch
from holdfast.pipeline.cli.main import main

BALL = trimesh.creation.icosphere(subdivisions=4, radius=0.05)
BOX = trimesh.creation.box(extents=[0.1, 0.06, 0.04])


def unit(*v):
    return np.array(v) / np.linalg.norm(v)


@pytest.mark.parametrize("direction", [unit(1, 0, 0), unit(-1, 2, 0.5), unit(0.1, -0.2, -1)])
def test_a_ball(direction):
    fit = fit_patch(BALL, 0.051 * direction, 0.015)
    u, v = np.random.default_rng(0).uniform(size=(2, 200))
    points, normals = fit.patch.evaluate(u, v), fit.patch.unit_normal(u, v)
    # Facets of the mesh lie up to 0.05 mm below the sphere.
    assert np.abs(np.linalg.norm(points, axis=1) - 0.05).max() < 1e-4
    assert np.sum(normals * points, axis=1).min() > 0.05 * np.cos(0.05)
    corners = fit.patch.control_points[[0, 0, -1, -1], [0, -1, 0, -1]]
    across = corners - fit.centre
    n = fit.patch.unit_normal(0.5, 0.5)
    flat = across - np.outer(across @ n, n)
    assert np.linalg.norm(flat, axis=1) == pytest.approx([0.015] * 4, rel=0.01)
    assert fit.patch.degree == (3, 3)
    assert not fit.patch.normal_may_vanish()


def test_the_reported_errors_are_the_true_ones():
    """By closest points on all triangles at many random places."""
    fit = fit_patch(BALL, np.array([0.0, 0.05, 0.0]), 0.03, (2, 2))
    u, v = np.random.default_rng(0).uniform(size=(2, 300))
    points = fit.patch.evaluate(u, v)
    true = []
    for p in points:
        nearest = trimesh.triangles.closest_point(BALL.triangles, np.tile(p, (len(BALL.faces), 1)))
        true.append(np.linalg.norm(nearest - p, axis=1).min())
    assert max(true) < 1.1 * fit.max_m
    assert fit.rms_m == pytest.approx(np.sqrt(np.mean(np.square(true))), rel=0.25)
    assert fit.max_m > 2e-5


def test_a_higher_degree_comes_nearer():
    finer = trimesh.creation.icosphere(subdivisions=6, radius=0.05)
    errors = [fit_patch(finer, np.array([0.05, 0, 0]), 0.03, (n, n)).max_m for n in (1, 2, 4)]
    assert errors[1] < 0.2 * errors[0]
    assert errors[2] < 0.2 * errors[1]


def test_a_flat_face_is_exact():
    fit = fit_patch(BOX, np.array([0.01, 0.0, 0.025]), 0.02, (1, 1))
    assert fit.max_m < 1e-12
    assert fit.normal_rad < 1e-7
    assert fit.patch.unit_normal(0.3, 0.7) == pytest.approx([0, 0, 1])
    assert fit.patch.evaluate(0.5, 0.5) == pytest.approx([0.01, 0, 0.02])


def test_a_saddle():
    """The inner side of a ring bends outwards one way and inwards the other."""
    ring = trimesh.creation.torus(0.05, 0.015, major_sections=180, minor_sections=90)
    fit = fit_patch(ring, np.array([0.035, 0, 0]), 0.008)
    u, v = np.random.default_rng(0).uniform(size=(2, 200))
    points = fit.patch.evaluate(u, v)
    off_circle = np.hypot(np.hypot(points[:, 0], points[:, 1]) - 0.05, points[:, 2])
    assert np.abs(off_circle - 0.015).max() < 5e-5
    assert fit.patch.unit_normal(0.5, 0.5) == pytest.approx([-1, 0, 0], abs=0.02)


def test_the_far_side_of_a_thin_wall_is_no_fold_of_it():
    """A sheet of 2 mm: 3 mm from its rim there is room for a square of 2 x 2.1 mm, and for none that ends."""
    sheet = trimesh.creation.box((0.1, 0.1, 0.002))
    fit = fit_patch(sheet, np.array([0.0, 0.047, 0.001]), 0.004)
    assert fit.max_m < 1e-12
    assert np.allclose(fit.patch.unit_normal(0.5, 0.5), [0, 0, 1])
    with pytest.raises(InputError, match="ends or bends away"):
        fit_patch(sheet, np.array([0.0, 0.047, 0.001]), 0.006)


@pytest.mark.parametrize(
    ("mesh", "at", "radius", "words"),
    [
        (BALL, [0.08, 0, 0], 0.01, "is 0.03 m from the surface"),
        (BALL, [0, 0, 0], 0.01, "from the surface"),
        (BALL, [0.05, 0, 0], 0.2, "too large here: .* would do"),
        (BALL, [0.05, 0, 0], 0.08, "no graph over its tangent plane"),
        (BOX, [0.05, 0, 0.02], 0.01, "edge or a corner"),
        (BOX, [0.045, 0, 0.02], 0.02, "0.005 m would do"),
    ],
    ids=["far", "centre", "swallows", "half", "edge", "near an edge"],
)
def test_refusals(mesh, at, radius, words):
    with pytest.raises(InputError, match=words):
        fit_patch(mesh, np.array(at, dtype=float), radius)


@pytest.fixture
def ball_file(tmp_path):
    BALL.export(tmp_path / "ball.obj")
    return tmp_path / "ball.obj"


def test_the_command_prints_a_region_that_an_object_file_takes(ball_file, capsys):
    assert (
        main(["objects", "fit", str(ball_file), "--at", "-0.05,0,0", "--radius", "0.012", "--name", "left"])
        == 0
    )
    captured = capsys.readouterr()
    region = yaml.safe_load(captured.out)
    assert captured.out.startswith("# distance ")
    assert "rms" in captured.err
    data = {"name": "ball", "mesh": "ball.obj", "mass": 0.2, "friction": 0.5, "regions": region}
    path = ball_file.with_name("ball.yaml")
    path.write_text(yaml.safe_dump(data))
    ball = load_object(path)
    points, normals = ball.regions["left"].sample(20, np.random.default_rng(0))
    assert np.linalg.norm(points, axis=1) == pytest.approx([0.05] * 20, abs=1e-4)
    assert normals[:, 0].max() < -0.9


def test_the_command_as_json(ball_file, capsys):
    words = ["objects", "fit", str(ball_file), "--at=0.05,0,0", "--radius", "0.012", "--degree", "2,4"]
    assert main([*words, "--json", "-", "--quiet"]) == 0
    captured = capsys.readouterr()
    data = json.loads(captured.out)
    assert np.array(data["bezier"]).shape == (3, 5, 3)
    assert 0 < data["rms"] < data["max"] < 1e-4
    assert 0 < data["normal_angle"] < 0.1
    assert captured.err == ""


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--radius", "0.01"], "--at"),
        (["--at", "0.05,0", "--radius", "0.01"], "three numbers"),
        (["--at", "0.05,0,nan", "--radius", "0.01"], "three numbers"),
        (["--at", "0.05,0,0", "--radius", "-1"], "above 0"),
        (["--at", "0.05,0,0", "--radius", "0.01", "--degree", "10"], "from 1 to 9"),
        (["--at", "0.05,0,0", "--radius", "0.01", "--degree", "1,2,3"], "from 1 to 9"),
        (["--at", "0.05,0,0", "--radius", "0.01", "--name", "../x"], "letters, digits"),
        (["--at", "0.5,0,0", "--radius", "0.01"], "from the surface"),
    ],
)
def test_bad_usage_is_one_line(ball_file, capsys, words, message):
    assert main(["objects", "fit", str(ball_file), *words]) == 2
    captured = capsys.readouterr()
    assert message in captured.err
    assert captured.err.count("\n") == 1
    assert captured.out == ""


def test_meshes_in_millimetres_get_a_hint(tmp_path, capsys):
    trimesh.creation.box(extents=[60, 60, 100]).export(tmp_path / "box.stl")
    fit = ["objects", "fit", str(tmp_path / "box.stl"), "--quiet"]
    assert main([*fit, "--at", "30,0,0", "--radius", "10"]) == 0
    said = capsys.readouterr().err
    assert said.startswith("holdfast: warning: ") and said.count("\n") == 1
    assert "100 m long: probably millimetres; say `units: mm` (`--units` on the command line)" in said
    assert main([*fit, "--at", "0.03,0,0", "--radius", "0.01", "--units", "mm"]) == 0
    shown = capsys.readouterr()
    assert shown.err == "" and "[0.03000000, " in shown.out


def test_objects_by_name(capsys):
    assert (
        main(["objects", "fit", "family:cylinder:3", "--at", "0.0056,0,0", "--radius", "0.003", "--quiet"])
        == 0
    )
    assert "bezier" in capsys.readouterr().out


def test_the_documented_options_exist(capsys):
    text = (Path(__file__).resolve().parents[2] / "docs" / "commands.md").read_text("utf-8")
    section = text.partition("\n### `objects fit`\n")[2].partition("\n### ")[0]
    assert main(["objects", "fit", "--help"]) == 0
    options = set(re.findall(r"(--[a-z]+)", capsys.readouterr().out)) - {"--help"}
    assert options and set(re.findall(r"^- `(--[a-z]+)", section, re.M)) == options


def test_slivers_are_fitted_around_where_they_are():
    """A rod of facets 6 um wide: the library's nearest points lay on their edges, millimetres away."""
    rod = trimesh.creation.cylinder(radius=0.004, height=0.03, sections=4000)
    at = np.array([0.004 * np.cos(0.3), 0.004 * np.sin(0.3), 0.007])
    fit = fit_patch(rod, at, 0.002)
    assert fit.centre == pytest.approx(at, abs=1e-5)
    assert fit.max_m < 1e-5


def test_of_a_radius_beyond_the_body_one_is_named_that_would_do():
    with pytest.raises(InputError, match=r"too large here: .*; [0-9.e-]+ m would do"):
        fit_patch(BALL, np.array([0.05, 0.0, 0.0]), 1e4)


def test_a_tiny_patch_is_printed_with_digits_that_tell_its_points_apart(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    BOX.export("box.stl")
    assert main(["objects", "fit", "box.stl", "--at", "0,0,0.02", "--radius", "1e-7", "--quiet"]) == 0
    net = np.array(yaml.safe_load(capsys.readouterr().out)["region"]["bezier"])
    corners = net[[0, 0, -1, -1], [0, -1, 0, -1]]
    assert np.allclose(np.linalg.norm(corners - [0.0, 0.0, 0.02], axis=1), 1e-7, rtol=1e-3)
