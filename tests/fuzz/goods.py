"""Good inputs of every kind that a command reads."""

import base64
import json
import struct
import subprocess
import sys
import tempfile
from functools import cache
from pathlib import Path

import holdfast as hf
import numpy as np
from holdfast.objects import load_object
from holdfast.pipeline.records import GraspRecord
from holdfast.solver import solve_system
from holdfast.solver.systems import system_from_data

from ..check_proof.logs import circle, search

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


def mesh(suffix: str) -> bytes:
    data = load_object("family:box:1").mesh.export(file_type=suffix)
    return data.encode() if isinstance(data, str) else data


@cache
def proof() -> bytes:
    """That a system of two equations has no solution."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "proof.log"
        assert search(circle(13 / 32 + 0.01), path)
        return path.read_bytes()


def glb() -> bytes:
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


@cache
def grasp_file() -> bytes:
    """Of a grasp that was found, made and held, so that whatever reads it goes to the end."""
    made = hf.make_grasp(hf.solve(hf.load_task("upholding"), candidates=1)[0])
    assert isinstance(made, hf.Grasp), made
    with tempfile.TemporaryDirectory() as folder:
        return made.save(Path(folder) / "g01.json", hf.hold(made)).read_bytes()


def run_record() -> bytes:
    """Of a run with one grasp, narrowly held."""
    made = json.loads(grasp_file())
    fingers = [
        {"finger": "index", "slip": 1e-3, "rotation": 0.1, "kept": True},
        {"finger": "thumb", "slip": None, "rotation": None, "kept": False},
    ]
    grasp = {key: made[key] for key in GraspRecord.model_fields if key in made}
    grasp["hold"] |= {"narrow": True, "fingers": fingers}
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
        "grasps": [grasp],
    }
    return json.dumps(record, indent=1).encode()


PICTURE = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGP4DwABAQEAWk1v8QAAAABJRU5ErkJggg=="
)


@cache
def checkpoint() -> bytes:
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


WHOLE_RUN = ("run", "upholding", "--candidates", "1", "--quick", "--workers", "1", "--quiet", "--out", "run")


@cache
def whole_run() -> bytes:
    """The record of a run that came to its end."""
    words = [sys.executable, "-P", "-m", "holdfast", *WHOLE_RUN]
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(words, cwd=folder, check=False, capture_output=True)
        return (Path(folder) / "run" / "run.json").read_bytes()
