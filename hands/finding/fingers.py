"""The fingers of a hand: chains of links that nothing else hangs on."""

from dataclasses import dataclass

import numpy as np

from ...base.numeric.arrays import Array
from ..hand import Hand
from ..kinematics import forward_kinematics
from .cast import surface_points
from .rods import is_closing_rod, is_driven_rod, links_before_rods, reach_m

__all__ = ["Finger", "find_fingers"]

# The axis of a joint that turns the last link about its own length bends nothing.
_ROLL = 0.8


@dataclass(frozen=True, eq=False)
class Finger:
    """A finger; directions are unit vectors in the frame of its last link.

    Attributes:
        links: numbers of its links that have shapes, the last one first.
        rods: of links that hang on the last one and lead back to the palm.
        base: (3,) where it begins, in the palm frame with all joints at zero, in m.
        along: (3,) from the last joint to the tip.
        bend: (3,) axis that it bends about; the pad and the back are perpendicular to it and to `along`.
        start_m, end_m: positions along `along` of the last joint and the tip.
    """

    links: tuple[int, ...]
    rods: tuple[int, ...]
    base: Array
    along: Array
    bend: Array
    start_m: float
    end_m: float

    @property
    def last(self) -> int:
        """Number of the link that bears the tip."""
        return self.links[0]

    @property
    def own(self) -> set[int]:
        """Links that the finger does not look at as at another one."""
        return {*self.links, *self.rods}

    @property
    def length_m(self) -> float:
        """Length of the last link."""
        return self.end_m - self.start_m


def find_fingers(hand: Hand) -> list[Finger]:
    """The fingers in the order of their last links."""
    T = forward_kinematics(hand, hand.expand(np.clip(0.0, *hand.limits.T)))
    chains = [chain for chain in (_chain(hand, leaf) for leaf in _leaves(hand)) if chain]
    reaches_m = [reach_m(hand, T, chain) for chain in chains]
    masters = [_masters(hand, chain) for chain in chains]
    fingers = []
    for i, chain in enumerate(chains):
        if not is_driven_rod(i, masters, reaches_m) and not is_closing_rod(hand, i, chains, masters):
            solid = links_before_rods(hand, T, chain)
            fingers.append(_finger(hand, T, solid, rods=tuple(chain[: len(chain) - len(solid)])))
    return fingers


def _leaves(hand: Hand) -> list[int]:
    """Links with shapes that carry no other link with shapes."""
    carries = set[int]()
    for link in hand.links:
        if link.shapes:
            parent = link.parent
            while parent >= 0:
                carries.add(parent)
                parent = hand.links[parent].parent
    return [i for i, link in enumerate(hand.links) if i > 0 and link.shapes and i not in carries]


def _chain(hand: Hand, leaf: int) -> list[int]:
    """Links from the leaf towards the palm, as far as they carry this leaf alone."""
    chain, link = [leaf], hand.links[leaf].parent
    leaves = _leaves(hand)
    while link > 0:
        carried = [other for other in leaves if _is_above(hand, link, other)]
        if carried != [leaf]:
            break
        chain.append(link)
        link = hand.links[link].parent
    return chain


def _is_above(hand: Hand, link: int, other: int) -> bool:
    while other > link:
        other = hand.links[other].parent
    return other == link


def _masters(hand: Hand, chain: list[int]) -> frozenset[int]:
    """Independent joints that move the chain."""
    axes = np.flatnonzero(hand.tree.moves[chain[0]])
    return frozenset(int(j) for j in np.flatnonzero(np.any(hand.coupling_matrix[axes] != 0.0, axis=0)))


def _finger(hand: Hand, T: Array, chain: list[int], rods: tuple[int, ...]) -> Finger:
    last = chain[0]
    points = surface_points(hand.links[last].shapes)
    slides, bend, origin = _last_axis(hand, T, chain, points)
    if slides:
        # The pad looks along the slide; the finger points away from the palm.
        palm = surface_points(hand.links[0].shapes)
        centre = palm.mean(axis=0) if len(palm) else np.zeros(3)
        out = T[last][:3, :3].T @ (T[last][:3, :3] @ points.mean(axis=0) + T[last][:3, 3] - centre)
        along = _across(out, bend)
        bend = np.cross(along, bend)
    else:
        along = _farthest(points - origin, bend)
    heights = points @ along
    start = min(float(origin @ along), float(heights.max()) - 1e-3) if not slides else float(heights.min())
    solid = tuple(i for i in chain if hand.links[i].shapes)
    base = T[chain[-1]][:3, 3]
    return Finger(solid, rods, base, along, bend, max(start, float(heights.min())), float(heights.max()))


def _last_axis(hand: Hand, T: Array, chain: list[int], points: Array) -> tuple[bool, Array, Array]:
    """Whether the last joint slides, its axis and origin, in the last link's frame; rolls are passed over."""
    inverse = np.linalg.inv(T[chain[0]])
    found: tuple[bool, Array, Array] | None = None
    for link in chain:
        for axis in reversed(hand.links[link].axes):
            direction = inverse[:3, :3] @ T[link][:3, :3] @ axis.direction
            origin = (inverse @ T[link])[:3, 3]
            this = (axis.kind == "prismatic", direction, origin)
            found = found or this
            out = points.mean(axis=0) - origin
            if this[0] or abs(out @ direction) <= _ROLL * np.linalg.norm(out):
                return this
    assert found is not None
    return found


def _across(v: Array, axis: Array) -> Array:
    """The unit vector along the part of `v` that is perpendicular to the unit vector `axis`."""
    rest = v - (v @ axis) * axis
    if np.linalg.norm(rest) < 1e-6:
        rest = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    return np.asarray(rest / np.linalg.norm(rest))


def _farthest(off: Array, axis: Array) -> Array:
    """The direction across the axis in which points reach farthest from it."""
    across = off - np.outer(off @ axis, axis)
    distance = np.linalg.norm(across, axis=1)
    return _across(across[distance >= 0.9 * distance.max()].mean(axis=0), axis)
