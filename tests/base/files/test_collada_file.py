"""COLLADA files: their triangles in metres, and what would grow without end refused before it is built."""

import sys

import numpy as np
import pytest
import trimesh
from holdfast.base.files.collada_file import read_collada
from holdfast.base.files.mesh_guard import check_mesh
from holdfast.errors import InputError
from holdfast.hands import load_hand
from holdfast.objects import load_object

BOX = trimesh.creation.box([0.05, 0.06, 0.09])
NUMBERS = " ".join(f"{x:.6g}" for x in BOX.vertices.ravel())
INDICES = " ".join(map(str, BOX.faces.ravel()))
GEOMETRY = f"""<library_geometries><geometry id="g"><mesh>
  <source id="s"><float_array id="f" count="24">{NUMBERS}</float_array><technique_common>
    <accessor source="#f" count="8" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
    <param name="Z" type="float"/></accessor></technique_common></source>
  <vertices id="v"><input semantic="POSITION" source="#s"/></vertices>
  <triangles count="12"><input semantic="VERTEX" source="#v" offset="0"/><p>{INDICES}</p></triangles>
</mesh></geometry></library_geometries>"""
ONE = '<node id="n"><instance_geometry url="#g"/></node>'
MOVED = '<node id="m"><translate>1 0 0</translate><instance_geometry url="#g"/></node>'


def dae(nodes: str = ONE, *, unit: str = "", library: str = "", before: str = "") -> bytes:
    return f"""<?xml version="1.0" encoding="utf-8"?>{before}
    <COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
    <asset><created>2020-01-01T00:00:00</created><modified>2020-01-01T00:00:00</modified>{unit}
    <up_axis>Y_UP</up_axis></asset>{GEOMETRY}{library}
    <library_visual_scenes><visual_scene id="scene">{nodes}</visual_scene></library_visual_scenes>
    <scene><instance_visual_scene url="#scene"/></scene></COLLADA>""".encode()


def doubled(levels: int) -> str:
    """Nodes of which each holds two copies of the one before."""
    copies = [
        f'<node id="d{k + 1}"><instance_node url="#d{k}"/><instance_node url="#d{k}"/></node>'
        for k in range(levels)
    ]
    first = ONE.replace('id="n"', 'id="d0"')
    return f"<library_nodes>{first}{''.join(copies)}</library_nodes>"


@pytest.mark.parametrize(("unit", "metres"), [("", 1.0), ('<unit name="mm" meter="0.001"/>', 0.001)])
def test_triangles_stand_where_the_file_puts_them_in_its_unit(unit, metres):
    pytest.importorskip("collada", reason="pycollada is not installed")
    mesh = read_collada(dae(ONE + MOVED, unit=unit))
    assert len(mesh.faces) == 24
    low, high = BOX.bounds
    assert np.allclose(mesh.bounds, metres * np.array([low, high + np.array([1.0, 0.0, 0.0])]))


def test_objects_and_hands_are_read_from_it(tmp_path):
    pytest.importorskip("collada", reason="pycollada is not installed")
    for folder, other in (("object", "box.stl"), ("object", "box.dae"), ("hand", "box.dae")):
        (tmp_path / folder).mkdir(exist_ok=True)
        data = dae() if other.endswith("dae") else BOX.export(file_type="stl")
        (tmp_path / folder / other).write_bytes(data)
    one, two = (load_object(tmp_path / "object" / name) for name in ("box.stl", "box.dae"))
    assert two.inertia.mass == pytest.approx(one.inertia.mass)
    link = '<collision><geometry><mesh filename="box.dae"/></geometry></collision>'
    urdf = f"""<robot name="r"><link name="palm">{link}</link><link name="finger">{link}</link>
      <joint name="bend" type="revolute"><parent link="palm"/><child link="finger"/>
      <origin xyz="0 0 0.1"/><axis xyz="0 1 0"/><limit lower="0" upper="1" effort="1" velocity="1"/></joint>
      </robot>"""
    (tmp_path / "hand" / "hand.urdf").write_text(urdf, "utf-8")
    hand = load_hand(tmp_path / "hand" / "hand.urdf")
    low, high = hand.links[1].shapes[0].bounds
    assert np.allclose([low, high], BOX.bounds, atol=1e-6)


CIRCLE = (
    '<node id="a"><instance_node url="#b"/></node>'
    '<node id="b"><node id="c"><instance_node url="#a"/></node></node>'
)
WIDE = dae(before="<!DOCTYPE COLLADA>").decode().replace("utf-8", "utf-16").encode("utf-16")


@pytest.mark.parametrize(
    ("says", "data"),
    [
        ("more than 1000 triangles", dae('<instance_node url="#d20"/>', library=doubled(20))),
        ("circle", dae(CIRCLE)),
        ("document type", dae(before="<!DOCTYPE COLLADA [<!ENTITY a 'b'>]>")),
        ("document type", WIDE),
        ("no COLLADA file", dae()[:-20]),
        ("no COLLADA file", b"\0\1\2"),
    ],
)
def test_what_grows_or_is_no_collada_is_refused(says, data):
    with pytest.raises(ValueError, match=says):
        check_mesh(data, "dae", largest=1000)


def test_without_the_library_it_is_refused_with_the_remedy(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "collada", None)
    (tmp_path / "box.dae").write_bytes(dae() + b"\n")  # not read before
    with pytest.raises(InputError, match=r"holdfast\[dae\].*or export it as"):
        load_object(tmp_path / "box.dae")


def test_shapes_that_stand_nowhere_are_told():
    pytest.importorskip("collada", reason="pycollada is not installed")
    hung = '<node id="n"><instance_controller url="#skin"/></node>'
    for nodes in ("", hung):
        data = dae(nodes)
        with pytest.raises(ValueError, match="none of its shapes stands in its scene"):
            read_collada(data)
