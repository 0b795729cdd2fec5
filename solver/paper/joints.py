"""Joints as the paper writes them: assembly (8)-(11), limits (12)-(14) and couplings (section 5.1)."""

from dataclasses import dataclass, field

import numpy as np

from ...base.numeric.arrays import Array
from ...errors import HoldfastError
from ...geometry import axis_rotation, perpendicular
from ...hands import Hand, Link
from ..formulate import LIMIT_ROOM
from ..polynomial import Polynomial
from .variables import PaperVariables, Vector, constant, dot, rotate

__all__ = ["JointWriter", "PaperAngle", "PaperLink", "add_alignment", "joint_limits"]


_UNIT = (-1.0 - LIMIT_ROOM, 1.0 + LIMIT_ROOM)
# Axes of a universal joint whose cosine is below this are perpendicular.
_PERPENDICULAR = 1e-9
# Ratios of coupled joints that differ by less are equal.
_RATIO_ROUNDING = 1e-12


@dataclass(frozen=True)
class PaperLink:
    """A link's pose (r, R) in the absolute frame.

    Attributes:
        r: position, in units of length.
        R: the three columns of the rotation.
        R_reference: (3, 3) the rotation in the reference configuration, every joint amid its limits.
        reach: a bound on the distance from the palm's origin.
    """

    r: Vector
    R: list[Vector]
    R_reference: Array
    reach: float


@dataclass(frozen=True, eq=False)
class PaperAngle:
    """One angle of a joint, counted from the middle of its limits (section 3.3).

    Attributes:
        joint: index in a joint vector.
        parent: index of the link that carries a.
        child: index of the link that carries b.
        middle: of the limits, in rad.
        a_parent: unit vector (3,) of the angle in the parent's frame.
        b_child: unit vector (3,) of the angle in the child's frame.
        cos: the variable c (equation 12).
        sin: the sine of the same angle, quadratic in the other variables.
    """

    joint: int
    parent: int
    child: int
    middle: float
    a_parent: Array
    b_child: Array
    cos: Polynomial
    sin: Polynomial


@dataclass
class JointWriter:
    """Writes the joints of one hand.

    Attributes:
        variables: receives variables and equations.
        hand: the hand.
        limits: (n_joints, 2) of all joints, coupled ones included.
        angles: the angles written so far.
    """

    variables: PaperVariables
    hand: Hand
    limits: Array
    angles: list[PaperAngle] = field(default_factory=list)

    def reference_rotation(self, link: Link) -> Array:
        """Rotation (3, 3) of a link in its parent's frame with its joints amid their limits."""
        R = link.T_parent_link0[:3, :3]
        for axis in link.axes:
            middle = self._middle(self.hand.joint_names.index(axis.name))
            R = R @ axis_rotation(axis.direction, middle)
        return R

    def add(self, index: int, parent: PaperLink, child: PaperLink) -> None:
        """Writes (9) or (11), and (12)-(14), of the joint that carries link number `index`.

        Raises:
            HoldfastError: the joint is neither revolute nor universal.
        """
        link = self.hand.links[index]
        if any(axis.kind != "revolute" for axis in link.axes):
            raise HoldfastError(f"link {link.name}: the paper's formulation has no prismatic joints")
        if len(link.axes) == 1:
            self._add_revolute(index, parent, child)
        else:
            self._add_universal(index, parent, child)

    def couple(self) -> int:
        """Equates cosines and sines of coupled angles; returns how many pairs there are.

        The printed counts have one equation a pair, that of the cosines. Equal sines settle a sign, as the
        third component of (9) does, so they stand among the redundant equations.

        Raises:
            HoldfastError: a coupling is not one of equal or opposite angles.
        """
        leaders: dict[int, PaperAngle] = {}
        pairs = 0
        for angle in self.angles:
            (j,) = np.flatnonzero(self.hand.coupling_matrix[angle.joint])
            leader = leaders.setdefault(int(j), angle)
            if leader is angle:
                continue
            ratio = self.hand.coupling_matrix[angle.joint, j] / self.hand.coupling_matrix[leader.joint, j]
            if abs(abs(ratio) - 1.0) > _RATIO_ROUNDING:
                raise HoldfastError(
                    f"joint {self.hand.joint_names[angle.joint]}: the paper's formulation couples "
                    f"equal or opposite angles only, not at a ratio of {ratio:g}"
                )
            self.variables.builder.equate(angle.cos - leader.cos)
            self.variables.builder.imply(angle.sin - leader.sin * float(np.sign(ratio)))
            pairs += 1
        return pairs

    def _add_revolute(self, index: int, parent: PaperLink, child: PaperLink) -> None:
        link = self.hand.links[index]
        (axis,) = link.axes
        R0 = link.T_parent_link0[:3, :3]
        u, v = R0 @ axis.direction, axis.direction
        ends = zip(rotate(parent.R, constant(u)), rotate(child.R, constant(v)), strict=True)
        add_alignment(self.variables, [x - y for x, y in ends], parent.R_reference @ u)
        k = self.hand.joint_names.index(axis.name)
        b = perpendicular(v)[0]
        a = R0 @ axis_rotation(v, self._middle(k)) @ b
        self._add_limit(index, k, parent, child, a, b, axis_child=v)

    def _add_universal(self, index: int, parent: PaperLink, child: PaperLink) -> None:
        link = self.hand.links[index]
        first, second = link.axes
        if abs(first.direction @ second.direction) > _PERPENDICULAR:
            raise HoldfastError(f"link {link.name}: the axes of a universal joint must be perpendicular")
        R0 = link.T_parent_link0[:3, :3]
        u, v = R0 @ first.direction, second.direction
        self.variables.builder.equate(dot(rotate(parent.R, constant(u)), rotate(child.R, constant(v))))
        k = self.hand.joint_names.index(first.name)
        # Each axis is perpendicular to the other, and so serves as a vector of the other's angle.
        a = R0 @ axis_rotation(first.direction, self._middle(k)) @ v
        self._add_limit(index, k, parent, child, a, v, axis_parent=u)
        b = axis_rotation(v, -self._middle(k + 1)) @ first.direction
        self._add_limit(index, k + 1, parent, child, u, b, axis_child=v)

    def _add_limit(
        self,
        index: int,
        joint: int,
        parent: PaperLink,
        child: PaperLink,
        a_parent: Array,
        b_child: Array,
        *,
        axis_parent: Array | None = None,
        axis_child: Array | None = None,
    ) -> None:
        """One angle's vectors a (13) and b (14) with their cosine (12) in [cos(half range), 1].

        The joint's axis is given in the frame of a link that it is fixed to.
        """
        name = f"joint {self.hand.joint_names[joint]}"
        half = min(0.5 * float(np.ptp(self.limits[joint])) + LIMIT_ROOM, np.pi)
        a = self.variables.defined(f"{name} a", rotate(parent.R, constant(a_parent)), *_UNIT)
        b = self.variables.defined(f"{name} b", rotate(child.R, constant(b_child)), *_UNIT)
        (c,) = self.variables.defined(f"{name} c", [dot(a, b)], float(np.cos(half)) - LIMIT_ROOM, _UNIT[1])
        if axis_child is not None:
            sine = dot(a, rotate(child.R, constant(np.cross(b_child, axis_child))))
        else:
            assert axis_parent is not None
            sine = dot(b, rotate(parent.R, constant(np.cross(axis_parent, a_parent))))
        self.angles.append(
            PaperAngle(
                joint, self.hand.links[index].parent, index, self._middle(joint), a_parent, b_child, c, sine
            )
        )

    def _middle(self, joint: int) -> float:
        return float(self.limits[joint].mean())


def joint_limits(hand: Hand, limits: Array) -> Array:
    """Limits (n_joints, 2) of all joints from those (n_independent, 2) of the independent ones."""
    ends = hand.coupling_matrix @ limits + hand.coupling_offset[:, None]
    return np.sort(ends, axis=1)


def add_alignment(variables: PaperVariables, components: Vector, direction: Array) -> None:
    """Equates two unit vectors (equations 9 and 16), one of three components being redundant but for a sign.

    The paper leaves z out. Where the vectors lie in the x-y plane, as the flexion axes of a finger without
    abduction do, x and y depend on each other there; so what is left out here is the largest component of
    the vectors' direction (3,) in the reference configuration.
    """
    largest = int(np.argmax(np.abs(direction)))
    for i, component in enumerate(components):
        if i == largest:
            variables.builder.imply(component)
        else:
            variables.builder.equate(component)
