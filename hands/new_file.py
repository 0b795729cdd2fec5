"""New hand files to edit: around a model with its regions found, copies of others, or a small example."""

from pathlib import Path
from typing import Any

import numpy as np
import yaml

from ..base.files.fields import plain_name
from ..base.files.file_model import parse
from ..base.files.file_paths import real_path
from ..base.files.input_file import read_text
from ..base.files.library import FILE_SUFFIXES
from ..base.files.yaml_file import read_yaml
from ..base.numeric.arrays import Array
from ..errors import InputError
from ..geometry import invert, region_fields
from .hand import Hand
from .library import hand_file
from .pad_file import PadSpec
from .placed import placed_region

__all__ = ["new_hand_file"]

_DIGITS = 9
_LARGEST_BYTES = 4 * 1024 * 1024
_EXAMPLE = """\
# A hand of two fingers and a thumb, to edit. Lengths in metres, angles in degrees, masses in kilograms.
# Palm frame: +z along the fingers, +x out of the palm, +y towards the index finger.
name: {name}
description: A thumb and two fingers
{mirror}palm:
  mass: 0.4
  # Shapes are sphere, capsule, box or hull, in the palm frame.
  shapes: [{{box: {{centre: [-0.012, 0, 0.045], half_extents: [0.012, 0.03, 0.045]}}}}]
density: 1500.0  # of the fingers, kg/m^3
# Servo of every joint: effort in N m, stiffness in N m/rad, damping in N m s/rad, armature in kg m^2.
actuator: {{effort: 3.0, stiffness: 30.0, damping: 0.4, armature: 0.002}}
fingers:
  index:
    structure: U(RR)  # joints from the palm to the tip: R revolute, U universal; (..) turn together
    position: [-0.01, 0.014, 0.094]  # of the first joint
    lengths: [0.045, 0.028, 0.025]  # from each joint to the next, the last one to the tip
    radius: 0.0095
  middle:
    structure: U(RR)
    position: [-0.01, -0.014, 0.094]
    lengths: [0.045, 0.028, 0.025]
    radius: 0.0095
  thumb:
    structure: URR
    position: [0.004, 0, 0.015]
    x_axis: [0.8, 0, 0.6]  # along the straight finger
    y_axis: [0, 1, 0]  # lateral; z = x cross y looks out of the pad
    lengths: [0.045, 0.034, 0.028]
    radius: 0.0095
    joints:
      - {{joint: 1, limits_deg: [[-35, 35], [-15, 75]]}}  # abduction and flexion of the first joint
# Every finger has the regions <finger>/tip and <finger>/pad; more can be added, each a cap, a bezier patch
# or a point with its normal, in the frame of its link.
regions:
  palm/centre:
    link: palm
    bezier:
      - [[0, 0.015, 0.04], [0, -0.015, 0.04]]
      - [[0, 0.015, 0.07], [0, -0.015, 0.07]]
"""


def new_hand_file(path: Path, model: str | None = None, *, mirror: bool = False) -> str:
    """The text of a hand file that is to be written at `path`.

    Args:
        path: of the hand file; its stem becomes the hand's name.
        model: an MJCF or URDF model in or below the folder of the file, or the name or file of a hand that is
            copied; None for a small example.
        mirror: whether the hand is the mirror image of that.

    Raises:
        InputError: a model that can't be imported from there, or no such hand.
    """
    if model is None:
        return _EXAMPLE.format(name=_name(path), mirror="mirror: true\n" if mirror else "")
    source = hand_file(model)
    if source.suffix.lower() in FILE_SUFFIXES:
        return _copy(source, path, mirror=mirror)
    return _around(source, path, mirror=mirror)


def _name(path: Path) -> str:
    return plain_name(path.stem, "hand")


def _copy(source: Path, path: Path, *, mirror: bool) -> str:
    """The text of another hand file, under a new name."""
    data = read_yaml(source)
    if "import" in data and real_path(source).parent != real_path(path).parent:
        raise InputError(path, "import", f"names files beside {source}: the copy must lie in the same folder")
    lines = read_text(source, _LARGEST_BYTES).splitlines()
    named = next((i for i, line in enumerate(lines) if line.startswith("name:")), None)
    head = [] if named is None else [f"name: {_name(path)}"]
    if bool(data.get("mirror")) != mirror:
        head.append("mirror: true")
    before, behind = (_without_head(part) for part in (lines[: named or 0], lines[named or 0 :]))
    return "\n".join([*before, *head, *behind]) + "\n"


def _without_head(lines: list[str]) -> list[str]:
    return [line for line in lines if not line.startswith(("name:", "mirror:"))]


def _around(model: Path, path: Path, *, mirror: bool) -> str:
    from .models import ImportedHandFile, import_model

    folder, target = real_path(path).parent, real_path(model)
    if not target.is_relative_to(folder):
        raise InputError(
            path,
            "import",
            f"{model} must lie in or below the folder of the hand file: write that file above it",
        )
    name = target.relative_to(folder).as_posix()
    spec = parse(ImportedHandFile, {"name": _name(path), "import": name}, path)
    hand, palm, frames = import_model(spec, path, folder)
    described = {
        key: {
            "link": hand.links[entry.link].name,
            **region_fields(placed_region(entry.region, _body_frame(frames, hand.links[entry.link].name))),
        }
        for key, entry in hand.regions.items()
    }
    head = {"name": hand.name, "import": name, "palm": palm}
    return _text(hand, head, described, mirror=mirror)


def _body_frame(frames: dict[str, Array], link: str) -> Array:
    """T_body_link (4, 4): regions in a file are given in the frame of the model's body."""
    return invert(frames[link])


def _text(hand: Hand, head: dict[str, Any], regions: dict[str, Any], *, mirror: bool) -> str:
    limits = {axis.name: [round(axis.lower, 6), round(axis.upper, 6)] for axis in hand.axes}
    coupled = {
        axis.name: {"to": axis.coupling.master, "ratio": axis.coupling.ratio, "offset": axis.coupling.offset}
        for axis in hand.axes
        if axis.coupling is not None
    }
    servos = {
        axis.name: {key: float(f"{value:.4g}") for key, value in vars(axis.actuator).items()}
        for axis in hand.axes
        if axis.actuator is not None
    }
    parts = [
        "# A hand file around a model, to edit. Lengths in metres, angles in radians unless named otherwise,",
        "# masses in kilograms. Lines that begin with # may be taken in: they show what holds without them.",
        yaml.safe_dump(head, sort_keys=False).rstrip(),
        "# Whether the hand is the mirror image of the model, in the plane y = 0 of the palm frame.",
        f"mirror: {'true' if mirror else 'false'}",
        "# The palm frame in the frame of the palm's body.",
        "# palm_frame: {position: [0, 0, 0], x_axis: [1, 0, 0], y_axis: [0, 1, 0]}",
        "# New names of bodies and joints.",
        "# link_names: {body_of_the_model: index_1}",
        "# joint_names: {joint_of_the_model: index_flexion}",
        "# Pads: elastic modulus in Pa, depth of the soft layer in m; the force in N that a fingertip is",
        "# rated for, and the largest that a contact may be asked to press with.",
        _commented({"pad": PadSpec().model_dump()}),
        "# rated_force: 30.0",
        "# max_normal_force: 30.0",
        "# Limits, rad (m for slides).",
        _commented({"limits": limits}),
        "# Joints that follow another: position = ratio * position of the other + offset.",
        _commented({"coupled": coupled or {"joint": {"to": "other_joint", "ratio": 1.0, "offset": 0.0}}}),
        "# Servos: effort N m, stiffness N m/rad, damping N m s/rad, armature kg m^2 (N, N/m, N s/m, kg).",
        _dump({"actuators": servos}).rstrip(),
        "# Contact regions: a cap, a bezier patch (outward normal p_u x p_v) or a point with its normal, in",
        "# the frame of the body `link`. These were found from what faces what when the hand closes.",
        _dump({"regions": regions}).rstrip(),
    ]
    notes = [f"# On import: {note}" for note in hand.notes]
    return "\n".join([*parts[:2], *notes, *parts[2:]]) + "\n"


def _dump(data: dict[str, Any]) -> str:
    return str(
        yaml.safe_dump(
            _rounded(data), sort_keys=False, allow_unicode=True, width=110, default_flow_style=None
        )
    )


def _commented(data: dict[str, Any]) -> str:
    return "\n".join(f"# {line}" for line in _dump(data).splitlines())


def _rounded(value: Any) -> Any:
    match value:
        case dict():
            return {key: _rounded(entry) for key, entry in value.items()}
        case list():
            return [_rounded(entry) for entry in value]
        case float():
            return float(np.round(value, _DIGITS)) + 0.0
        case _:
            return value
