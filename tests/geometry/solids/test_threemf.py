"""3MF files: units, poses, objects made of others, and what is wrong with them."""

import io
import re
import zipfile

import numpy as np
import pytest
import trimesh
from holdfast.base.files.threemf_file import read_3mf
from holdfast.errors import InputError
from holdfast.geometry.solids.mesh_file import read_mesh

CORE = 'xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"'
PRODUCTION = 'xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06"'
RELATIONS = """<?xml version="1.0"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
  <Relationship Target="/3D/a.model" Id="r" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>"""


def mesh_object(name, extents=(20.0, 20.0, 20.0), kind="model"):
    box = trimesh.creation.box(extents=extents)
    vertices = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in box.vertices)
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in box.faces)
    inner = f"<mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh>"
    return f'<object id="{name}" type="{kind}">{inner}</object>'


def model(objects, items, said=""):
    return (
        f'<?xml version="1.0"?><model {CORE} {PRODUCTION} {said}>'
        f"<resources>{objects}</resources><build>{items}</build></model>"
    )


def packed(**documents):
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("_rels/.rels", RELATIONS)
        for name, text in documents.items():
            archive.writestr(f"3D/{name}.model", text)
    return data.getvalue()


def read(tmp_path, data):
    (tmp_path / "a.3mf").write_bytes(data)
    return read_mesh(tmp_path / "a.3mf", "thing.yaml", "mesh")[0]


@pytest.mark.parametrize(("said", "side_m"), [("", 0.02), ('unit="inch"', 0.508), ('unit="micron"', 2e-5)])
def test_the_unit_that_a_file_states_is_applied(said, side_m):
    mesh = read_3mf(packed(a=model(mesh_object(1), '<item objectid="1"/>', said)), largest=100)
    assert mesh.extents == pytest.approx([side_m] * 3)
    assert mesh.volume == pytest.approx(side_m**3)


def test_objects_are_made_of_others_where_their_poses_say(tmp_path):
    """A bar whose end is turned by 90 degrees about z, mirrored, from another document, and placed again."""
    made_of = (
        '<object id="2"><components><component objectid="1"/><component objectid="7" p:path="/3D/b.model" '
        'transform="0 1 0 -1 0 0 0 0 -1 0 30 0"/></components></object>'
    )
    main = model(mesh_object(1) + made_of, '<item objectid="2" transform="1 0 0 0 1 0 0 0 1 100 0 10"/>')
    mesh = read(tmp_path, packed(a=main, b=model(mesh_object(7, (20, 10, 10)), "")))
    assert mesh.volume == pytest.approx(20e-3**3 + 20e-3 * 10e-3**2)
    assert mesh.bounds == pytest.approx(np.array([[0.09, -0.01, 0.0], [0.11, 0.04, 0.02]]))


def test_what_is_none_of_the_solid_is_left_out(tmp_path):
    objects = mesh_object(1) + mesh_object(2, (90, 9, 9), "support") + mesh_object(3, (9, 90, 9), "other")
    items = "".join(f'<item objectid="{k}"/>' for k in (1, 2, 3))
    assert read(tmp_path, packed(a=model(objects, items))).extents == pytest.approx([0.02] * 3)


CIRCLE = "".join(
    f'<object id="{a}"><components><component objectid="{b}"/></components></object>'
    for a, b in ((1, 2), (2, 1))
)
DOUBLING = mesh_object(0) + "".join(
    f'<object id="{k}"><components>{2 * f"""<component objectid="{k - 1}"/>"""}</components></object>'
    for k in range(1, 40)
)
ITEM = '<item objectid="1"/>'


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (packed(a=model(CIRCLE, ITEM)), "in a circle"),
        (packed(a=model(DOUBLING, '<item objectid="39"/>')), "more than 1000000 triangles"),
        (packed(a=model("", ITEM)), "has no object '1'"),
        (packed(b=model("", "")), "has no '/3D/a.model'"),
        (packed(a=model(mesh_object(1), ITEM, 'unit="cubit"')), "its unit is 'cubit'"),
        (packed(a=model(mesh_object(1), '<item objectid="1" transform="1 0 0"/>')), "twelve numbers"),
        (packed(a=re.sub('v1="\\d+"', 'v1="99"', model(mesh_object(1), ITEM))), "does not exist"),
        (packed(a=re.sub('v1="\\d+"', "", model(mesh_object(1), ITEM))), "lacks its 'v1'"),
        (packed(a=f'<!DOCTYPE a [<!ENTITY b "c">]>{model("", ITEM)[21:]}'), "document type"),
        (packed(a="<model"), "no 3MF file"),
        (b"PK\3\4 and no more", "no 3MF file"),
        (packed(a=model(mesh_object(1), ITEM))[:-300], "no 3MF file"),
        (packed(a=model("", "")), "holds no triangles"),
    ],
)
def test_bad_files_are_told(tmp_path, data, words):
    with pytest.raises(InputError) as told:
        read(tmp_path, data)
    assert words in str(told.value)


def test_an_archive_that_unpacks_without_end_is_left(tmp_path, monkeypatch):
    monkeypatch.setattr("holdfast.base.files.threemf_file._LARGEST_BYTES", 2**20)
    data = packed(a=model(mesh_object(1), ITEM) + " " * 2**21)
    assert len(data) < 2**14
    with pytest.raises(InputError, match="more than 1 MiB"):
        read(tmp_path, data)


def test_random_damage_never_escapes(tmp_path):
    data, rng = packed(a=model(mesh_object(1), ITEM)), np.random.default_rng(0)
    for _ in range(60):
        damaged = bytearray(data)
        for place in rng.integers(len(data), size=4):
            damaged[place] = rng.integers(256)
        try:
            read(tmp_path, bytes(damaged))
        except InputError:
            continue
