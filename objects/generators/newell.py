"""Newell's teapot: its bicubic Bezier patches, in the frame and at the scale of the benchmark."""

from functools import cache
from importlib.resources import files
from pathlib import Path

import numpy as np

from ...base.files.json_file import read_json
from ...base.numeric.arrays import Array
from ...geometry import BezierPatch

__all__ = ["FOOT_M", "teapot_surfaces"]


# One of Newell's units, and the height of the pot's foot in units: the benchmark's teapot stands on y = 0.
# Its height of 136.5 mm is 3 units, so that it has a flat base there and not the bulge that was added later.
_UNIT_M = 0.0455
_FOOT_UNITS = 0.15
FOOT_M = 1.5 * _UNIT_M
"""Radius of the foot that the pot stands on."""

_QUARTERS = {"rim": "rim", "belly_upper": "belly", "belly_lower": "belly", "knob": "knob", "lid": "lid"}
_HALVES = {"handle_upper": "handle", "handle_lower": "handle", "spout": "spout", "spout_lip": "spout"}


@cache
def teapot_surfaces() -> dict[str, BezierPatch]:
    """The 32 patches by name, in m, y up, the spout along +x; outward normals p_u x p_v.

    `rim_0..3`, `belly_0..7` (the upper four first), `knob_0..3`, `lid_0..3` and the flat `base_0..3` are
    quarters: u runs about the y axis, in the first from +x (0) to +z (1) and so on; v runs down the profile.
    `handle_0..3` and `spout_0..3` are halves: u runs across from the inner or upper side to the other on the
    +z side (even numbers), and back on the -z side (odd numbers), v along them, from the upper end of the
    handle and from the belly to the lip.
    """
    data = read_json(Path(str(files(__package__))) / "data" / "newell_teapot.json")
    nets: dict[str, list[Array]] = {}
    for part, name in _QUARTERS.items():
        net = _place(np.array(data["quarters"][part]))
        nets.setdefault(name, []).extend(_turn(net, k) for k in range(4))
    for part, name in _HALVES.items():
        net = _place(np.array(data["halves"][part]))
        # Mirrored and run through backwards, so that the normal stays outside.
        nets.setdefault(name, []).extend([net, (net * [1.0, 1.0, -1.0])[::-1]])
    nets["base"] = [_turn(_base(), k) for k in range(4)]
    return {
        f"{name}_{i}": BezierPatch(net) for name, several in nets.items() for i, net in enumerate(several)
    }


def _place(net: Array) -> Array:
    """Newell's net (rows along the profile) in the benchmark's frame, its first axis across the profile."""
    x, y, z = np.moveaxis(net, -1, 0)
    return _UNIT_M * np.stack([x, z - _FOOT_UNITS, -y], axis=-1).transpose(1, 0, 2)


def _turn(net: Array, quarters: int) -> Array:
    """The net turned about y from +x towards +z; exact, as the patches of a quarter are."""
    for _ in range(quarters):
        x, y, z = np.moveaxis(net, -1, 0)
        net = np.stack([-z, y, x], axis=-1)
    return net


def _base() -> Array:
    """A quarter of the flat base, from the foot's circle (Newell's) to the middle."""
    circle = np.array([(1.0, 0.0), (1.0, 0.56), (0.56, 1.0), (0.0, 1.0)])
    radius = FOOT_M * np.array([1.0, 2.0 / 3.0, 1.0 / 3.0, 0.0])
    net = np.zeros((4, 4, 3))
    net[..., 0::2] = circle[:, None, :] * radius[None, :, None]
    return net
