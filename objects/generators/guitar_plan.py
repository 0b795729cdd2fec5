"""Dimensions of a guitar: those of the benchmark's oversize one, and of a classical guitar of real size."""

from dataclasses import dataclass

import numpy as np

from ...base.numeric.arrays import Array

__all__ = ["BENCHMARK", "REAL", "GuitarPlan"]


@dataclass(frozen=True)
class GuitarPlan:
    """What a guitar measures, in m and rad. x runs from tail to head, y to the bass side, z out of the top.

    Attributes:
        centre_y: y of the plane of symmetry.
        back_z: z of the flat back.
        top_z: z of the soundboard.
        board_z: z of the fingerboard's face.
        board_thickness: of the fingerboard.
        stations: x of the tail, of the widest place of the lower bout, the waist and the upper bout, and of
            the joint of body and neck.
        half_widths: half-widths of the body at the middle three of these.
        board_x: x at which the fingerboard begins, above the body.
        nut_x: x of the nut.
        scale: length of the free strings.
        neck_half_widths: of the fingerboard at the joint and at the nut.
        neck_depths: from the fingerboard's face to the back of the neck, at the joint and at the nut.
        heel_length: how far the heel reaches along the neck.
        string_spread: distance of the outer strings at the nut and at the bridge.
        string_z: z of the strings' axes at the nut and at the bridge.
        string_radii: of strings 1 to 6, the high e first.
        head_x: x at which the flat head begins, and of its end.
        head_half_width: of the head's plate.
        head_thickness: of the head's plate.
        key_first: x and z of the axis of the keys next to the nut.
        key_slope: fall of the head per length, dz = -slope dx.
        key_pitch: distance of neighbouring keys in x.
        key_reach: distance of the paddles' middle from the plane of symmetry.
        key_half: half of a paddle's length, width and thickness at its middle.
        key_bulge: how much thinner each face is at the ends of a paddle, along its length and its width.
        hole: x of the middle of the sound hole, and its radius.
        bridge_half: half of the bridge's length along x and y.
    """

    centre_y: float
    back_z: float
    top_z: float
    board_z: float
    board_thickness: float
    stations: tuple[float, float, float, float, float]
    half_widths: tuple[float, float, float]
    board_x: float
    nut_x: float
    scale: float
    neck_half_widths: tuple[float, float]
    neck_depths: tuple[float, float]
    heel_length: float
    string_spread: tuple[float, float]
    string_z: tuple[float, float]
    string_radii: tuple[float, float, float, float, float, float]
    head_x: tuple[float, float]
    head_half_width: float
    head_thickness: float
    key_first: tuple[float, float]
    key_slope: float
    key_pitch: float
    key_reach: float
    key_half: tuple[float, float, float]
    key_bulge: tuple[float, float]
    hole: tuple[float, float]
    bridge_half: tuple[float, float]

    @property
    def joint_x(self) -> float:
        """Where the neck meets the body."""
        return self.stations[-1]

    @property
    def bridge_x(self) -> float:
        """Where the saddle is, at which the free strings end."""
        return self.nut_x - self.scale

    def fret_x(self, number: int) -> float:
        """Where a fret is along x, in equal temperament; the nut is fret 0."""
        return float(self.nut_x - self.scale * (1.0 - 2.0 ** (-number / 12.0)))

    @property
    def frets(self) -> int:
        """How many frets the fingerboard has."""
        return next(n for n in range(1, 40) if self.fret_x(n + 1) < self.board_x + 0.004)

    def neck_half_width(self, x: float) -> float:
        """Half-width of the fingerboard, which tapers all along."""
        return self._along_neck(x, self.neck_half_widths)

    def neck_depth(self, x: float) -> float:
        """From the face of the fingerboard to the back of the neck."""
        return self._along_neck(x, self.neck_depths)

    def _along_neck(self, x: float, ends: tuple[float, float]) -> float:
        share = (x - self.joint_x) / (self.nut_x - self.joint_x)
        return (1.0 - share) * ends[0] + share * ends[1]

    def string_point(self, string: int, x: float) -> Array:
        """Point (3,) of the axis of a string; string 1 is the high e, on the side of low y."""
        share = (self.nut_x - x) / self.scale
        spread = (1.0 - share) * self.string_spread[0] + share * self.string_spread[1]
        z = (1.0 - share) * self.string_z[0] + share * self.string_z[1]
        return np.array([x, self.centre_y + spread * (string - 3.5) / 5.0, z])

    def head_z(self, x: float) -> float:
        """Height of the middle of the head's plate, in which the keys' axes lie."""
        return self.key_first[1] - self.key_slope * (x - self.key_first[0])


BENCHMARK = GuitarPlan(
    centre_y=0.220,
    back_z=0.025,
    top_z=0.125,
    board_z=0.136,
    board_thickness=0.007,
    stations=(0.037, 0.240, 0.480, 0.600, 0.700),
    half_widths=(0.233, 0.1285, 0.161),
    board_x=0.600,
    nut_x=1.260,
    scale=1.008,
    neck_half_widths=(0.0355, 0.0315),
    neck_depths=(0.031, 0.027),
    heel_length=0.075,
    string_spread=(0.052, 0.086),
    string_z=(0.1382, 0.1472),
    string_radii=(0.0006, 0.0007, 0.0008, 0.0006, 0.0007, 0.0008),
    head_x=(1.300, 1.462),
    head_half_width=0.049,
    head_thickness=0.020,
    key_first=(1.327323, 0.093881),
    key_slope=0.144748,
    key_pitch=0.052,
    key_reach=0.0718065,
    key_half=(0.0170, 0.0090, 0.002052),
    key_bulge=(0.0004, 0.0003),
    hole=(0.530, 0.062),
    bridge_half=(0.020, 0.120),
)
"""Bounding box and widths as measured on the benchmark's body. The published patches of the tuning key touch
the faces of key 3 in the middle; the scale puts the neck's joint at the 14th fret."""

REAL = GuitarPlan(
    centre_y=0.0,
    back_z=-0.100,
    top_z=0.0,
    board_z=0.0085,
    board_thickness=0.0065,
    stations=(0.0, 0.140, 0.300, 0.395, 0.485),
    half_widths=(0.185, 0.1175, 0.140),
    board_x=0.392,
    nut_x=0.810,
    scale=0.650,
    neck_half_widths=(0.031, 0.026),
    neck_depths=(0.0275, 0.0275),
    heel_length=0.060,
    string_spread=(0.043, 0.058),
    string_z=(0.0106, 0.0136),
    string_radii=(0.00036, 0.00041, 0.00051, 0.00037, 0.00045, 0.00055),
    head_x=(0.835, 0.985),
    head_half_width=0.036,
    head_thickness=0.020,
    key_first=(0.862, -0.022),
    key_slope=0.2493,
    key_pitch=0.0395,
    key_reach=0.053,
    key_half=(0.0110, 0.0085, 0.0025),
    key_bulge=(0.0005, 0.0004),
    hole=(0.330, 0.043),
    bridge_half=(0.014, 0.092),
)
"""A classical guitar: scale 650 mm, nut 52 mm, joint at the 12th fret, head leaning back by 14 degrees."""
