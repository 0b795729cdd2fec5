"""What is measured of grasps as they are given: what touches, what sinks in, which joints can't be so."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations

import numpy as np

from ...base.numeric.arrays import Array, Indices
from ...geometry import ConvexSurface, invert
from ...geometry.solids import SurfaceDistance
from ...hands import Hand, forward_kinematics
from ...objects import ObjectModel
from ...retraction import Bodies, Body, build_piece, hand_bodies, lower_bounds, measure, overlapping_links
from .flat_contact import contact_corners, middle_of
from .pressed_area import pressed_places
from .reading import finger_links

__all__ = ["INTENDED_M", "HandAtObject", "Measured", "Sunk", "Touch"]

# Pairs are measured that come so near.
_REACH_M = 0.012
INTENDED_M = 0.006
"""A finger no farther than this from the object is looked at as one that may have been meant to touch it."""
# A link that is no farther from the object than this touches it together with the nearest link of its finger.
_TOUCHING_M = 5e-4
# What sinks in less than this is in contact.
_DEPTH_M = 1e-4
# Joints beyond their limits by less than this are so by rounding.
_ROUNDING = 1e-3
# Coupled joints that are off what their masters say by less than this follow.
_FOLLOWS = 0.02


@dataclass(frozen=True, eq=False)
class Touch:
    """A link at the object.

    Attributes:
        link: index of the link.
        finger: the finger that it is part of, or `palm`.
        part: index of the part of the object that it is at.
        distance_m: signed distance of their surfaces; negative where the link sinks in.
        point: (3,) point of the link that is nearest to the object, or deepest in it, in the palm frame.
        on_object: (3,) the same on the object.
        normal: (3,) unit vector there from the link to the object.
        places: (k, 3) all places of the object that the link is as near to, corners of what they share where
            faces or edges touch, in the palm frame.
        normals: (k, 3) unit vectors there from the link to the object.
    """

    link: int
    finger: str
    part: int
    distance_m: float
    point: Array
    on_object: Array
    normal: Array
    places: Array
    normals: Array


@dataclass(frozen=True)
class Sunk:
    """Two bodies that are deeper in each other than bodies in contact are.

    Attributes:
        a: name of a link.
        b: name of another link, or `object`.
        depth_m: how deep.
    """

    a: str
    b: str
    depth_m: float

    def __str__(self) -> str:
        return f"{self.a} and {self.b} {1e3 * self.depth_m:.2g} mm deep"


@dataclass(frozen=True, eq=False)
class Measured:
    """A grasp as it is given, measured.

    Attributes:
        joints: (n_joints,) as given, in rad and m.
        T_palm_object: (4, 4) pose of the object in the palm frame.
        touches: of each finger, and the palm, that is near the object its nearest link, and other links that
            touch.
        sunk: pairs that are in each other, the deepest first.
        beyond_limits: joints that are beyond their limits, by how much, in rad and m.
        astray: coupled joints that are not where their masters put them, by how much.
    """

    joints: Array
    T_palm_object: Array
    touches: tuple[Touch, ...]
    sunk: tuple[Sunk, ...]
    beyond_limits: dict[str, float]
    astray: dict[str, float]

    @property
    def depth_m(self) -> float:
        """How deep the deepest pair is; 0 for none."""
        return self.sunk[0].depth_m if self.sunk else 0.0


class HandAtObject:
    """Measures a hand at an object of one size.

    Args:
        hand: the hand.
        obj: the object, in its size.
    """

    def __init__(self, hand: Hand, obj: ObjectModel):
        self.hand, self.obj = hand, obj
        self._fingers = {int(i): name for name, links in finger_links(hand).items() for i in links}
        parts = [
            Body(f"object/{part.name}", None, tuple(build_piece(piece) for piece in part.pieces))
            for part in obj.parts
        ]
        self._bodies = Bodies([*hand_bodies(hand), *parts])
        self._surfaces: dict[int, SurfaceDistance] = {}
        self._pieces: dict[int, ConvexSurface] = {}
        self._links: dict[int, ConvexSurface] = {}

    def measure(self, joints: Array, T_palm_object: Array) -> Measured:
        """Measures one grasp.

        Args:
            joints: (n_joints,) of all joints, in rad and m.
            T_palm_object: (4, 4) pose of the object in the palm frame.
        """
        n = len(self.hand.links)
        Ts = np.concatenate(
            [forward_kinematics(self.hand, joints), np.tile(T_palm_object, (len(self.obj.parts), 1, 1))]
        )
        placed = self._bodies.place(Ts)
        near = self._pairs[lower_bounds(placed, self._pairs) < _REACH_M]
        gaps = measure(placed, near)
        owners = self._bodies.piece_body[gaps.pairs]
        touches: dict[int, Touch] = {}
        depths: dict[tuple[int, int], float] = {}
        for k in np.argsort(-gaps.distance_m).tolist():
            a, b = owners[k].tolist()
            distance_m = float(gaps.distance_m[k])
            if b >= n:
                allowed = self._standing_out(b - n, gaps.p_b[k], distance_m, T_palm_object)
                distance_m = min(distance_m + allowed, max(distance_m, 0.0))
                finger = self._fingers.get(a, "palm")
                i, j = gaps.pairs[k].tolist()
                normal, across = gaps.normals[k], gaps.p_b[k] - gaps.p_a[k]
                corners = contact_corners(placed.core(i), placed.core(j), normal, gaps.p_a[k])
                on_link = middle_of(corners, normal)
                touch = Touch(
                    a, finger, b - n, distance_m, on_link, on_link + across, normal,
                    corners + across, np.tile(normal, (len(corners), 1)),
                )  # fmt: skip
                touches[a] = _with_places(touch, touches.get(a))
            if distance_m < -_DEPTH_M:
                depths[a, min(b, n)] = max(-distance_m, depths.get((a, min(b, n)), 0.0))
        sunk = [Sunk(self._name(a), self._name(b), depth) for (a, b), depth in depths.items()]
        return Measured(
            joints,
            T_palm_object,
            tuple(_of_fingers(list(touches.values()))),
            tuple(sorted(sunk, key=lambda pair: -pair.depth_m)),
            self._beyond_limits(joints),
            self._astray(joints),
        )

    def _name(self, body: int) -> str:
        return self.hand.links[body].name if body < len(self.hand.links) else "object"

    @cached_property
    def _pairs(self) -> Indices:
        """Pairs (n, 2) of pieces that are watched: of links with links, and of links with the object."""
        n = len(self.hand.links)
        left_out = overlapping_links(self.hand)
        of = [np.flatnonzero(self._bodies.piece_body == i) for i in range(n + len(self.obj.parts))]
        pairs = [(a, b) for a, b in combinations(range(n), 2) if (a, b) not in left_out]
        pairs += [(a, b) for a in range(n) for b in range(n, len(of))]
        grids = [np.array(np.meshgrid(of[a], of[b], indexing="ij")).reshape(2, -1).T for a, b in pairs]
        return np.concatenate([np.zeros((0, 2), dtype=np.int64), *grids])

    def _standing_out(self, part: int, point: Array, distance_m: float, T_palm_object: Array) -> float:
        """How far the object's convex pieces stand out of its true surface where a link sinks in."""
        model = self.obj.parts[part]
        if distance_m >= -_DEPTH_M or model.closeness is None or model.closeness.outside_m < _DEPTH_M:
            return 0.0
        if part not in self._surfaces:
            self._surfaces[part] = SurfaceDistance(model.mesh)
        place = self._surfaces[part].nearest(((point - T_palm_object[:3, 3]) @ T_palm_object[:3, :3])[None])
        depth_m = -self._pieces_of(part).signed_distances(place)[0]
        return float(np.clip(depth_m, 0.0, model.closeness.outside_m))

    def _pieces_of(self, part: int) -> ConvexSurface:
        if part not in self._pieces:
            self._pieces[part] = ConvexSurface(self.obj.parts[part].pieces)
        return self._pieces[part]

    def spread(self, given: Measured, touches: Sequence[Touch]) -> list[Touch]:
        """Touches with all places of the object that each link is pressed against, over which its pad yields.

        Args:
            given: the grasp.
            touches: some of its touches.
        """
        R, p = given.T_palm_object[:3, :3], given.T_palm_object[:3, 3]
        T_object_links = invert(given.T_palm_object) @ forward_kinematics(self.hand, given.joints)
        found = []
        for touch in touches:
            if touch.link not in self._links:
                self._links[touch.link] = ConvexSurface(self.hand.links[touch.link].shapes)
            places, normals = pressed_places(
                self._links[touch.link],
                self._pieces_of(touch.part),
                T_object_links[touch.link],
                (touch.on_object - p) @ R,
                touch.normal @ R,
                touch.distance_m,
            )
            places, normals = places @ R.T + p, normals @ R.T
            found.append(
                replace(
                    touch,
                    places=np.concatenate([touch.places, places]),
                    normals=np.concatenate([touch.normals, normals]),
                )
            )
        return found

    def _beyond_limits(self, joints: Array) -> dict[str, float]:
        found = {}
        for axis, value in zip(self.hand.axes, joints.tolist(), strict=True):
            excess = max(axis.lower - value, value - axis.upper)
            if excess > _ROUNDING:
                found[axis.name] = excess
        return found

    def _astray(self, joints: Array) -> dict[str, float]:
        hand = self.hand
        led = hand.coupling_matrix @ joints[hand.independent] + hand.coupling_offset
        off = np.abs(joints - led)
        return {hand.joint_names[j]: float(off[j]) for j in np.flatnonzero(off > _FOLLOWS)}


def _with_places(touch: Touch, farther: Touch | None) -> Touch:
    """A touch of a link with the places of one found before that are as near as its own."""
    if farther is None or farther.distance_m > touch.distance_m + _TOUCHING_M:
        return touch
    return replace(
        touch,
        places=np.concatenate([touch.places, farther.places]),
        normals=np.concatenate([touch.normals, farther.normals]),
    )


def _of_fingers(touches: list[Touch]) -> list[Touch]:
    """Of each finger the link that is nearest to the object, and those that touch it, too."""
    kept: list[Touch] = []
    for touch in sorted(touches, key=lambda touch: touch.distance_m):
        is_first = all(other.finger != touch.finger for other in kept)
        limit = INTENDED_M if is_first else _TOUCHING_M
        if touch.distance_m <= limit:
            kept.append(touch)
    return kept
