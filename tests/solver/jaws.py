"""A gripper with two flat pads, and things for it."""

import json
from math import cos, pi, radians, sin, tan
from pathlib import Path

import numpy as np
from holdfast.hands import Hand, load_hand
from holdfast.objects import ObjectModel, Task, load_object

ARC = radians(30.0)


def jaw(folder: Path, tilt_deg: float = 0.0) -> Hand:
    """Two jaws that slide along x by the same amount, the right pad turned by `tilt_deg` about y."""
    links = [
        {
            "name": "base",
            "mass": 0.5,
            "shapes": [{"box": {"centre": [0, 0, 0], "half_extents": [0.06, 0.02, 0.02]}}],
        }
    ]
    joints, regions = [], {}
    for name, side in (("left", -1.0), ("right", 1.0)):
        box = {"centre": [side * 0.005, 0, 0.065], "half_extents": [0.005, 0.01, 0.035]}
        links.append({"name": name, "mass": 0.05, "shapes": [{"box": box}]})
        axis = {
            "name": f"{name}_slide",
            "direction": [1, 0, 0],
            "limits": sorted([side * 5e-4, side * 0.045]),
        }
        axis |= (
            {"actuator": "jaw"}
            if side < 0
            else {"coupled": {"to": "left_slide", "ratio": -1.0, "offset": 0.0}}
        )
        joints.append(
            {"type": "prismatic", "parent": "base", "child": name, "position": [0, 0, 0], "axes": [axis]}
        )
        s, c = (sin(radians(tilt_deg)), cos(radians(tilt_deg))) if side > 0 else (0.0, 1.0)
        ys = (-side * -0.01, -side * 0.01)
        net = [[[s * z, y, 0.09 + c * z] for z in (-0.01, 0.01)] for y in ys]
        regions[f"{name}/pad"] = {"link": name, "bezier": net}
    servo = {"effort": 40.0, "stiffness": 2000.0, "damping": 20.0, "armature": 0.01}
    spec = {"name": "jaw", "palm": "base", "links": links, "joints": joints, "actuators": {"jaw": servo}}
    return load_hand(_written(folder / "jaw.yaml", {**spec, "regions": regions}))


def block(folder: Path, half_width_m: float = 0.01) -> ObjectModel:
    """A box with patches on the faces +x and -x."""
    x, y, z = half_width_m, 0.02, 0.008
    front = [[[x, -y, -z], [x, -y, z]], [[x, y, -z], [x, y, z]]]
    back = [[[-x, y, -z], [-x, y, z]], [[-x, -y, -z], [-x, -y, z]]]
    shape = {"box": {"half_extents": [x, 0.05, 0.01]}}
    return load_object(_written(folder / "block.yaml", _thing("block", shape, front, back)))


def frustum(folder: Path, half_angle_deg: float = 0.0, radius_m: float = 0.025) -> ObjectModel:
    """A cylinder, or a cone about z, with patches of 60 deg on either side, about its middle height."""
    t = tan(radians(half_angle_deg))
    profile = [(radius_m + 0.02 * t, -0.02), (radius_m - 0.02 * t, 0.02)]
    nets = [revolved(profile, middle - ARC, middle + ARC) for middle in (0.0, pi)]
    shape = {"cylinder": {"radius": radius_m, "length": 0.08}}
    return load_object(_written(folder / "frustum.yaml", _thing("frustum", shape, *nets)))


def revolved(profile, start, end):
    k = 4.0 / 3.0 * tan((end - start) / 4.0)
    first, last = np.array([cos(start), sin(start)]), np.array([cos(end), sin(end)])
    arc = [first, first + k * np.array([-first[1], first[0]]), last - k * np.array([-last[1], last[0]]), last]
    return [[[float(r * p[0]), float(r * p[1]), z] for r, z in profile] for p in arc]


def grip(hand: Hand, obj: ObjectModel, align_within_deg: float | None = None) -> Task:
    """The left pad on the front, the right one on the back."""
    pairs = [("left/pad", "front"), ("right/pad", "back")]
    return Task(hand=hand, object=obj, contacts=pairs, align_within_deg=align_within_deg)


def _thing(name, shape, front, back):
    # The solver looks at regions alone; where they lie is not what is tested.
    regions = {"front": {"bezier": front, "off_surface": True}, "back": {"bezier": back, "off_surface": True}}
    return {"name": name, "mass": 0.1, "friction": 0.6, **shape, "regions": regions}


def _written(path: Path, spec) -> Path:
    path.write_text(json.dumps(spec), "utf-8")
    return path
