"""Tasks, objects, hands, models and meshes in folders side by side."""

import pytest
import trimesh
import yaml
from holdfast.errors import InputError
from holdfast.objects import load_task

FINGER = """
<mujoco>
  <compiler meshdir="../meshes"/>
  <asset><mesh name="pad" file="pad.stl"/></asset>
  <worldbody><body name="palm"><geom type="box" size="0.03 0.03 0.01"/>
    <include file="../models/fingers.xml"/>
  </body></worldbody>
</mujoco>
"""
FINGERS = """
<mujocoinclude><body name="finger" pos="0 0 0.05">
  <joint name="bend" axis="0 1 0" range="-1 1"/><geom type="mesh" mesh="pad"/>
</body></mujocoinclude>
"""


@pytest.fixture
def project(tmp_path, monkeypatch):
    folder = tmp_path / "project"
    for name in ("tasks", "objects", "hands", "models", "meshes"):
        (folder / name).mkdir(parents=True)
    trimesh.creation.box(extents=[40, 40, 40]).export(folder / "meshes" / "cube.stl")
    trimesh.creation.box(extents=[0.02, 0.02, 0.02]).export(folder / "meshes" / "pad.stl")
    (folder / "models" / "hand.xml").write_text(FINGER)
    (folder / "models" / "fingers.xml").write_text(FINGERS)
    servo = {"effort": 1.0, "stiffness": 8.0, "damping": 0.1, "armature": 0.001}
    tip = {"link": "finger", "point": [0, 0, 0.01], "normal": [0, 0, 1]}
    below = {"point": [0, 0, -0.02], "normal": [0, 0, -1]}
    files = {
        "hands/hand.yaml": {
            "name": "one", "import": "../models/hand.xml", "palm": "palm", "actuator": servo,
            "regions": {"tip": tip},
        },
        "objects/cube.yaml": {
            "name": "cube", "mesh": "../meshes/cube.stl", "units": "mm", "mass": 0.1, "friction": 0.5,
            "regions": {"below": below},
        },
        "tasks/touch.yaml": {
            "name": "touch", "hand": "../hands/hand.yaml", "object": "../objects/cube.yaml",
            "contacts": [{"hand": "tip", "object": "below"}],
        },
    }  # fmt: skip
    for name, data in files.items():
        (folder / name).write_text(yaml.safe_dump(data))
    (tmp_path / "away").mkdir()
    monkeypatch.delenv("HOLDFAST_ROOT", raising=False)
    monkeypatch.chdir(tmp_path / "away")
    return folder


def test_they_find_each_other_below_the_current_folder(project, monkeypatch):
    path = project / "tasks" / "touch.yaml"
    with pytest.raises(InputError, match=r"touch.yaml: hand: .*must be a path below"):
        load_task(path)
    monkeypatch.chdir(project)
    task = load_task("tasks/touch.yaml")
    assert (task.hand.name, task.object.name) == ("one", "cube")
    assert task.object.mesh.extents == pytest.approx([0.04, 0.04, 0.04])


def test_they_find_each_other_below_a_root_that_is_named(project, monkeypatch):
    monkeypatch.setenv("HOLDFAST_ROOT", str(project))
    assert load_task(project / "tasks" / "touch.yaml").hand.joint_names == ("bend",)


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("models/hand.xml", 'file="pad.stl"', 'file="../../away/cover.stl"'),
        ("models/hand.xml", "../models/fingers.xml", "../../away/fingers.xml"),
        ("hands/hand.yaml", "../models/hand.xml", "../../away/hand.xml"),
        ("objects/cube.yaml", "../meshes/cube.stl", "../../away/cube.stl"),
        ("objects/cube.yaml", "../meshes/cube.stl", "../meshes/linked.stl"),
        ("models/hand.xml", 'file="pad.stl"', 'file="linked.stl"'),
        ("tasks/touch.yaml", "../objects/cube.yaml", "../../away/cube.yaml"),
    ],
)
def test_nothing_elsewhere_is_read(project, monkeypatch, name, old, new):
    away = project.parent / "away"
    for kept in (
        "meshes/pad.stl",
        "meshes/cube.stl",
        "models/hand.xml",
        "models/fingers.xml",
        "objects/cube.yaml",
    ):
        (away / kept.split("/")[1]).write_bytes((project / kept).read_bytes())
    (away / "cover.stl").write_bytes((away / "pad.stl").read_bytes())
    (project / "meshes" / "linked.stl").symlink_to(away / "cube.stl")
    monkeypatch.chdir(project)
    text = (project / name).read_text()
    assert old in text
    (project / name).write_text(text.replace(old, new))
    with pytest.raises(InputError, match=r"must be a path below|No such file"):
        load_task("tasks/touch.yaml")
