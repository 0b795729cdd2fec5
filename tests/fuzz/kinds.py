"""Good inputs of every kind that a command reads, and the command that reads them without much work."""

import base64
import gzip
import json
import struct
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from holdfast import library
from holdfast.hands import load_hand
from holdfast.objects import load_object
from holdfast.solver import solve_system
from holdfast.solver.systems import system_from_data

__all__ = ["KINDS", "Kind"]

ROOT = Path(library.__file__).parent

SYSTEM = {"variables": {"x": [-2, 2], "y": [-2, 2]}, "equations": ["x**2 + y**2 - 1", "x - y**3"]}
TASK = """name: mine
description: two fingers on a box
hand: sa
object: thing.yaml
contacts:
  - {hand: index/tip, object: left}
  - {hand: thumb/tip, object: {point: [0.02, 0, 0], normal: [1, 0, 0]}}
joint_limits: {index_abduction: [-0.2, 0.2]}
support: {point: [0, 0, -0.02], normal: [0, 0, 1]}
"""
OBJECT = """name: thing
description: a box
box: {half_extents: [0.02, 0.02, 0.02]}
mass: 0.1
friction: 0.6
regions:
  left: {point: [-0.02, 0, 0], normal: [-1, 0, 0]}
  top: {bezier: [[[0.01, -0.01, 0.02], [0.01, 0.01, 0.02]], [[-0.01, -0.01, 0.02], [-0.01, 0.01, 0.02]]]}
sources: {mass: weighed}
"""
MESH_OBJECT = """name: cast
description: a box from a drawing in millimetres
mesh: cast.stl
units: mm
scale: 1000.0
mass: 0.1
friction: 0.6
regions:
  left: {point: [-0.02, 0, 0], normal: [-1, 0, 0], off_surface: true}
"""
HAND = """name: claw
import: claw.xml
palm: palm
actuator: {stiffness: 1.0, damping: 0.1, armature: 0.001, effort: 1.0}
pad: {modulus: 3500000.0, thickness: 0.01}
rated_force: 30.0
max_normal_force: 25.0
regions:
  a/tip: {link: a, cap: {centre: [0, 0, 0.03], radius: 0.01, axis: [0, 0, 1], half_angle_deg: 60}}
"""
MJCF = """<mujoco><compiler angle="radian"/><worldbody><body name="palm"><geom type="box" size=".03 .03 .01"/>
<body name="a" pos=".02 0 .01"><joint name="ja" axis="0 1 0" range="-1 1"/>
<geom type="capsule" size=".01" fromto="0 0 0 0 0 .03" mass=".02"/></body>
<body name="b" pos="-.02 0 .01"><joint name="jb" axis="0 1 0" range="-1 1"/>
<geom type="capsule" size=".01" fromto="0 0 0 0 0 .03" mass=".02"/></body></body></worldbody></mujoco>
"""
URDF = """<robot name="claw"><link name="palm"><inertial><mass value="0.1"/>
<inertia ixx="1e-4" iyy="1e-4" izz="1e-4" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><box size=".06 .06 .02"/></geometry></collision></link>
<link name="a"><inertial><mass value="0.02"/>
<inertia ixx="1e-6" iyy="1e-6" izz="1e-6" ixy="0" ixz="0" iyz="0"/>
</inertial><collision><geometry><sphere radius=".01"/></geometry></collision></link>
<joint name="ja" type="revolute"><parent link="palm"/><child link="a"/><origin xyz=".02 0 .02"/>
<axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>
"""


@dataclass(frozen=True)
class Kind:
    """A kind of input.

    Attributes:
        name: of the file that is damaged.
        good: what it holds.
        words: the command line that reads it; `{}` stands for its path.
        beside: other files that it needs, by name.
        makes: names of files and folders that the command may write.
    """

    name: str
    good: bytes
    words: tuple[str, ...]
    beside: tuple[tuple[str, bytes], ...] = ()
    makes: tuple[str, ...] = ()


def _mesh(suffix: str) -> bytes:
    mesh = load_object("family:box:1").mesh
    data = mesh.export(file_type=suffix)
    return data.encode() if isinstance(data, str) else data


def _proof() -> bytes:
    head = {"holdfast_proof": 3, "holdfast": "0.1.0", "task": "x"}
    form = {
        "lower": [0.0, 0.0, 0.0],
        "upper": [1.0, 1.0, 1.0],
        "rows": [[[0, 1], [1.0, 1.0], 3.0, None], [[2], [1.0], None, 0.5]],
        "products": [[2, 0, 1]],
        "functions": [],
    }
    lines = [{**head}, {"form": form}, {"box": "", "steps": [], "split": [0, 0.5]}, {"box": "0", "steps": []}]
    return gzip.compress(b"".join(json.dumps(line).encode() + b"\n" for line in lines), mtime=0)


def _glb() -> bytes:
    points = np.array([[0, 0, 0], [0.03, 0, 0], [0, 0.03, 0], [0, 0, 0.03]], "<f4").tobytes()
    faces = np.array([0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2], "<u4").tobytes()
    content = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [{"byteLength": len(points) + len(faces)}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": len(points)},
            {"buffer": 0, "byteOffset": len(points), "byteLength": len(faces)},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5125, "count": 12, "type": "SCALAR"},
        ],
    }
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    binary = points + faces
    body = (
        struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    )
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


def _joints() -> dict[str, float]:
    return dict.fromkeys(load_hand("sa").independent_names, 0.2)


def _hold() -> dict[str, object]:
    joints = _joints()
    return {
        "preset": "holdfast",
        "settings": {"slip_limit_m": 0.005, "creep_budget_m_s": 1e-4},
        "held": True,
        "margin": 2.0,
        "directions": [
            {
                "gravity": [0, 0, -9.8],
                "held": True,
                "slip": 1e-4,
                "rotation": 0.01,
                "curve": [[0, 0], [1, 1e-4]],
            }
        ],
        "narrow": True,
        "fingers": [
            {"finger": "index", "slip": 1e-3, "rotation": 0.1, "kept": True},
            {"finger": "thumb", "slip": None, "rotation": None, "kept": False},
        ],
        "squeeze": {
            "targets": joints,
            "efforts": joints,
            "normal_forces": [1.0, 1.0],
            "contact_forces": [[1.0, 0.1, 0.0, 1e-3], [1.0, -0.1, 0.0, -1e-3]],
            "path": [joints, joints],
            "load_factor": 2.0,
            "spin_arms": [3e-3, 3e-3],
            "yields": [1e-4, 1e-4],
            "simulated_forces": [1.1, 0.9],
            "rated_force": 30.0,
            "least": 0.4,
            "rule": "sparing",
        },
    }


def _grasp() -> dict[str, object]:
    joints = _joints()
    contact = {
        "hand": "a",
        "object": "b",
        "point": [0, 0, 0],
        "normal": [0, 0, 1],
        "gap": 0.0,
        "normal_angle": 0,
    }
    return {
        "id": "g01",
        "joints": joints,
        "object": {"position": [0, 0, 0.1], "quaternion": [1, 0, 0, 0]},
        "contacts": [contact, contact],
        "certified": True,
        "certified_radius": 1e-9,
        "residual": 1e-12,
        "clearance": {"before": -1e-3, "after": 0.0, "status": "retracted", "worst_pair": ["a", "b"]},
        "approach": {"reachable": True, "opening": 0.02, "waypoints": [joints]},
        "quality": {"epsilon": 0.1},
        "hold": _hold(),
    }


def _run() -> bytes:
    record = {
        "holdfast": "0.1.0",
        "task": "upholding",
        "task_source": "upholding",
        "task_fingerprint": "0" * 16,
        "hand": "sa",
        "object": "scalpel",
        "seed": 0,
        "settings": {"candidates": 3, "hold.patch_radius_m": 0.005, "hold.friction": None},
        "verdict": "held",
        "complete": True,
        "seconds": {"solve": 1.0},
        "solve": {
            "verdict": "solved",
            "seconds": 1.0,
            "boxes": 3,
            "lps": 2,
            "sigma": 0.1,
            "rounds": [{"seed": 0, "verdict": "solved", "seconds": 1.0, "boxes": 3, "lps": 2, "found": 1}],
        },
        "grasps": [_grasp()],
    }
    return json.dumps(record, indent=1).encode()


def _grasp_file() -> bytes:
    head = {"holdfast": "0.1.0", "task": "upholding", "task_source": "upholding", "hand": "sa"}
    return json.dumps({**_grasp(), **head, "object_name": "scalpel"}).encode()


_PNG = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGP4DwABAQEAWk1v8QAAAABJRU5ErkJggg=="
)


def _checkpoint() -> bytes:
    """Of a search that was left early."""
    problem = system_from_data(SYSTEM, "system")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "state"
        stop = iter([False, False, True])
        solve_system(
            problem.equations,
            problem.lower,
            problem.upper,
            checkpoint=path,
            should_stop=lambda: next(stop, True),
        )
        return path.read_bytes()


_WHOLE_RUN = ("run", "upholding", "--candidates", "1", "--quick", "--workers", "1", "--quiet", "--out", "run")


def _whole_run() -> bytes:
    """The record of a run that came to its end."""
    words = [sys.executable, "-P", "-m", "holdfast.pipeline.cli", *_WHOLE_RUN]
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(words, cwd=folder, check=False, capture_output=True)
        return (Path(folder) / "run" / "run.json").read_bytes()


def _on_mesh(words: tuple[str, ...], makes: str) -> Kind:
    """A command that is given a mesh in the place of an object or a task, with its unit."""
    figures = ("--mass", "0.1", "--friction", "0.6", "--units", "m", "--scale", "1.0", "--quiet")
    return Kind("thing.stl", _mesh("stl"), (*words, *figures), makes=(makes,))


def _fit(suffix: str) -> tuple[str, bytes, tuple[str, ...]]:
    good = _glb() if suffix == "glb" else _mesh(suffix)
    words = ("objects", "fit", "{}", "--at", "0,0,0.02", "--radius", "0.01", "--degree", "2", "--quiet")
    return f"mesh.{suffix}", good, words


def _kinds() -> dict[str, Callable[[], Kind]]:
    beside_task = (("thing.yaml", OBJECT.encode()),)
    beside_hand = (("claw.xml", MJCF.encode()),)
    picture = ("--out", "shown.png", "--quiet")
    little = ("--contacts", "2", "--budget", "2")
    system = ("system", "{}", "--budget", "0.3", "--workers", "1", "--quiet")
    return {
        "task": lambda: Kind("mine.yaml", TASK.encode(), ("tasks", "{}"), beside_task),
        "object": lambda: Kind("thing.yaml", OBJECT.encode(), ("objects", "{}")),
        "built hand": lambda: Kind("sa.yaml", (ROOT / "hands/data/sa.yaml").read_bytes(), ("hands", "{}")),
        "imported hand": lambda: Kind(
            "claw.yaml", HAND.encode(), ("hands", "{}"), (("claw.xml", MJCF.encode()),)
        ),
        "mjcf": lambda: Kind(
            "claw.xml", MJCF.encode(), ("hands", "claw.yaml"), (("claw.yaml", HAND.encode()),)
        ),
        "urdf": lambda: Kind(
            "claw.xml", URDF.encode(), ("hands", "claw.yaml"), (("claw.yaml", HAND.encode()),)
        ),
        **{suffix: lambda s=suffix: Kind(*_fit(s)) for suffix in ("obj", "stl", "ply", "off", "glb")},
        "system": lambda: Kind("system.json", json.dumps(SYSTEM).encode(), system),
        "grasp": lambda: Kind("grasp.json", _grasp_file(), ("clear", "{}")),
        "run": lambda: Kind("run/run.json", _run(), ("report", "run"), (("run/media/g01_front.png", _PNG),)),
        "picture": lambda: Kind(
            "run/media/g01_front.png", _PNG, ("report", "run"), (("run/run.json", _run()),)
        ),
        "proof": lambda: Kind("proof.log", _proof(), ("check-proof", "{}")),
        "checkpoint": lambda: Kind(
            "state.ckpt",
            _checkpoint(),
            (*system[:1], "system.json", *system[2:], "--checkpoint", "{}", "--resume"),
            (("system.json", json.dumps(SYSTEM).encode()),),
        ),
        "mesh object": lambda: Kind(
            "cast.yaml", MESH_OBJECT.encode(), ("objects", "{}"), (("cast.stl", _mesh("stl")),)
        ),
        "mesh of an object": lambda: Kind(
            "cast.stl", _mesh("stl"), ("objects", "cast.yaml"), (("cast.yaml", MESH_OBJECT.encode()),)
        ),
        "shown object": lambda: Kind(
            "thing.yaml", OBJECT.encode(), ("show", "{}", *picture), makes=("shown.png",)
        ),
        "shown hand": lambda: Kind(
            "claw.yaml", HAND.encode(), ("show", "{}", *picture), beside_hand, ("shown.png",)
        ),
        "shown task": lambda: Kind(
            "mine.yaml", TASK.encode(), ("show", "{}", *picture), beside_task, ("shown.png",)
        ),
        "shown grasp": lambda: Kind(
            "grasp.json", _grasp_file(), ("show", "{}", *picture), makes=("shown.png",)
        ),
        "edited task": lambda: Kind("mine.yaml", TASK.encode(), ("edit", "{}", "--port", "0"), beside_task),
        "edited mesh": lambda: _on_mesh(("edit", "{}", "--port", "0"), ""),
        "new hand": lambda: Kind(
            "claw.xml",
            MJCF.encode(),
            ("hands", "new", "new.yaml", "--model", "claw.xml"),
            makes=("new.yaml",),
        ),
        "suggested mesh": lambda: _on_mesh(("suggest", "{}", *little, "--out", "tasks"), "tasks"),
        "run mesh": lambda: _on_mesh(
            ("run", "{}", "--quick", "--candidates", "1", "--workers", "1", *little, "--out", "run"), "run"
        ),
        "run task": lambda: Kind(
            "mine.yaml",
            TASK.encode(),
            ("run", "{}", "--quick", "--candidates", "1", "--workers", "1", "--budget", "2", "--quiet",
             "--out", "run"),
            beside_task,
            ("run",),
        ),
        "resumed run": lambda: Kind(
            "run/run.json", _whole_run(), (*_WHOLE_RUN, "--budget", "2", "--resume"), makes=("run",)
        ),
    }  # fmt: skip


KINDS = _kinds()
"""Makers of the kinds, by name."""
