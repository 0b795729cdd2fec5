"""Parallel jaws with flat pads, things for them to hold, and tasks of the two; what `flats` measures with.

Everything is written as files, as a user would, and read back. The published Franka gripper and Robotiq
2F-140 are imported from a folder `models`, which is not part of this repository.
"""

import json
from collections.abc import Iterable
from math import cos, pi, radians, sin, tan
from pathlib import Path
from shutil import copytree
from typing import Any

import numpy as np
import trimesh
from holdfast.hands import Hand, load_hand
from holdfast.objects import ObjectModel, Task, load_object

__all__ = ["OBJECTS", "PUBLIC", "jaw", "jaw_task", "public_hand", "thing"]

_HALF = 0.01  # of a pad, both ways
_REACH = 0.09  # of the pads' middles from the palm
_OPEN = 0.045
_ARC = radians(30.0)
PUBLIC = ("franka", "robotiq")


def jaw(folder: Path, *, tilt_deg: float = 0.0, free: bool = False) -> Hand:
    """A gripper whose jaws slide, coupled unless `free`; the right pad is turned by `tilt_deg` about y."""
    half = [_HALF / 2, _HALF, 0.035]
    links = [
        {
            "name": "base",
            "mass": 0.5,
            "shapes": [{"box": {"centre": [0, 0, 0], "half_extents": [0.06, 0.02, 0.02]}}],
        }
    ]
    joints, regions = [], {}
    for name, side in (("left", -1.0), ("right", 1.0)):
        box = {"centre": [side * _HALF / 2, 0, 0.065], "half_extents": half}
        links.append({"name": name, "mass": 0.05, "shapes": [{"box": box}]})
        limits = sorted([side * 5e-4, side * _OPEN])
        axis: dict[str, Any] = {"name": f"{name}_slide", "direction": [1, 0, 0], "limits": limits}
        if name == "right" and not free:
            axis["coupled"] = {"to": "left_slide", "ratio": -1.0, "offset": 0.0}
        else:
            axis["actuator"] = "jaw"
        joints.append(
            {"type": "prismatic", "parent": "base", "child": name, "position": [0, 0, 0], "axes": [axis]}
        )
        regions[f"{name}/pad"] = {"link": name, "bezier": _pad(side, tilt_deg if side > 0 else 0.0)}
    servo = {"effort": 40.0, "stiffness": 2000.0, "damping": 20.0, "armature": 0.01}
    spec = {"name": "jaw", "palm": "base", "links": links, "joints": joints, "actuators": {"jaw": servo}}
    return load_hand(_write(folder / "jaw.yaml", {**spec, "regions": regions}))


def _pad(side: float, tilt_deg: float) -> list[Any]:
    """A square that faces the other jaw."""
    s, c = sin(radians(tilt_deg)), cos(radians(tilt_deg))
    rows = [[[0.0, y, z] for z in (-_HALF, _HALF)] for y in (-_HALF, _HALF)]
    if side > 0:
        rows = rows[::-1]
    return [[[c * x + s * z, y, -s * x + c * z + _REACH] for x, y, z in row] for row in rows]


def public_hand(name: str, models: Path, folder: Path) -> Hand:
    """A published gripper with its pads as regions; its model is copied beside the hand file.

    Raises:
        FileNotFoundError: the model is not in that folder.
    """
    model, assets = {"franka": ("panda", "panda"), "robotiq": ("robotiq2f140", "robotiq2")}[name]
    copytree(models / model, folder / name, dirs_exist_ok=True)
    inner = f"graspqp/assets/{assets}/"
    if name == "franka":
        # The convex hull of a finger is flat to 0.05 mm here.
        x, y, low, high = -5e-5, 0.008, 0.038, 0.052
        pad = [[[x, y, low], [x, y, high]], [[x, -y, low], [x, -y, high]]]
        spec: dict[str, Any] = {
            "import": inner + "franka_panda.urdf",
            "palm": "panda_hand",
            "actuator": {"effort": 70.0, "stiffness": 5000.0, "damping": 50.0, "armature": 0.01},
            "coupled": {"panda_finger_joint2": {"to": "panda_finger_joint1", "ratio": 1.0}},
        }
        bodies = {"left": "panda_leftfinger", "right": "panda_rightfinger"}
    else:
        x, y, z = -0.00375, 0.0293, 0.0121
        pad = [[[x, -y, -z], [x, y, -z]], [[x, -y, z], [x, y, z]]]
        # The four-bar linkage keeps the pads upright; the model has its joints without what ties them.
        ratios = {"left_inner_finger": 1.0, "right_outer_knuckle": -1.0, "right_inner_finger": 1.0}
        ratios |= {"left_inner_knuckle": -1.0, "right_inner_knuckle": -1.0}
        spec = {
            "import": inner + "robotiq_2f140.urdf",
            "palm": "robotiq_arg2f_base_link",
            "actuator": {"effort": 10.0, "stiffness": 200.0, "damping": 2.0, "armature": 0.01},
            "coupled": {f"{k}_joint": {"to": "finger_joint", "ratio": r} for k, r in ratios.items()},
        }
        bodies = {side: f"{side}_inner_finger_pad" for side in ("left", "right")}
    regions = {f"{side}/pad": {"link": body, "bezier": pad} for side, body in bodies.items()}
    return load_hand(_write(folder / name / f"{name}.yaml", {"name": name, **spec, "regions": regions}))


def _revolved(profile: Iterable[tuple[float, float]], start: float, end: float) -> list[Any]:
    """A patch that turns a straight or curved profile of (radius, height) about z; it faces outwards."""
    k = 4.0 / 3.0 * tan((end - start) / 4.0)
    first, last = np.array([cos(start), sin(start)]), np.array([cos(end), sin(end)])
    arc = [first, first + k * np.array([-first[1], first[0]]), last - k * np.array([-last[1], last[0]]), last]
    return [[[float(r * p[0]), float(r * p[1]), float(z)] for r, z in profile] for p in arc]


def _both(profile: list[tuple[float, float]]) -> dict[str, Any]:
    return {
        "front": {"bezier": _revolved(profile, -_ARC, _ARC)},
        "back": {"bezier": _revolved(profile, pi - _ARC, pi + _ARC)},
    }


def _slab(half: tuple[float, float, float], y: float, z: float) -> dict[str, Any]:
    x = half[0]
    front = [[[x, -y, -z], [x, -y, z]], [[x, y, -z], [x, y, z]]]
    back = [[[-x, y, -z], [-x, y, z]], [[-x, -y, -z], [-x, -y, z]]]
    return {
        "box": {"half_extents": list(half)},
        "regions": {"front": {"bezier": front}, "back": {"bezier": back}},
    }


def _round(radius: float, half: float, profile: list[tuple[float, float]]) -> dict[str, Any]:
    return {"cylinder": {"radius": radius, "length": 2.0 * half}, "regions": _both(profile)}


def _tin() -> dict[str, Any]:
    q, z = 0.015, 0.02
    front = [[[-q, -q, z], [-q, q, z]], [[q, -q, z], [q, q, z]]]
    back = [[[-q, q, -z], [-q, -q, -z]], [[q, q, -z], [q, -q, -z]]]
    regions = {"front": {"bezier": front}, "back": {"bezier": back}}
    return {"cylinder": {"radius": 0.035, "length": 2.0 * z}, "regions": regions}


def _cone(half_angle_deg: float) -> dict[str, Any]:
    """A frustum 60 mm high and 50 mm wide halfway up, with regions at middle height."""
    t, middle, half = tan(radians(half_angle_deg)), 0.025, 0.03
    inner = 0.02
    profile = [(middle + inner * t, -inner), (middle - inner * t, inner)]
    low, high = middle + half * t, middle - half * t
    outline = [(0.0, -half), (low, -half), (high, half), (0.0, half)]
    return {"profile": outline, "regions": _both(profile)}


def _rim() -> dict[str, Any]:
    """The wall of a mug, 4 mm thick, just below its rim."""
    inner = np.array(_revolved([(0.036, 0.0), (0.036, 0.04)], -_ARC, _ARC))[::-1].tolist()
    outer = _revolved([(0.04, 0.0), (0.04, 0.04)], -_ARC, _ARC)
    regions = {"front": {"bezier": outer}, "back": {"bezier": inner}}
    return {
        "profile": [(0.036, -0.05), (0.04, -0.05), (0.04, 0.05), (0.036, 0.05), (0.036, -0.05)],
        "regions": regions,
    }


OBJECTS: dict[str, dict[str, Any]] = {
    "box": _slab((0.01, 0.05, 0.01), 0.02, 0.008),
    "sheet": _slab((0.001, 0.05, 0.05), 0.04, 0.04),
    "tin ends": _tin(),
    "can": _round(0.033, 0.06, [(0.033, -0.03), (0.033, 0.03)]),
    "wide can": _round(0.0459, 0.06, [(0.0459, -0.03), (0.0459, 0.03)]),
    "rim": _rim(),
    "cone": _cone(10.0),
    "taper": _cone(0.4),
}


def thing(name: str, folder: Path) -> ObjectModel:
    """One of `OBJECTS`, of 100 g and with a friction of 0.6."""
    spec = dict(OBJECTS[name])
    plain = name.replace(" ", "_")
    folder.mkdir(parents=True, exist_ok=True)
    if "profile" in spec:
        turned = trimesh.creation.revolve(np.array(spec.pop("profile")), sections=96)
        turned.export(folder / f"{plain}.stl")
        spec["mesh"] = f"{plain}.stl"
    return load_object(
        _write(folder / f"{plain}.yaml", {"name": plain, "mass": 0.1, "friction": 0.6, **spec})
    )


def jaw_task(hand: Hand, obj: ObjectModel, align_within_deg: float | None = None) -> Task:
    """The left pad on the front, the right pad on the back."""
    pairs = [("left/pad", "front"), ("right/pad", "back")]
    return Task(hand=hand, object=obj, contacts=pairs, align_within_deg=align_within_deg)


def _write(path: Path, spec: dict[str, Any]) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(spec), "utf-8")  # which is YAML as well
    return path
