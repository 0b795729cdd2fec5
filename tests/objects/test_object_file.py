from pathlib import Path

import numpy as np
import pytest
import yaml
from holdfast.objects import ObjectModel, load_object, names_object


def load(folder: Path, **fields) -> ObjectModel:
    data = {"name": "thing", "mass": 0.2, "friction": 0.5, **fields}
    path = folder / "thing.yaml"
    path.write_text(yaml.safe_dump(data))
    return load_object(path)


@pytest.mark.parametrize(
    ("text", "is_one"),
    [
        ("{box: {half_extents: [1, 1, 1]}}", True),
        ("{friction: 0.5, bx: 1}", True),
        ("{hand: sa, object: scalpel, contacts: []}", False),
        ("{hand: sa, object: scalpel}", False),
        ("{links: [], mass: 1}", False),
        ("[1, 2]", False),
    ],
)
def test_objects_are_told_from_tasks_by_their_fields(tmp_path, text, is_one):
    path = tmp_path / "one.yaml"
    path.write_text(text)
    assert names_object(str(path)) == is_one
    assert names_object("scalpel") and names_object("mug.obj")
    assert not names_object("upholding") and not names_object("family:mug:1")
    assert not names_object(str(tmp_path / "none.yaml"))


@pytest.mark.parametrize(
    ("shape", "volume", "moments"),
    [
        ({"box": {"half_extents": [0.01, 0.02, 0.03]}}, 4.8e-5, np.array([52, 40, 20]) * 1e-4 / 12),
        ({"sphere": {"radius": 0.03}}, 4 / 3 * np.pi * 0.03**3, 0.4 * 0.03**2 * np.ones(3)),
        (
            {"cylinder": {"radius": 0.02, "length": 0.1}},
            np.pi * 0.02**2 * 0.1,
            np.array([0.1**2 / 12 + 0.02**2 / 4] * 2 + [0.5 * 0.02**2]),
        ),
    ],
    ids=["box", "sphere", "cylinder"],
)
def test_primitives(tmp_path, shape, volume, moments):
    thing = load(tmp_path, **shape)
    assert thing.mesh.is_watertight
    assert thing.mesh.volume == pytest.approx(volume, rel=0.01)
    assert len(thing.pieces) == 1
    assert thing.inertia.mass == pytest.approx(0.2)
    assert thing.inertia.centre == pytest.approx([0, 0, 0], abs=1e-9)
    assert thing.inertia.inertia == pytest.approx(0.2 * np.diag(moments), rel=0.01, abs=1e-9)


def test_capsule(tmp_path):
    thing = load(tmp_path, capsule={"radius": 0.01, "length": 0.05})
    assert thing.mesh.bounds == pytest.approx(np.array([[-1, -1, -3.5], [1, 1, 3.5]]) * 0.01, rel=0.01)
    assert len(thing.pieces) == 1


def test_mass_of_a_mesh_by_parallel_axes(tmp_path, l_mesh):
    l_mesh.export(tmp_path / "l.obj")
    thing = load(tmp_path, mesh="l.obj")
    areas = np.array([0.06 * 0.02, 0.02 * 0.04])
    centres = np.array([[0.03, 0.01], [0.01, 0.04]])
    centre = areas @ centres / areas.sum()
    masses = 0.2 * areas / areas.sum()
    own = masses * np.array([0.06**2 + 0.02**2, 0.02**2 + 0.04**2]) / 12
    about_z = np.sum(own + masses * np.sum((centres - centre) ** 2, axis=1))
    assert thing.inertia.mass == pytest.approx(0.2)
    assert thing.inertia.centre == pytest.approx([*centre, 0.01], abs=1e-6)
    assert thing.inertia.inertia[2, 2] == pytest.approx(about_z, rel=1e-5)


def test_a_given_centre_moves_the_inertia_with_it(tmp_path):
    box = {"box": {"half_extents": [0.01, 0.02, 0.03]}}
    plain = load(tmp_path, **box).inertia
    moved = load(tmp_path, **box, centre=[0.005, 0, 0]).inertia
    assert moved.centre == pytest.approx([0.005, 0, 0])
    assert moved.inertia - plain.inertia == pytest.approx(0.2 * 0.005**2 * np.diag([0, 1, 1]), abs=1e-12)


def test_given_centre_and_inertia_are_taken(tmp_path):
    inertia = [[1e-4, 0, 0], [0, 1.1e-4, 1e-6], [0, 1e-6, 0.9e-4]]
    thing = load(tmp_path, box={"half_extents": [0.03] * 3}, centre=[0, 0.01, 0], inertia=inertia)
    assert thing.inertia.centre == pytest.approx([0, 0.01, 0])
    assert thing.inertia.inertia == pytest.approx(np.array(inertia))


def test_regions_and_sources(tmp_path):
    region = {"point": [0.03, 0, 0], "normal": [1, 0, 0]}
    thing = load(
        tmp_path, sphere={"radius": 0.03}, regions={"side/right": region}, sources={"mass": "scales"}
    )
    assert list(thing.regions) == ["side/right"]
    assert thing.sources == {"mass": "scales"}
    assert thing.size_m == pytest.approx(0.06 * np.sqrt(3), rel=0.01)


@pytest.mark.parametrize(
    "shape",
    [
        {"sphere": {"radius": 0.03}, "mass": 0.1},
        {"box": {"half_extents": [0.01, 0.02, 0.03]}, "mass": 0.1},
        {"generator": "scalpel"},
    ],
)
def test_every_kind_has_the_colour_that_is_asked_for(tmp_path: Path, shape: dict[str, object]) -> None:
    assert {part.rgba for part in load(tmp_path, **shape, rgba=[0.1, 0.2, 0.3, 1.0]).parts} == {
        (0.1, 0.2, 0.3, 1.0)
    }


def test_without_a_colour_an_object_is_no_grey(tmp_path: Path) -> None:
    (part,) = load(tmp_path, sphere={"radius": 0.03}, mass=0.1).parts
    assert max(part.rgba[:3]) - min(part.rgba[:3]) > 0.4
