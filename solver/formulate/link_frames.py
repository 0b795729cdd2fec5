"""Poses of hand links as polynomials in (cos, sin) of real joint angles and of their sums.

A joint that others follow by small fractions has a pair for its angle divided by their denominator, and
they turn by multiples of that: all stays algebraic. Where some ratio is another number, the joint's angle is
itself the variable, and each joint that it drives has cosine and sine of ratio times that, plus an offset.

Neighbouring joints with parallel axes form a group: within it only sums of angles occur, so a planar
finger costs one (cos, sin) pair a joint and no product. Only where groups of different directions meet
are vectors multiplied.
"""

from dataclasses import dataclass
from fractions import Fraction
from math import lcm

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import axis_rotation, perpendicular
from ...hands import Hand
from ..polynomial import Polynomial, SystemBuilder, Vector, combine, constant_vector, dot
from .angles import LIMIT_ROOM, Angle, Turn, angle_variable, multiple, negated, sum_of, turned

__all__ = ["ChainBuilder", "PolynomialFrame"]

_PARALLEL = 1e-12
# Fractions up to this denominator, and multiples up to this, are polynomials of low degree; decimals of 1/3
# and products of ratios along a chain of couplings round.
_LARGEST_MULTIPLE = 4
_RATIO_ROUNDING = 1e-14


@dataclass
class PolynomialFrame:
    """A link's frame in the palm frame, its last group of parallel joints kept apart.

    Orientation = B Rot(axis, angle) M with B = (A, E1, E2) of the group's base; a point of the link is
    origin + B (axial part, planar part turned by the angle).

    Attributes:
        builder: receives the variables for products.
        name: prefix for them.
        base: columns A, E1, E2 (each 3 polynomials) of the group's base, A along the axis.
        base_origin: where the group begins, in units of length.
        to_axes: (3, 3) rows axis, e1, e2 that express base vectors in (A, E1, E2).
        turned: M (3, 3), the constant rotation after the group's angle.
        angle: the group's sum of angles, None before its first joint.
        axial: constant part of the origin along A.
        planar: parts of the origin along E1 and E2.
    """

    builder: SystemBuilder
    name: str
    base: list[Vector]
    base_origin: Vector
    to_axes: Array
    turned: Array
    angle: Angle | None
    axial: float
    planar: tuple[Polynomial, Polynomial]

    def point(self, p: Array) -> Vector:
        """Palm coordinates of the point `p` (3,) fixed in the link."""
        along, x, y = self._turned_parts(self.turned @ p)
        return self._compose(
            "point", self.axial + along, self.planar[0] + x, self.planar[1] + y, self.base_origin
        )

    def direction(self, d: Array) -> Vector:
        """Palm coordinates of the direction `d` (3,) fixed in the link."""
        along, x, y = self._turned_parts(self.turned @ d)
        return self._compose("direction", along, x, y, constant_vector(np.zeros(3)))

    def _turned_parts(self, v: Array) -> tuple[float, Polynomial, Polynomial]:
        along, x, y = self.to_axes @ v
        if self.angle is None:
            return float(along), Polynomial.constant(x), Polynomial.constant(y)
        c, s = self.angle.cos, self.angle.sin
        return float(along), c * float(x) - s * float(y), s * float(x) + c * float(y)

    def _compose(self, what: str, along: float, x: Polynomial, y: Polynomial, start: Vector) -> Vector:
        A, E1, E2 = self.base
        name = f"{self.name} {what}"
        return [
            start[i]
            + A[i] * along
            + self.builder.product(f"{name} x{i}", E1[i], x)
            + self.builder.product(f"{name} y{i}", E2[i], y)
            for i in range(3)
        ]

    def as_variables(self) -> tuple[list[Vector], Vector]:
        """Columns and origin of the frame as linear forms, for what comes after the group."""
        columns = [self.direction(e) for e in np.eye(3)]
        forms = [
            [self.builder.form(f"{self.name} R{i}{j}", column[i]) for i in range(3)]
            for j, column in enumerate(columns)
        ]
        _imply_rotation(self.builder, forms)
        origin = self.point(np.zeros(3))
        return forms, [self.builder.form(f"{self.name} p{i}", origin[i]) for i in range(3)]


class ChainBuilder:
    """Builds frames of links, sharing the variables of joints and of links that chains have in common.

    Args:
        builder: receives variables and equations.
        hand: the hand.
        limits: (n_independent, 2) of the joints, in rad or m.
        unit_m: the unit of length.
        bends_fixed: joints whose limits are one value bend their links and are no variables; otherwise they
            have the room of all limits.
    """

    def __init__(
        self, builder: SystemBuilder, hand: Hand, limits: Array, unit_m: float, *, bends_fixed: bool = True
    ):
        self._bends_fixed = bends_fixed
        self.builder = builder
        self.hand = hand
        self.limits = limits
        self.unit_m = unit_m
        # By independent joint: its angle divided by a whole number, so that coupled ones turn by multiples.
        self.angles: dict[int, Angle] = {}
        self.divisors: dict[int, int] = {}
        self.slides: dict[int, Polynomial] = {}
        # By independent joint that drives others by no small fraction: its angle in rad.
        self.turns: dict[int, Polynomial] = {}
        self._frames: dict[int, PolynomialFrame] = {}
        palm = PolynomialFrame(
            builder, "palm", [constant_vector(e) for e in np.eye(3)], constant_vector(np.zeros(3)),
            np.eye(3), np.eye(3), None, 0.0, (Polynomial(), Polynomial()),
        )  # fmt: skip
        self._frames[0] = palm

    def frame(self, link: int) -> PolynomialFrame:
        """The frame of link number `link`."""
        if link not in self._frames:
            self._frames[link] = self._extend(self.frame(self.hand.links[link].parent), link)
        return self._frames[link]

    def _extend(self, frame: PolynomialFrame, link: int) -> PolynomialFrame:
        """The frame one link further out."""
        T0 = self.hand.links[link].T_parent_link0
        frame = self._shift(frame, T0[:3, 3] / self.unit_m, T0[:3, :3])
        for axis in self.hand.links[link].axes:
            k = self.hand.joint_names.index(axis.name)
            if self._is_fixed(k):
                frame = self._shift(frame, *self._fixed_motion(k))
                continue
            frame = self._slide(frame, k) if axis.kind == "prismatic" else self._turn(frame, k)
        return frame

    def _shift(self, frame: PolynomialFrame, p: Array, R: Array) -> PolynomialFrame:
        along, x, y = frame._turned_parts(frame.turned @ p)
        planar = (frame.planar[0] + x, frame.planar[1] + y)
        return PolynomialFrame(
            self.builder, frame.name, frame.base, frame.base_origin, frame.to_axes,
            frame.turned @ R, frame.angle, frame.axial + along, planar,
        )  # fmt: skip

    def _is_fixed(self, k: int) -> bool:
        """Whether joint k is no variable, for the limits of what drives it are one value."""
        lower, upper = self.limits[self._drive(k)[0]]
        return bool(self._bends_fixed and lower == upper)

    def _fixed_motion(self, k: int) -> tuple[Array, Array]:
        """Shift (3,), in units of length, and turn (3, 3) of a joint that is fixed."""
        axis = self.hand.axes[k]
        j, ratio, offset = self._drive(k)
        value = ratio * self.limits[j, 0] + offset
        if axis.kind == "prismatic":
            return axis.direction * (value / self.unit_m), np.eye(3)
        return np.zeros(3), axis_rotation(axis.direction, value)

    def _turn(self, frame: PolynomialFrame, k: int) -> PolynomialFrame:
        axis = self.hand.axes[k]
        step = self._joint_angle(k)
        in_base = frame.turned @ axis.direction
        if frame.angle is not None:
            cosine, *sines = frame.to_axes @ in_base
            # By the sine: the cosine of an axis a micrometre askew per metre rounds to within 1e-12 of 1.
            if np.hypot(*sines) < _PARALLEL:
                signed = step if cosine > 0 else negated(step)
                angle = sum_of(self.builder, f"to {axis.name}", frame.angle, signed)
                return PolynomialFrame(
                    self.builder, axis.name, frame.base, frame.base_origin, frame.to_axes,
                    frame.turned, angle, frame.axial, frame.planar,
                )  # fmt: skip
            columns, origin = frame.as_variables()
            in_base = axis.direction
            turned = np.eye(3)
        else:
            origin = frame.point(np.zeros(3))
            columns = [frame.direction(e) for e in np.eye(3)]
            in_base, turned = axis.direction, np.eye(3)
        to_axes = np.vstack([in_base, perpendicular(in_base)])
        base = [combine(row, columns) for row in to_axes]
        return PolynomialFrame(
            self.builder, axis.name, base, origin, to_axes, turned, step, 0.0, (Polynomial(), Polynomial())
        )

    def _slide(self, frame: PolynomialFrame, k: int) -> PolynomialFrame:
        columns, origin = frame.as_variables()
        axis = self.hand.axes[k]
        step = self._joint_slide(k)
        direction = combine(axis.direction, columns)
        moved = [
            o + self.builder.product(f"{axis.name} {i}", d, step)
            for i, (o, d) in enumerate(zip(origin, direction, strict=True))
        ]
        return PolynomialFrame(
            self.builder,
            axis.name,
            columns,
            moved,
            np.eye(3),
            np.eye(3),
            None,
            0.0,
            (Polynomial(), Polynomial()),
        )

    def _joint_angle(self, k: int) -> Angle:
        j, ratio, offset = self._drive(k)
        divisor = self._divisor(j)
        if divisor is None:
            return turned(self.builder, self.hand.joint_names[k], Turn(self._joint_turn(j), ratio, offset))
        if j not in self.angles:
            self.divisors[j] = divisor
            lower, upper = self.limits[j] / divisor
            self.angles[j] = angle_variable(self.builder, self.hand.independent_names[j], lower, upper)
        n = round(ratio * divisor)
        if n == 1 and offset == 0.0:
            return self.angles[j]
        return multiple(self.builder, self.hand.joint_names[k], self.angles[j], n, offset)

    def _divisor(self, j: int) -> int | None:
        """Least whole number by which joint j's angle divided has what it drives as whole multiples.

        None where the multiples would be too large, or a ratio is no fraction.
        """
        ratios = self.hand.coupling_matrix[:, j]
        ratios = ratios[np.flatnonzero(ratios)].tolist()
        fractions = [Fraction(ratio).limit_denominator(_LARGEST_MULTIPLE) for ratio in ratios]
        divisor = lcm(*(fraction.denominator for fraction in fractions))
        near = all(
            abs(float(fraction) - ratio) <= _RATIO_ROUNDING * abs(ratio)
            for fraction, ratio in zip(fractions, ratios, strict=True)
        )
        return divisor if near and max(map(abs, fractions)) * divisor <= _LARGEST_MULTIPLE else None

    def _joint_turn(self, j: int) -> Polynomial:
        """The angle of independent joint j, in rad, as a variable of its own."""
        if j not in self.turns:
            lower, upper = self.limits[j]
            name = self.hand.independent_names[j]
            self.turns[j] = self.builder.variable(name, lower - LIMIT_ROOM, upper + LIMIT_ROOM)
        return self.turns[j]

    def _joint_slide(self, k: int) -> Polynomial:
        j, ratio, offset = self._drive(k)
        if j not in self.slides:
            lower, upper = self.limits[j] / self.unit_m
            self.slides[j] = self.builder.variable(self.hand.independent_names[j], lower - 1e-9, upper + 1e-9)
        return self.slides[j] * ratio + offset / self.unit_m

    def _drive(self, k: int) -> tuple[int, float, float]:
        """Independent joint that drives joint k, with ratio and offset."""
        (j,) = np.flatnonzero(self.hand.coupling_matrix[k])
        return int(j), float(self.hand.coupling_matrix[k, j]), float(self.hand.coupling_offset[k])


def _imply_rotation(builder: SystemBuilder, columns: list[Vector]) -> None:
    """Redundant equations of a rotation whose columns hold variables."""
    if any(p.degree for column in columns for p in column):
        for a in range(3):
            for b in range(a, 3):
                cosine = dot(columns[a], columns[b])
                if cosine.degree:
                    builder.imply(cosine - (1.0 if a == b else 0.0))
