"""The formulation of the paper as printed: equations (4)-(25) on link poses.

Unknowns are the poses (r, R) of the palm, the object and the links between the palm and a contact, the
vectors and cosines of joint limits, and the points, normals and parameters of contacts. It is the reference
for the compact formulation: its counts are those of Table 2, and a configuration that solves one solves the
other. What the paper leaves open is settled so:

- The printed counts have the palm's pose free. With `fix_palm` it is the identity, as in section 3.1, and d
  falls by the 6 freedoms of a motion of the whole.
- Variables given by (7), (12)-(14), (17), (18), (24) and (25) are definitions of the system; each counts
  as an equation.
- A coupling counts as one equation; its equal sines are among the redundant equations and do not count.
- Spherical caps follow the scheme of patches (`cap_patch.py`). Normals of a patch are in units of their mean
  length.
"""

from dataclasses import dataclass

import numpy as np

from ...base.numeric.arrays import Array, Indices
from ...geometry import Cap, Patch, PointRegion, Region
from ...hands import forward_kinematics
from ...objects import Task
from ..contacts import ContactManifold, State
from ..formulate import LIMIT_ROOM, UNIT_M
from ..polynomial import PolynomialSystem, SystemBuilder, total
from .contacts import HAND, OBJECT, PaperSide, add_side
from .joints import JointWriter, PaperAngle, PaperLink, add_alignment, joint_limits
from .variables import PaperVariables, Vector, constant, cross, dot, rotate

__all__ = ["PaperFormulation", "formulate_paper"]


_UNIT = (-1.0 - LIMIT_ROOM, 1.0 + LIMIT_ROOM)
# A free palm's origin stays within this of the absolute frame's, in units of length.
_PALM_ROOM = 1.0


@dataclass(frozen=True, eq=False)
class PaperFormulation:
    """A task as the paper's system of equations.

    Attributes:
        task: the task.
        system: the system; `equations` are the independent ones, `redundant` one component of each (9) and
            (16) and the equal sines of couplings.
        variables: where each vector stands among the variables, by name.
        angles: the angles of the joints.
        sides: hand and object side of each contact.
        n_couplings: pairs of coupled angles.
    """

    task: Task
    system: PolynomialSystem
    variables: dict[str, Indices]
    angles: tuple[PaperAngle, ...]
    sides: tuple[tuple[PaperSide, PaperSide], ...]
    n_couplings: int

    @property
    def n_v(self) -> int:
        """Number of variables."""
        return self.system.size

    @property
    def n_e(self) -> int:
        """Number of equations as printed: redundant components of (9) and (16) count, equal sines do not."""
        system = self.system
        written = len(system.definitions) + len(system.equations) + len(system.redundant)
        return written - self.n_couplings

    @property
    def d(self) -> int:
        """Variables less equations that are not redundant."""
        return self.system.dimension

    def inputs_from_state(self, state: State) -> Array:
        """All variables (n_v,) at a state, defined ones included; the palm's frame is the absolute one."""
        x = np.zeros(self.n_v)
        hand = self.task.hand
        q = hand.expand(state.q)
        Ts = forward_kinematics(hand, q)
        for link, T in zip(hand.links, Ts, strict=True):
            self._fill_pose(x, link.name, T)
        self._fill_pose(x, _OBJECT, state.T_palm_object)
        for angle in self.angles:
            name = f"joint {hand.joint_names[angle.joint]}"
            x[self.variables[f"{name} a"]] = Ts[angle.parent][:3, :3] @ angle.a_parent
            x[self.variables[f"{name} b"]] = Ts[angle.child][:3, :3] @ angle.b_child
            x[self.variables[f"{name} c"]] = np.cos(q[angle.joint] - angle.middle)
        self._fill_contacts(x, state, Ts)
        return x

    def _fill_pose(self, x: Array, name: str, T: Array) -> None:
        """Fills a body's pose, as far as it has variables."""
        for letter, values in (("r", T[:3, 3] / UNIT_M), ("c", T[:3, 0]), ("d", T[:3, 1]), ("e", T[:3, 2])):
            indices = self.variables.get(f"{name} {letter}")
            if indices is not None:
                x[indices] = values

    def _fill_contacts(self, x: Array, state: State, Ts: Array) -> None:
        first = 0
        points = ContactManifold(self.task).contact_points(state)
        for contact, sides, point in zip(self.task.contacts, self.sides, points, strict=True):
            R_link = Ts[contact.hand.link][:3, :3]
            normals = (R_link.T @ point.n_hand, state.R_palm_object.T @ point.n_object)
            for side, normal in zip(sides, normals, strict=True):
                side.fill(x, normal, state.params[first : first + side.n_params])
                first += side.n_params


def formulate_paper(task: Task, *, eliminate_r: bool = False, fix_palm: bool = False) -> PaperFormulation:
    """Writes a task as the paper does.

    Args:
        task: a task of revolute and universal joints, coupled by equal or opposite angles if at all.
        eliminate_r: replace (8), (10) and (15) by loop closures without the positions r (section 3.5). With
            a free palm this also removes the 3 translations of the whole from d.
        fix_palm: the palm's pose is the identity rather than free.

    Raises:
        HoldfastError: the hand has a joint that the paper does not treat.
    """
    return _PaperBuilder(task, eliminate_r=eliminate_r, fix_palm=fix_palm).build()


# Names of links never hold a space.
_OBJECT = "the object"


class _PaperBuilder:
    """Writes links, then joints from the palm outwards, then contacts."""

    def __init__(self, task: Task, *, eliminate_r: bool, fix_palm: bool):
        self.task = task
        self.eliminate_r = eliminate_r
        self.variables = PaperVariables(SystemBuilder())
        self.joints = JointWriter(self.variables, task.hand, joint_limits(task.hand, task.limits))
        self.links = {0: self._fixed_palm() if fix_palm else self._free_palm()}
        self.object_R: list[Vector] = []
        self.object_r: Vector = []

    def build(self) -> PaperFormulation:
        """The finished formulation."""
        for contact in self.task.contacts:
            self._link(contact.hand.link)
        n_couplings = self.joints.couple()
        sides = tuple(self._add_contact(k) for k in range(len(self.task.contacts)))
        return PaperFormulation(
            self.task,
            self.variables.builder.build(),
            self.variables.indices,
            tuple(self.joints.angles),
            sides,
            n_couplings,
        )

    def _fixed_palm(self) -> PaperLink:
        return PaperLink(constant(np.zeros(3)), [constant(e) for e in np.eye(3)], np.eye(3), 0.0)

    def _free_palm(self) -> PaperLink:
        name = self.task.hand.links[0].name
        R = self._add_rotation(name)
        r = self._add_position(name, _PALM_ROOM, None)
        return PaperLink(r, R, np.eye(3), _PALM_ROOM)

    def _link(self, index: int) -> PaperLink:
        """The pose of a link, with the joints that carry it."""
        if index not in self.links:
            self.links[index] = self._extend(self._link(self.task.hand.links[index].parent), index)
        return self.links[index]

    def _extend(self, parent: PaperLink, index: int) -> PaperLink:
        """The pose one link further out (equations 4-7), its position by (8) or (10): all q_i are zero."""
        link = self.task.hand.links[index]
        p = link.T_parent_link0[:3, 3] / UNIT_M
        r = [a + b for a, b in zip(parent.r, rotate(parent.R, constant(p)), strict=True)]
        reach = parent.reach + float(np.linalg.norm(p))
        R_reference = parent.R_reference @ self.joints.reference_rotation(link)
        if not link.axes:
            columns = [rotate(parent.R, constant(e)) for e in link.T_parent_link0[:3, :3].T]
            return PaperLink(r, columns, R_reference, reach)
        R = self._add_rotation(link.name)
        child = PaperLink(self._add_position(link.name, reach, r), R, R_reference, reach)
        self.joints.add(index, parent, child)
        return child

    def _add_rotation(self, name: str) -> list[Vector]:
        """The columns of a rotation (equations 4-7)."""
        c, d = (self.variables.inputs(f"{name} {letter}", 3, *_UNIT) for letter in "cd")
        e = self.variables.defined(f"{name} e", cross(c, d), *_UNIT)
        for value in (dot(c, c) - 1.0, dot(d, d) - 1.0, dot(c, d)):
            self.variables.builder.equate(value)
        return [c, d, e]

    def _add_position(self, name: str, reach: float, value: Vector | None) -> Vector:
        """A position r, equal to `value` if there is one; eliminated, it is the value itself."""
        if self.eliminate_r:
            return constant(np.zeros(3)) if value is None else value
        r = self.variables.inputs(f"{name} r", 3, -reach - LIMIT_ROOM, reach + LIMIT_ROOM)
        for a, b in zip(value or [], r, strict=False):
            self.variables.builder.equate(a - b)
        return r

    def _add_contact(self, number: int) -> tuple[PaperSide, PaperSide]:
        """One contact (equations 15-18 and 20-25); the first one places the object."""
        contact = self.task.contacts[number]
        link = self._link(contact.hand.link)
        hand = add_side(self.variables, HAND.of(number), contact.hand.region, UNIT_M)
        obj = add_side(self.variables, OBJECT.of(number), contact.object.region, UNIT_M)
        if not self.object_R:
            self.object_R = self._add_rotation(_OBJECT)
        R = self.object_R
        r = [
            total([a, b, -c])
            for a, b, c in zip(link.r, rotate(link.R, hand.point), rotate(R, obj.point), strict=True)
        ]
        if number == 0:
            self.object_r = self._add_position(_OBJECT, link.reach + hand.reach + obj.reach, r)
        else:
            for a, b in zip(r, self.object_r, strict=True):
                self.variables.builder.equate(a - b)
        ends = zip(rotate(link.R, hand.unit), rotate(R, obj.unit), strict=True)
        direction = link.R_reference @ _middle_normal(contact.hand.region)
        add_alignment(self.variables, [a + b for a, b in ends], direction)
        return hand, obj


def _middle_normal(region: Region) -> Array:
    """A unit normal (3,) from the middle of a region."""
    match region:
        case Cap():
            return region.axis
        case Patch():
            return np.asarray(region.patch.unit_normal(0.5, 0.5))
        case PointRegion():
            return region.normal
