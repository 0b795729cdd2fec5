"""What a hand is: a tree of links, each moved against its parent by zero, one or two joint axes."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..base.numeric.arrays import Array
from ..geometry import MassProperties, Region, Shape
from .pad import Pad

__all__ = ["Actuator", "Axis", "Coupling", "Hand", "HandRegion", "Link"]


@dataclass(frozen=True)
class Coupling:
    """The joint's position is `ratio * master + offset` (rad, or m for a prismatic joint).

    Attributes:
        master: name of the joint that drives this one.
        ratio: positions of this joint per position of the master.
        offset: position of this joint where the master is at zero.
    """

    master: str
    ratio: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True)
class Actuator:
    """A position servo on an independent joint.

    Attributes:
        effort: largest torque in N m (force in N for a prismatic joint).
        stiffness: gain kp in N m/rad (N/m).
        damping: damping of the joint in N m s/rad (N s/m).
        armature: reflected rotor inertia in kg m^2 (kg).
    """

    effort: float
    stiffness: float
    damping: float
    armature: float


@dataclass(frozen=True, eq=False)
class Axis:
    """One degree of freedom between a link and its parent.

    Attributes:
        name: joint name, unique in the hand.
        kind: revolute (rad) or prismatic (m).
        direction: unit vector (3,) in the link's frame; the axis passes through the frame's origin.
        lower: lower limit, at or below `upper`.
        upper: upper limit.
        coupling: set where another joint drives this one.
        actuator: the servo; None where the joint is coupled.
    """

    name: str
    kind: Literal["revolute", "prismatic"]
    direction: Array
    lower: float
    upper: float
    coupling: Coupling | None
    actuator: Actuator | None


@dataclass(frozen=True, eq=False)
class Link:
    """A rigid link.

    Attributes:
        name: unique in the hand.
        parent: index of the parent in `Hand.links`, -1 for the palm; parents come before children.
        T_parent_link0: pose (4, 4) in the parent's frame with all axes of this link at zero.
        axes: applied in order, the first next to the parent: T = T_parent_link0 A_1(q_1) A_2(q_2).
        shapes: convex shapes in the link's frame.
        inertia: mass properties in the link's frame.
    """

    name: str
    parent: int
    T_parent_link0: Array
    axes: tuple[Axis, ...]
    shapes: tuple[Shape, ...]
    inertia: MassProperties


@dataclass(frozen=True, eq=False)
class HandRegion:
    """A contact region fixed on a link: `region` is given in the frame of link number `link`."""

    name: str
    link: int
    region: Region


class KinematicTree(NamedTuple):
    """The links and axes of a hand as arrays, for compiled code.

    Attributes:
        parents: (n_links,) index of each link's parent, -1 for the palm.
        n_axes: (n_links,) number of axes of each link.
        T_parent_link0: (n_links, 4, 4) as in `Link`.
        directions: (n_joints, 3) as in `Axis`.
        prismatic: (n_joints,) whether the joint slides.
        moves: (n_links, n_joints) whether the joint moves the link.
    """

    parents: NDArray[np.int64]
    n_axes: NDArray[np.int64]
    T_parent_link0: Array
    directions: Array
    prismatic: NDArray[np.bool_]
    moves: NDArray[np.bool_]


@dataclass(frozen=True, eq=False, repr=False)
class Hand:
    """A hand: links, parents first; link 0 is the palm, whose frame is the world of a grasp.

    Joint vectors hold every axis in the order of the links (`joint_names`); reduced vectors hold the
    independent ones alone (`independent_names`), from which `expand` makes joint vectors.

    Attributes:
        name: name of the hand.
        links: parents first.
        regions: contact regions by name.
        description: a line for people.
        sources: where the figures come from.
        never_touching: pairs (a, b), a < b, of links that the hand's own model keeps from touching.
        notes: what an import mended or left out, for people to read.
        pad: the soft pads, the same on all links.
        rated_force_N: normal force for which a fingertip is rated; None where that isn't known.
        max_normal_force_N: largest normal force that plans may ask of any contact; None for no such limit.
        frames: poses (4, 4) in the palm frame of other frames that are fixed to the palm, by name: `model` is
            that of the whole model file, and bodies of the model that became part of the palm have their own.
    """

    name: str
    links: tuple[Link, ...]
    regions: dict[str, HandRegion]
    description: str = ""
    sources: dict[str, str] = field(default_factory=dict)
    never_touching: tuple[tuple[int, int], ...] = ()
    notes: tuple[str, ...] = ()
    pad: Pad = field(default_factory=Pad)
    rated_force_N: float | None = None
    max_normal_force_N: float | None = None
    frames: dict[str, Array] = field(default_factory=dict)

    def __repr__(self) -> str:
        joints = f"{len(self.axes)} joints ({len(self.independent)} independent)"
        return f"<Hand {self.name}: {len(self.links)} links, {joints}, {len(self.regions)} regions>"

    @cached_property
    def axes(self) -> tuple[Axis, ...]:
        """All axes in joint order."""
        return tuple(axis for link in self.links for axis in link.axes)

    @cached_property
    def joint_names(self) -> tuple[str, ...]:
        """Names of all joints, coupled ones included."""
        return tuple(axis.name for axis in self.axes)

    @cached_property
    def independent(self) -> NDArray[np.int64]:
        """Indices of the independent joints in a joint vector."""
        return np.array([i for i, axis in enumerate(self.axes) if axis.coupling is None], dtype=np.int64)

    @cached_property
    def independent_names(self) -> tuple[str, ...]:
        """Names of the independent joints."""
        return tuple(self.joint_names[i] for i in self.independent)

    @cached_property
    def coupling_matrix(self) -> Array:
        """E (n_joints, n_independent) with q = E q_independent + `coupling_offset`."""
        return self._couplings[0]

    @cached_property
    def coupling_offset(self) -> Array:
        """Offset (n_joints,) of the couplings."""
        return self._couplings[1]

    @cached_property
    def _couplings(self) -> tuple[Array, Array]:
        E = np.zeros((len(self.axes), len(self.independent)))
        offset = np.zeros(len(self.axes))
        E[self.independent, np.arange(len(self.independent))] = 1.0
        # A master may itself be coupled; the loader has ruled out cycles, so this many rounds settle all.
        for _ in self.axes:
            for i, axis in enumerate(self.axes):
                if axis.coupling is not None:
                    m = self.joint_names.index(axis.coupling.master)
                    E[i] = axis.coupling.ratio * E[m]
                    offset[i] = axis.coupling.ratio * offset[m] + axis.coupling.offset
        return _frozen(E), _frozen(offset)

    @cached_property
    def limits(self) -> Array:
        """Limits (n_independent, 2) of the independent joints, within which coupled ones keep theirs too."""
        limits = np.array([[self.axes[i].lower, self.axes[i].upper] for i in self.independent])
        for i, axis in enumerate(self.axes):
            if axis.coupling is None:
                continue
            (j,) = np.flatnonzero(self.coupling_matrix[i])
            ends = (np.array([axis.lower, axis.upper]) - self.coupling_offset[i]) / self.coupling_matrix[i, j]
            limits[j] = max(limits[j, 0], ends.min()), min(limits[j, 1], ends.max())
        return _frozen(limits + 0.0)  # so that no limit is -0, below which 0 does not lie for all who ask

    def expand(self, q_independent: Array) -> Array:
        """Joint vector (n_joints,) from the independent joints (n_independent,)."""
        return self.coupling_matrix @ q_independent + self.coupling_offset

    def link_index(self, name: str) -> int:
        """Index of the link called `name`; KeyError where there is none."""
        for i, link in enumerate(self.links):
            if link.name == name:
                return i
        raise KeyError(name)

    @cached_property
    def tree(self) -> KinematicTree:
        """Links and axes as arrays."""
        moves = np.zeros((len(self.links), len(self.axes)), dtype=bool)
        start = 0
        for i, link in enumerate(self.links):
            if link.parent >= 0:
                moves[i] = moves[link.parent]
            moves[i, start : start + len(link.axes)] = True
            start += len(link.axes)
        return KinematicTree(
            np.array([link.parent for link in self.links], dtype=np.int64),
            np.array([len(link.axes) for link in self.links], dtype=np.int64),
            np.array([link.T_parent_link0 for link in self.links], dtype=float, order="C"),
            np.array([axis.direction for axis in self.axes], dtype=float, order="C").reshape(-1, 3),
            np.array([axis.kind == "prismatic" for axis in self.axes], dtype=bool),
            moves,
        )


def _frozen(array: Array) -> Array:
    array.setflags(write=False)
    return array
