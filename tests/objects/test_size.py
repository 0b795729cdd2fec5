"""Units of meshes, and warnings about sizes that no hand's object has."""

import numpy as np
import pytest
import trimesh
import yaml
from holdfast.errors import InputError, InputWarning
from holdfast.objects import UNITS_M, load_object, metres
from holdfast.pipeline.cli.main import main

SIDES_M = np.array([0.06, 0.08, 0.1])


def write(folder, unit, **fields):
    """An object file with a box whose mesh is in `unit`."""
    trimesh.creation.box(extents=SIDES_M / UNITS_M[unit]).export(folder / "box.obj")
    path = folder / "box.yaml"
    path.write_text(
        yaml.safe_dump({"name": "box", "mesh": "box.obj", "mass": 0.2, "friction": 0.5, **fields})
    )
    return path


@pytest.mark.parametrize("unit", UNITS_M)
def test_an_object_is_the_same_in_every_unit(tmp_path, unit):
    obj = load_object(write(tmp_path, unit, units=unit))
    assert obj.mesh.extents == pytest.approx(SIDES_M, rel=1e-6)
    assert np.diag(obj.inertia.inertia) == pytest.approx(
        0.2 / 12 * ((SIDES_M**2).sum() - SIDES_M**2), rel=1e-6
    )
    mesh = tmp_path / "box.obj"
    assert load_object(mesh, units=unit).mesh.volume == pytest.approx(SIDES_M.prod(), rel=1e-6)
    given = trimesh.load(mesh)
    assert load_object(given, units=unit).mesh.extents == pytest.approx(SIDES_M, rel=1e-6)
    assert load_object((given.vertices, given.faces), scale=UNITS_M[unit]).mesh.extents == pytest.approx(
        SIDES_M
    )


def test_scale_and_units_multiply(tmp_path):
    obj = load_object(write(tmp_path, "mm", units="mm", scale=1.5))
    assert obj.mesh.extents == pytest.approx(1.5 * SIDES_M, rel=1e-6)
    assert metres(2.0, "cm") == pytest.approx(0.02) and metres(None, None) == 1.0


def test_parts_have_units_of_their_own(tmp_path):
    write(tmp_path, "mm")
    parts = {
        "a": {"mesh": "box.obj", "units": "mm", "mass": 0.1},
        "b": {"sphere": {"radius": 0.02}, "mass": 0.1},
    }
    path = tmp_path / "two.yaml"
    path.write_text(yaml.safe_dump({"name": "two", "parts": parts, "friction": 0.5}))
    assert load_object(path).mesh.extents == pytest.approx(SIDES_M, rel=1e-6)


@pytest.mark.parametrize(
    ("unit", "words"),
    [
        ("mm", "probably millimetres; say `units: mm`"),
        ("cm", "10 m long: probably centimetres or inches; say `units: cm` or `units: in`"),
        ("in", "`units: in`"),
    ],
)
def test_a_size_in_another_unit_is_a_warning_that_names_it(tmp_path, unit, words):
    with pytest.warns(InputWarning, match=words) as caught:
        obj = load_object(write(tmp_path, unit))
    assert len(caught) == 1 and "box.yaml: mesh: the object is" in str(caught[0].message)
    assert obj.mesh.extents == pytest.approx(SIDES_M / UNITS_M[unit], rel=1e-6)


def test_units_given_for_a_mesh_in_metres_are_noticed_too(tmp_path):
    with pytest.warns(InputWarning, match="probably metres; say `units: m`"):
        load_object(write(tmp_path, "m", scale=0.02, units="m", mass=0.001))
    with pytest.raises(InputError, match=r"0\.0001 m long: probably metres; say `units: m`"):
        load_object(write(tmp_path, "m", units="mm"))


def test_a_box_written_in_millimetres_is_noticed(tmp_path):
    path = tmp_path / "box.yaml"
    box = {"half_extents": [30, 40, 50]}
    path.write_text(yaml.safe_dump({"name": "box", "box": box, "mass": 0.2, "friction": 0.5}))
    with pytest.warns(InputWarning, match="100 m long: were millimetres meant"):
        load_object(path)


@pytest.mark.parametrize("longest_m", [0.005, 0.02, 0.3, 1.425, 2.0])
def test_what_hands_hold_gets_no_warning(longest_m):
    assert load_object(trimesh.creation.box(extents=SIDES_M * longest_m / 0.1)).size_m > 0.0


def test_a_trimesh_of_the_caller_keeps_its_unit():
    mesh = trimesh.creation.box(extents=SIDES_M * 1e3)
    load_object(mesh, units="mm")
    assert mesh.extents == pytest.approx(SIDES_M * 1e3)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"units": "mmm"}, "unknown unit of length 'mmm'; did you mean 'mm'"),
        ({"scale": 0.0}, "scale: must lie in"),
        ({"scale": float("nan")}, "scale: must lie in"),
    ],
)
def test_units_that_are_none(given, words):
    with pytest.raises(InputError, match=words):
        load_object(trimesh.creation.box(extents=SIDES_M), **given)


def test_built_in_objects_have_units_of_their_own():
    with pytest.raises(InputError, match="scalpel has units of its own"):
        load_object("scalpel", units="mm")


def test_the_command_line_warns_in_one_line(tmp_path, capsys):
    path = write(tmp_path, "mm")
    assert main(["objects", str(path)]) == 0
    shown = capsys.readouterr()
    assert shown.err.count("\n") == 1 and shown.err.startswith("holdfast: warning: ")
    assert "say `units: mm`" in shown.err and "100000.0 mm" in shown.out
